"""The MPI job that this process belongs to, if any: rank 0 leads, the others carry out together with it what it asks
for.

An error of any rank is an error of all. A rank that fails while others wait for it inside a library, as MUMPS does,
reaches them by MPI's Abort alone. A process that runs alone never touches MPI.
"""

import contextlib
import functools
import logging
import signal
import sys
import time
import traceback
from array import array
from collections.abc import Callable, Iterator
from typing import Any, NoReturn

from fenics_gears.errors import ComputationError, GearsError, SceneError

from . import environment

LOGGER = logging.getLogger(__name__)

# Seconds for which a failed rank waits for the others, in case that they fail too, and between looks for messages.
PATIENCE = 5.0
BETWEEN_LOOKS = 0.005
END = None


def communicator():
    """COMM_WORLD of a job of several processes (`mpirun -n N`), None where this process was started alone. The first
    call of each rank waits for the others.

    Raises ComputationError where several processes were started that mpi4py cannot join.
    """
    started = environment.started_ranks()
    return None if started <= 1 else _joined(started)[0]


@functools.lru_cache(maxsize=1)
def _joined(started: int) -> tuple[Any, int]:
    """COMM_WORLD, and how many of its ranks are on this machine."""
    try:
        from mpi4py import MPI
    except ImportError as error:
        words = f"This is one of {started} processes, but mpi4py cannot be loaded ({error})."
        raise ComputationError(f"{words} Install it, or start one process.") from error
    world = MPI.COMM_WORLD
    if world.size != started:
        raise ComputationError(
            f"{started} processes were started, but mpi4py sees {world.size}: mpirun and mpi4py belong to different MPI"
            " installations. Use the mpirun of the MPI that mpi4py was built with."
        )
    here = world.Split_type(MPI.COMM_TYPE_SHARED)
    count = here.size
    here.Free()
    return world, count


def ranks_on_machine() -> int:
    """Processes of the job on this machine: as MPI counts them once it is joined, before as the environment says."""
    return _joined(environment.started_ranks())[1] if _joined.cache_info().currsize else environment.local_ranks()


class Job:
    """All ranks of a job: rank 0 calls `together` and at last `end`, every other one `follow`."""

    def __init__(self, world):
        self._world = world
        self.size = world.size
        # Requests and agreements never meet the messages of the work itself.
        self._talk = world.Dup()

    def together(self, work: Callable[..., Any], *arguments: Any, **here: Any) -> list[Any]:
        """What `work(*arguments, communicator)` returns on each rank, all of them at the same time; `here` is given to
        rank 0's call alone.

        Raises the error of rank 0, else that of another, with its number.
        """
        for rank in range(1, self.size):
            self._talk.send((work, arguments), rank)
        return self._carried_out(work, arguments, here)

    def end(self) -> None:
        """Let the other ranks go."""
        for rank in range(1, self.size):
            self._talk.send(END, rank)

    def follow(self) -> None:
        """Carry out what rank 0 asks for, until it lets this rank go."""
        while True:
            # A rank that waits inside MPI takes a core.
            while not self._talk.iprobe(source=0):
                time.sleep(BETWEEN_LOOKS)
            request = self._talk.recv(source=0)
            if request is END:
                return
            with contextlib.suppress(GearsError):  # rank 0 has it too
                self._carried_out(request[0], request[1], {})

    def _carried_out(self, work: Callable[..., Any], arguments: tuple, here: dict[str, Any]) -> list[Any]:
        error = None
        outcome = None
        with ending_all(self._world, KeyboardInterrupt):
            try:
                outcome = work(*arguments, self._world, **here)
            except Exception as raised:
                error = raised
            failures = self._failures(error)
            if not failures:
                # Rank 0 has its own: a copy of it might take gigabytes.
                others = (self._talk.gather(outcome if self._world.rank else None) or [None])[1:]
                return [outcome, *others]
        if error is not None and self._world.rank == 0:
            raise error
        raise next(iter(failures.values()))

    def _failures(self, error: Exception | None) -> dict[int, GearsError]:
        """The errors of all ranks, by rank. Where another rank does not come here soon after this one has failed, all
        end."""
        counted = array("i", [0])
        begun = time.monotonic()
        request = self._talk.Iallreduce(array("i", [error is not None]), counted)
        while not request.Test():
            if error is not None and time.monotonic() - begun > PATIENCE:
                _end_all(self._world, error)
            time.sleep(BETWEEN_LOOKS)
        told = self._talk.allgather(_told(error, self._world.rank)) if counted[0] else []
        return {rank: each for rank, each in enumerate(told) if each is not None}


def together(job: Any, work: Callable[..., Any], *arguments: Any, **here: Any) -> list[Any]:
    """As `Job.together`, or that of a `second_process.SecondProcess`; `work` has None as its communicator where this
    process is alone."""
    return [work(*arguments, None, **here)] if job is None else job.together(work, *arguments, **here)


def led(command: Callable[[Job | None], int]) -> int:
    """The exit code of a command that rank 0 carries out, with the job, or None where this process is alone. The other
    ranks follow; theirs is 0."""
    world = communicator()
    if world is None:
        return command(None)
    job = Job(world)
    if world.rank == 0:
        try:
            return command(job)
        finally:
            job.end()
    # Rank 0 decides.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    with ending_all(world):
        job.follow()
    return 0


@contextlib.contextmanager
def ending_all(world, kind: type[BaseException] = BaseException) -> Iterator[None]:
    """An error of this kind, in a rank for which others may wait, ends all ranks with its words and its exit code."""
    try:
        yield
    except kind as error:
        _end_all(world, error)


def _end_all(world, error: BaseException) -> NoReturn:
    if isinstance(error, KeyboardInterrupt):
        print("Interrupted before there was anything to keep.", file=sys.stderr, flush=True)
        world.Abort(128 + signal.SIGINT)
    if not isinstance(error, GearsError):
        traceback.print_exception(error)
    told = _told(error, world.rank)
    print(told, file=sys.stderr, flush=True)
    world.Abort(told.exit_code)
    raise AssertionError("MPI's Abort came back") from error


def _told(error: BaseException | None, rank: int) -> GearsError | None:
    if error is None:
        return None
    if not isinstance(error, GearsError):
        LOGGER.debug("rank %d", rank, exc_info=error)
        return ComputationError(f"rank {rank}: {type(error).__name__}: {error}")
    return (SceneError if isinstance(error, SceneError) else ComputationError)(f"rank {rank}: {error}")
