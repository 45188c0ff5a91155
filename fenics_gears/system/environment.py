"""What MPI, PETSc and BLAS read from the process environment, set before they are loaded.

A variable the user has set is never changed, unless it names a folder that cannot be used (``system.folders``).
"""

import os
import re

from fenics_gears.system import blas, folders

RANK_COUNTS = ("OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS")
"""Where Open MPI, MPICH and Slurm say how many processes run together."""
LOCAL_COUNTS = ("OMPI_COMM_WORLD_LOCAL_SIZE", "MPI_LOCALNRANKS", "SLURM_STEP_TASKS_PER_NODE")
"""Where they say how many of these are on one machine."""


def prepare(environment=os.environ):
    """Give MPI, PETSc and BLAS the settings this program needs; call it before NumPy or mpi4py is imported.

    environment: the mapping to complete, the process's own unless a test passes another.

    Raises SceneError where compiled code can be kept nowhere.
    """
    for name, value in defaults(environment).items():
        environment.setdefault(name, value)
    folders.have_folders(environment, aloud=started_ranks(environment) == 1)
    blas.choose(environment)


def defaults(environment):
    """Variables and their values where the user has not set them; `environment` shows how the process was started."""
    # PETSc would take a reader of the output that has gone for a crash, and abort.
    values = {"PETSC_OPTIONS": "-no_signal_handler"}
    if os.geteuid() == 0:
        # Containers run as root, where the mpirun started by this process (Open MPI 4, then 5) refuses to work without.
        for prefix in ("OMPI", "PRTE"):
            values[f"{prefix}_ALLOW_RUN_AS_ROOT"] = "1"
            values[f"{prefix}_ALLOW_RUN_AS_ROOT_CONFIRM"] = "1"
    ranks = started_ranks(environment)
    if ranks == local_ranks(environment):
        # On one machine ranks meet in shared memory; TCP only warns about interfaces it cannot pair.
        values["OMPI_MCA_btl"] = "^tcp,ofi"
    if ranks > 1 and "OMP_NUM_THREADS" not in environment:
        # OpenBLAS and MKL follow OMP_NUM_THREADS unless each is set by itself.
        values["OMP_NUM_THREADS"] = "1"
    return values


def started_ranks(environment=os.environ):
    """How many processes were started together; 1 for a process that was started alone."""
    return _largest(environment, RANK_COUNTS)


def local_ranks(environment=os.environ):
    """How many of them are on this machine, or on the one that has most; 1 for a process that was started alone."""
    return _largest(environment, LOCAL_COUNTS)


def on_terminal_of_its_own(environment=os.environ):
    """Whether this process's terminal is nobody's: Open MPI and MPICH start each process on a pseudo-terminal, whatever
    mpirun itself writes to."""
    return any(name in environment for name in RANK_COUNTS[:2])


def _largest(environment, names):
    # Slurm counts by machine, "4(x2),3": four on each of two, three on another.
    counts = re.findall(r"\d+", re.sub(r"\(x\d+\)", "", ",".join(environment.get(name, "") for name in names)))
    return max([1, *map(int, counts)])
