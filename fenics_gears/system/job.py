"""The MPI job that this process belongs to, if any. A process that runs alone never touches MPI."""

from __future__ import annotations

from fenics_gears.errors import ComputationError
from fenics_gears.system.environment import started_ranks


def communicator():
    """COMM_WORLD of a job of several processes (`mpirun -n N`), None where this process was started alone.

    Raises ComputationError where several processes were started that mpi4py cannot join.
    """
    started = started_ranks()
    if started <= 1:
        return None
    try:
        from mpi4py import MPI
    except ImportError as error:
        raise ComputationError(f"This is one of {started} processes, but mpi4py cannot be loaded ({error}). Install it, or start one process.") from error
    world = MPI.COMM_WORLD
    if world.size != started:
        raise ComputationError(
            f"{started} processes were started, but mpi4py sees {world.size}: mpirun and mpi4py belong to different MPI installations. "
            "Use the mpirun of the MPI that mpi4py was built with."
        )
    return world
