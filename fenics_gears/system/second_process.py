"""A second process that computes one thing while this one computes another. Libraries under MPI and gmsh allow no two
threads. Two gears on half of the cores each are quicker than one after the other on all cores.

It is started anew: a copy of a process that has loaded MPI, or that has threads, may hang.
"""

import os
import pickle
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from fenics_gears.errors import ComputationError, GearsError

from .environment import THREADS, threads

PROGRAM = "from fenics_gears.system.second_process import serve; serve()"


class SecondProcess:
    """As a `job.Job` of one rank, which carries out everything in a process of its own."""

    size = 1

    def __init__(self, threads: int):
        self._threads = threads
        self._ended = False
        self._process: subprocess.Popen[bytes] | None = None

    def together(self, work: Callable[..., Any], *arguments: Any) -> list[Any]:
        """What `work(*arguments, None)` returns there. Raises its GearsError; ComputationError where the process
        fails."""
        root = str(Path(__file__).parents[2])
        paths = os.pathsep.join([root, *filter(None, [os.environ.get("PYTHONPATH")])])
        environment = os.environ | {"PYTHONPATH": paths} | dict.fromkeys(THREADS, str(self._threads))
        with subprocess.Popen(
            [sys.executable, "-P", "-c", PROGRAM], stdin=subprocess.PIPE, stdout=subprocess.PIPE, env=environment
        ) as process:
            self._process = process
            if self._ended:
                process.kill()
            assert process.stdin and process.stdout
            try:
                with process.stdin:
                    pickle.dump((work, arguments), process.stdin)
                failed, outcome = pickle.load(process.stdout)
            except (OSError, EOFError, pickle.UnpicklingError) as error:
                why = f"the process that condenses the second gear ended without a result (code {process.wait()})"
                remedy = "Memory may be short; OMP_NUM_THREADS=1 condenses one gear after the other."
                raise ComputationError(f"{why}. {remedy}") from error
        if failed:
            raise outcome
        return [outcome]

    def end(self) -> None:
        """End the process if it is still at work; who waits for it gets a ComputationError."""
        self._ended = True
        if self._process is not None:
            self._process.kill()


@contextmanager
def second_process() -> Iterator[SecondProcess]:
    """A second process with half of the threads; BLAS has the others here as long as it is there."""
    from threadpoolctl import threadpool_limits

    half = threads() // 2
    process = SecondProcess(half)
    with threadpool_limits(limits=threads() - half, user_api="blas"):
        try:
            yield process
        finally:
            process.end()


def serve() -> None:
    """Be the second process."""
    # What libraries print must not come between; who started this process decides when it ends.
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    outcome: Any
    try:
        work, arguments = pickle.load(sys.stdin.buffer)
        failed = False
        outcome = work(*arguments, None)
    except Exception as error:
        failed = True
        outcome = error if isinstance(error, GearsError) else ComputationError(f"{type(error).__name__}: {error}")
    pickle.dump((failed, outcome), answers, protocol=pickle.HIGHEST_PROTOCOL)
    answers.close()
    sys.stdout.flush()
    # MPI and PETSc have nothing to put away; taking all libraries apart would take 0.4 s.
    os._exit(0)
