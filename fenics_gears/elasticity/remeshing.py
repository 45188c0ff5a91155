"""Stiffness of a gear at all positions of a mesh cycle, meshed anew at each; MPI ranks share the positions."""

from collections.abc import Callable
from dataclasses import asdict, dataclass

import numpy as np

from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.gear_data import Material
from fenics_gears.numbers_version import NUMBERS_VERSION
from fenics_gears.system.job import Job, together

from .cache import Cache, kept
from .element_sizes import Discretisation
from .elements import element_named


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
    report: called with positions done and in all, of this process. Raises ComputationError when one fails.
    """
    inputs = {
        "remeshed": NUMBERS_VERSION,
        "gear": asdict(gear),
        "poissons_ratio": material.poissons_ratio,
        "element": discretisation.element,
        "sizes": asdict(discretisation.sizes(gear)),
        "positions": [[[tooth.angle, tooth.rolls.tolist()] for tooth in teeth] for teeth in positions],
    }

    def compute() -> tuple[dict, dict]:
        shares = together(job, _computed, gear, material, discretisation, positions, report=report)
        stiffnesses = {
            str(i): stiffness / material.youngs_modulus for share, _ in shares for i, stiffness in share.items()
        }
        return stiffnesses, {name: max(times[name] for _, times in shares) for name in shares[0][1]}

    arrays, timings = kept(cache, inputs, compute)
    return RemeshedStiffness([material.youngs_modulus * arrays[str(i)] for i in range(len(positions))], timings)


def _computed(gear, material, discretisation, positions, comm, report=None) -> tuple[dict[int, np.ndarray], dict]:
    """This rank's share of the positions, each meshed and condensed by it."""
    # Imported here: a run whose gears are all in the cache needs neither gmsh nor DOLFINx.
    from .remeshed_gear import RemeshedGear

    body = RemeshedGear(gear, material, element_named(discretisation.element), discretisation.sizes(gear))
    mine = range(len(positions)) if comm is None else range(comm.rank, len(positions), comm.size)
    stiffnesses = {}
    for done, index in enumerate(mine, 1):
        stiffnesses[index] = body.stiffness(positions[index])
        if report is not None:
            report(done, len(mine))
    return stiffnesses, body.timings
