"""Stiffness of a gear at all positions of a mesh cycle, meshed anew at each; MPI ranks share the positions."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass
from time import perf_counter

import numpy as np

from fenics_gears.elasticity.cache import Cache, content_key
from fenics_gears.elasticity.element_sizes import Discretisation
from fenics_gears.elasticity.elements import element_named
from fenics_gears.errors import ComputationError, GearsError
from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.gear_data import Material
from fenics_gears.numbers_version import NUMBERS_VERSION


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
    comm=None,
    report: Callable[[int, int], None] | None = None,
) -> RemeshedStiffness:
    """Stiffness of a gear at all positions: meshed and condensed, or from the cache.

    positions: for each the loaded teeth, tuples of remeshed_gear.LoadedTooth. comm: communicator that shares the positions out
    (every rank calls this, rank 0 gets them all, the others none); None: this process alone, without MPI. report: called with
    positions done and in all, by this process. Raises ComputationError, on every rank, when a position fails on any.
    """
    key = content_key({
        "remeshed": NUMBERS_VERSION,
        "gear": asdict(gear),
        "poissons_ratio": material.poissons_ratio,
        "element": discretisation.element,
        "sizes": asdict(discretisation.sizes(gear)),
        "positions": [[[tooth.angle, tooth.rolls.tolist()] for tooth in teeth] for teeth in positions],
    })
    clock = perf_counter()
    first = comm is None or comm.rank == 0
    cached = cache.load(key) if first and cache is not None else None
    known = cached is not None
    if comm is not None:
        known = comm.bcast(known, root=0)
    if known:
        stiffness = [material.youngs_modulus * cached[str(i)] for i in range(len(positions))] if first else []
        timings = {"from_cache": True, "time_mesh": 0.0, "time_compile": 0.0, "time_condense": perf_counter() - clock}
        return RemeshedStiffness(stiffness, timings)
    parts, timings = _shared(
        lambda mine: _computed(gear, material, discretisation, positions, mine, report),
        len(positions),
        comm,
    )
    if cache is not None and first:
        cache.store(key, {str(i): parts[i] / material.youngs_modulus for i in parts})
    return RemeshedStiffness([parts[i] for i in sorted(parts)], {"from_cache": False, **timings})


def _computed(gear, material, discretisation, positions, mine, report) -> tuple[dict[int, np.ndarray], dict]:
    """Positions `mine`, each meshed and condensed by this process."""
    # Imported here: a run whose gears are all in the cache needs neither gmsh nor DOLFINx.
    from fenics_gears.elasticity.remeshed_gear import RemeshedGear

    body = RemeshedGear(gear, material, element_named(discretisation.element), discretisation.sizes(gear))
    found = {}
    for done, index in enumerate(mine, 1):
        found[index] = body.stiffness(positions[index])
        if report is not None:
            report(done, len(mine))
    return found, body.timings


def _shared(compute, count: int, comm) -> tuple[dict[int, np.ndarray], dict]:
    """All ranks' positions on rank 0, none on the others, and the longest of their times; a failure on one is raised on all."""
    if comm is None:
        return compute(range(count))
    failure, mine, times = None, {}, {}
    try:
        mine, times = compute(range(comm.rank, count, comm.size))
    except Exception as error:
        # Of any kind: the other ranks wait in allgather and would hang.
        failure = f"rank {comm.rank}: {error}" if isinstance(error, GearsError) else f"rank {comm.rank}: {type(error).__name__}: {error}"
    failures = [each for each in comm.allgather(failure) if each is not None]
    if failures:
        raise ComputationError("remeshing failed on " + "; ".join(failures))
    times = comm.allgather(times)
    longest = {name: max(each[name] for each in times) for name in times[0]}
    everyone = comm.gather(mine, root=0) or []
    return {index: stiffness for found in everyone for index, stiffness in found.items()}, longest
