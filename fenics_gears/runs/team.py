"""Many tasks over the processes of one MPI job, or one after another in a process that runs alone, which never touches
MPI.

Ranks 1 to N-1 are workers of mpi4py.futures. Rank 0 hands out tasks from the first on by mpi4py's own thread. Itself it
takes back and computes tasks from the last on.
"""

import contextlib
import importlib
import queue
import signal
from collections.abc import Callable, Iterator, Sequence
from typing import Any

from fenics_gears.simulation.warm_up import compile_kernels
from fenics_gears.system.job import communicator, ending_all

SECONDS_BETWEEN_LOOKS = 0.05

Task = Callable[..., Any]
"""A function of a task and of a callable that it calls now and then; workers do not get the latter."""
Finished = Callable[[int, Any], None]
"""Called by rank 0's main thread with a task's index and its outcome, or the exception that ended it."""

# Tasks for each process from which on rank 0 first does something else: of fewer the others would leave it none.
MANY = 4
Meanwhile = Callable[[], object]
"""What rank 0 does for the end of a job when the other ranks first have enough to compute, such as loading a library:
the end, where they wait, is that much shorter."""


class Alone:
    """One process, which computes all runs itself."""

    size = 1

    def run(self, function: Task, tasks: Sequence[Any], finished: Finished, tick: Callable[[], None]) -> None:
        """Compute every task; ``tick`` is called often and may raise KeyboardInterrupt."""
        for index, task in enumerate(tasks):
            tick()
            finished(index, _outcome(lambda: function(task, tick)))


class Together:
    """All ranks of a job, as rank 0 directs them."""

    def __init__(self, executor, size: int, meanwhile: Meanwhile | None = None):
        self._executor = executor
        self.size = size
        self._meanwhile = meanwhile

    def run(self, function: Task, tasks: Sequence[Any], finished: Finished, tick: Callable[[], None]) -> None:
        """Compute every task; ``tick`` is called often and may raise KeyboardInterrupt, which ends the ranks after
        their present task."""
        done: queue.SimpleQueue = queue.SimpleQueue()
        futures = [self._executor.submit(function, task) for task in tasks]
        for index, future in enumerate(futures):
            future.add_done_callback(lambda future, index=index: done.put((index, future)))
        left = len(tasks)

        def receive(wait: float | None = None) -> None:
            nonlocal left
            with contextlib.suppress(queue.Empty):
                while True:
                    index, future = done.get(timeout=wait) if wait else done.get_nowait()
                    if not future.cancelled():
                        left -= 1
                        finished(index, _outcome(future.result))

        def look() -> None:
            receive()
            tick()

        try:
            if left >= MANY * self.size and self._meanwhile is not None:
                self._meanwhile()
                self._meanwhile = None
            for index in reversed(range(len(tasks))):
                look()
                if futures[index].cancel():
                    outcome = _outcome(lambda: function(tasks[index], look))
                    left -= 1
                    finished(index, outcome)
            while left:
                receive(SECONDS_BETWEEN_LOOKS)
                tick()
        except BaseException:
            for future in futures:
                future.cancel()
            for future in futures:
                if not future.cancelled():
                    _outcome(future.result)
            receive()
            raise


def _outcome(compute: Callable[[], Any]) -> Any:
    try:
        return compute()
    except Exception as error:
        return error


def _load_what_runs_need() -> None:
    """Half a second of libraries and compiled code, while rank 0 reads what there is to do."""
    for module in ("results.files", "simulation.elastic_route"):
        importlib.import_module(f"fenics_gears.{module}")
    compile_kernels(tangential=True)


@contextlib.contextmanager
def ranks(meanwhile: Meanwhile | None = None) -> Iterator[Alone | Together | None]:
    """The processes that work together; None on every rank but 0, once there is no more to do. What is to be done
    `meanwhile` is done only by a job of several processes that gets tasks.

    Raises ComputationError where a job of several processes was started that mpi4py cannot join.
    """
    world = communicator()
    if world is None:
        yield Alone()
        return
    from mpi4py.futures import MPICommExecutor

    if world.rank > 0:
        # Rank 0 decides; a worker that Ctrl-C also reaches would leave it waiting.
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        with ending_all(world):
            _load_what_runs_need()
            with MPICommExecutor(world, root=0):
                pass
        yield None
        return
    with MPICommExecutor(world, root=0) as executor:
        yield Together(executor, world.size, meanwhile)
