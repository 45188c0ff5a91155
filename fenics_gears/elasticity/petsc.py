"""PETSc, started by this process for itself: for all ranks of a job it would wait until the last of them loads it."""

import petsc4py
from mpi4py import MPI

petsc4py.init(comm=MPI.COMM_SELF)

from petsc4py import PETSc  # noqa: E402

__all__ = ["PETSc"]
