"""``python -m fenics_gears`` is the same as the command ``gears``."""

import atexit
import gc
import os
import sys

from fenics_gears.commands.cli import main


def command() -> None:
    """Run the command line and end the process."""
    code = main()
    # What is left ends with the process; nobody need look for garbage in it.
    gc.freeze()
    if "mpi4py.MPI" in sys.modules or "petsc4py.PETSc" in sys.modules:
        # They have an end of their own.
        sys.exit(code)
    # Taking all libraries apart would take 0.4 s.
    atexit._run_exitfuncs()
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code)


if __name__ == "__main__":
    command()
