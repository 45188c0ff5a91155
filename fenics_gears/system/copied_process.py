"""Tasks of a copy of this process, which has all that is imported and computed: half of the work, on a second
processor, or what may end a process."""

from __future__ import annotations

import faulthandler
import os
import signal
import sys
import warnings
from collections.abc import Callable, Sequence

Task = Callable[[], object]
# Loaded, they allow no copy.
MPI = {"mpi4py.MPI", "petsc4py.PETSc"}


def do_all(tasks: Sequence[Task], shared: bool) -> None:
    """Do tasks that write files, one after the other; if `shared`, the first, third and so on in a copy of this process
    where there may be one.

    What the copy does not finish is done here, and fails here if it fails. Shared only where all threads of the process
    are this program's own:
    others might hold what the copy then waits for.
    """
    copied = tasks[::2] if shared and len(tasks) > 1 and _may_copy() else ()
    copy = _copy_doing(copied) if copied else None
    try:
        for task in tasks[1::2] if copied else tasks:
            task()
        failed = copy is None or os.waitpid(copy, 0)[1]
    except BaseException:
        if copy is not None:
            os.kill(copy, signal.SIGKILL)
            os.waitpid(copy, 0)
        raise
    for task in copied if failed else ():
        task()


def survives(task: Task) -> bool:
    """Whether a copy of this process comes through a task to its end, or to an error; taken for granted where there may
    be no copy."""

    def in_silence() -> None:
        # What a library that ends the process says, and Python's own handler of its signal.
        faulthandler.disable()
        os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
        task()

    copy = None if MPI & set(sys.modules) else _copy_doing([in_silence])
    return copy is None or not os.WIFSIGNALED(os.waitpid(copy, 0)[1])


def _may_copy() -> bool:
    """Whether a processor is idle, without which a copy takes longer than it saves, and MPI, which allows none, is not
    loaded."""
    processors = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else 1
    return processors > 1 and os.getloadavg()[0] < processors - 0.5 and not MPI & set(sys.modules)


def _copy_doing(tasks: Sequence[Task]) -> int | None:
    """The number of a copy that does the tasks, ends with 0 when they are done, and says nothing; None where the system
    gives none."""
    here, failed = os.getpid(), 1
    try:
        with warnings.catch_warnings():
            # Python 3.12 warns of threads: BLAS ends its own before the copy is made, and those of a progress bar hold
            # nothing that the copy uses.
            warnings.simplefilter("ignore", DeprecationWarning)
            copy = os.fork()
        if not copy:
            for task in tasks:
                task()
            failed = 0
        return copy
    except OSError:
        return None
    finally:
        if os.getpid() != here:
            # Also after Ctrl-C: the copy must not go on with what this process was about to do.
            os._exit(failed)
