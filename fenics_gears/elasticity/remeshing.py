"""Stiffness of a gear at all positions of a mesh cycle, meshed anew at each; MPI ranks share the positions."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass
from time import perf_counter

import numpy as np

from fenics_gears.elasticity.cache import Cache, content_key
from fenics_gears.elasticity.element_sizes import Discretisation
from fenics_gears.elasticity.elements import element_named
from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.gear_data import Material
from fenics_gears.numbers_version import NUMBERS_VERSION
from fenics_gears.system.job import Job, together


@dataclass(frozen=True)
class RemeshedStiffness:
    """A gear's stiffness (2 K + 3, 2 K + 3), N/mm per mm of face width, at each position; `timings` (s)."""

    positions: list[np.ndarray]
    timings: dict


def remeshed_stiffness(
    gear: Gear,
    material: Material,
    positions: list,
    discretisation: Discretisation,
    cache: Cache | None = None,
    job: Job | None = None,
    report: Callable[[int, int], None] | None = None,
) -> RemeshedStiffness:
    """Stiffness of a gear at all positions: meshed and condensed, or from the cache.

    positions: for each the loaded teeth, tuples of remeshed_gear.LoadedTooth. job: whose ranks share the positions out.
        report: called with
    positions done and in all, of this process. Raises ComputationError when a position fails.
    """
    key = content_key(
        {
            "remeshed": NUMBERS_VERSION,
            "gear": asdict(gear),
            "poissons_ratio": material.poissons_ratio,
            "element": discretisation.element,
            "sizes": asdict(discretisation.sizes(gear)),
            "positions": [[[tooth.angle, tooth.rolls.tolist()] for tooth in teeth] for teeth in positions],
        }
    )
    clock = perf_counter()
    cached = None if cache is None else cache.load(key)
    if cached is not None:
        stiffness = [material.youngs_modulus * cached[str(i)] for i in range(len(positions))]
        timings = {"from_cache": True, "time_mesh": 0.0, "time_compile": 0.0, "time_condense": perf_counter() - clock}
        return RemeshedStiffness(stiffness, timings)
    shares = together(job, _computed, gear, material, discretisation, positions, report=report)
    parts = {index: stiffness for share, _ in shares for index, stiffness in share.items()}
    timings = {name: max(times[name] for _, times in shares) for name in shares[0][1]}
    if cache is not None:
        cache.store(key, {str(i): parts[i] / material.youngs_modulus for i in parts})
    return RemeshedStiffness([parts[i] for i in sorted(parts)], {"from_cache": False, **timings})


def _computed(gear, material, discretisation, positions, comm, report=None) -> tuple[dict[int, np.ndarray], dict]:
    """This rank's share of the positions, each meshed and condensed by it."""
    # Imported here: a run whose gears are all in the cache needs neither gmsh nor DOLFINx.
    from fenics_gears.elasticity.remeshed_gear import RemeshedGear

    body = RemeshedGear(gear, material, element_named(discretisation.element), discretisation.sizes(gear))
    mine = range(len(positions)) if comm is None else range(comm.rank, len(positions), comm.size)
    found = {}
    for done, index in enumerate(mine, 1):
        found[index] = body.stiffness(positions[index])
        if report is not None:
            report(done, len(mine))
    return found, body.timings
