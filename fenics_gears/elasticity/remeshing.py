"""The stiffness of a gear at all positions of a mesh cycle, meshed anew at each, shared out between MPI ranks."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict
from time import perf_counter

import numpy as np

from fenics_gears.elasticity.cache import Cache, content_key
from fenics_gears.elasticity.elements import element_named
from fenics_gears.elasticity.gear_compliance import element_sizes
from fenics_gears.errors import ComputationError, GearsError
from fenics_gears.geometry.gear import Gear
from fenics_gears.scene.data import Material

# To be raised by one whenever the same inputs give other numbers.
ALGORITHM_VERSION = 1


def remeshed_stiffness(
    gear: Gear,
    material: Material,
    positions: list,
    *,
    element: str,
    flank_element_size: float,
    cache: Cache | None = None,
    comm=None,
    report: Callable[[int, int], None] | None = None,
) -> tuple[list[np.ndarray], dict]:
    """Stiffness (2 K + 3, 2 K + 3), N/mm per mm of face width, at each position, and what it cost (s).

    positions: for each the loaded teeth, tuples of remeshed_gear.LoadedTooth. comm: communicator that shares the positions out
    (every rank calls this and gets all); None: this process alone, without MPI. report: called with positions done and in all.
    Raises ComputationError, on every rank, when a position fails on any.
    """
    key = content_key({
        "remeshed": ALGORITHM_VERSION,
        "gear": asdict(gear),
        "poissons_ratio": material.poissons_ratio,
        "element": element,
        "sizes": asdict(element_sizes(gear, element_named(element), flank_element_size)),
        "positions": [[[tooth.angle, tooth.rolls.tolist()] for tooth in teeth] for teeth in positions],
    })
    clock = perf_counter()
    cached = _from_rank_0(comm, lambda: cache.load(key) if cache is not None else None)
    if cached is not None:
        stiffness = [material.youngs_modulus * cached[str(i)] for i in range(len(positions))]
        return stiffness, {"from_cache": True, "time_mesh": 0.0, "time_compile": 0.0, "time_condense": perf_counter() - clock}
    parts, timings = _shared(
        lambda mine: _computed(gear, material, element, flank_element_size, positions, mine, report), len(positions), comm
    )
    if cache is not None and (comm is None or comm.rank == 0):
        cache.store(key, {str(i): parts[i] / material.youngs_modulus for i in parts})
    return [parts[i] for i in range(len(positions))], {"from_cache": False, **timings}


def _computed(gear, material, element, flank_element_size, positions, mine, report) -> tuple[dict[int, np.ndarray], dict]:
    """Positions `mine`, each meshed and condensed by this process."""
    # Imported here: a run whose gears are all in the cache needs neither gmsh nor DOLFINx.
    from fenics_gears.elasticity.remeshed_gear import RemeshedGear

    chosen = element_named(element)
    body = RemeshedGear(gear, material, chosen, element_sizes(gear, chosen, flank_element_size))
    found = {}
    for done, index in enumerate(mine, 1):
        found[index] = body.stiffness(positions[index])
        if report is not None:
            report(done, len(mine))
    return found, body.timings


def _from_rank_0(comm, function):
    if comm is None:
        return function()
    return comm.bcast(function() if comm.rank == 0 else None, root=0)


def _shared(compute, count: int, comm) -> tuple[dict[int, np.ndarray], dict]:
    """All ranks' positions and the largest of their times; a failure on one rank is raised on all."""
    if comm is None:
        return compute(range(count))
    try:
        mine = (*compute(range(comm.rank, count, comm.size)), None)
    except GearsError as failure:
        mine = ({}, {}, str(failure))
    everyone = comm.allgather(mine)
    failures = [f"rank {rank}: {failure}" for rank, (_, _, failure) in enumerate(everyone) if failure is not None]
    if failures:
        raise ComputationError("remeshing failed on " + "; ".join(failures))
    parts = {index: stiffness for found, _, _ in everyone for index, stiffness in found.items()}
    timings = {name: max(times[name] for _, times, _ in everyone) for name in everyone[0][1]}
    return parts, timings
