"""``python -m fenics_gears`` is the same as the command ``gears``."""

import atexit
import gc
import os
import signal
import sys
from collections.abc import Callable


def command() -> None:
    """Run the command line and end the process."""
    code = _main()()
    # What is left ends with the process; nobody need look for garbage in it.
    gc.freeze()
    # Taking all libraries apart would take 0.4 s.
    atexit._run_exitfuncs()
    _leave_job()
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code)


def _main() -> Callable[[], int]:
    """The command line. Ctrl-C while it is imported ends the process without a word."""
    handler = signal.getsignal(signal.SIGINT)
    if handler is signal.default_int_handler:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    from fenics_gears.commands.cli import main

    signal.signal(signal.SIGINT, handler)
    return main


def _leave_job() -> None:
    """End PETSc and MPI where they are loaded: a job's launcher takes a process that leaves without for a failure."""
    petsc = sys.modules.get("petsc4py.PETSc")
    mpi = sys.modules.get("mpi4py.MPI")
    if petsc is not None:
        # What Python would call at the end of the interpreter.
        petsc._finalize()
    if mpi is not None and not mpi.Is_finalized():
        mpi.Finalize()


if __name__ == "__main__":
    command()
