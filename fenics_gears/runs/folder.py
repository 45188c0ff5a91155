"""Runs in a folder: a NetCDF file for each, or a text on why it failed."""

from __future__ import annotations

import contextlib
import fcntl
import json
import logging
import os
import traceback
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, BinaryIO, ClassVar

from fenics_gears import results
from fenics_gears.errors import ComputationError
from fenics_gears.results.dataset import RunResult
from fenics_gears.results.stored import stored
from fenics_gears.system.output import remove_left_over, unsealed, write_whole

from .record import RunRecord, record_of
from .run import Run
from .runs import Failure, failure_of
from .spent import seconds_of

if TYPE_CHECKING:
    from .train import RunOfTrain

LOGGER = logging.getLogger(__name__)
ENDING = ".nc"
FAILED_ENDING = ".failed.txt"
FILES_AHEAD = 8


@dataclass(frozen=True)
class Folder:
    """A folder of runs. A file is known by what it holds: a run whose index is another by now gives it a new name."""

    directory: Path
    asked: ClassVar[None] = None

    def known(self, runs: Iterable[Run]) -> dict[str, RunRecord]:
        """Records of the runs whose whole and undamaged files are there."""
        files = {path.stem.rpartition("-")[2]: path for path in sorted(self.directory.glob(f"*{ENDING}"))}
        there = [(run, path) for run in runs if (path := files.get(run.name.rpartition("-")[2])) is not None]
        records = {}
        for (run, path), opened in zip(there, _opened(path for _, path in there)):
            record = _undamaged(path, run, opened)
            if record is not None:
                records[run.key] = record
                if path.stem != run.name:
                    os.replace(path, self._file(run, ENDING))
        return records

    def keep(self, run: Run, ran: RunResult | RunOfTrain) -> RunRecord:
        """Write the result and return its record; a note on an earlier failure goes."""
        result = ran.dataset
        said = {"case_key": run.key, "case_values": json.dumps(run.values)}
        results.save(result.assign_attrs(said), self._file(run, ENDING))
        self._file(run, FAILED_ENDING).unlink(missing_ok=True)
        return replace(record_of(result), seconds=seconds_of(ran))

    def seconds(self, known: RunRecord) -> tuple[float, ...]:
        return known.seconds

    def keep_failure(self, run: Run, error: Exception) -> Failure:
        """Write why the run failed, and its scene; the next time it is tried again."""
        reason = failure_of(error)
        details = "".join(traceback.format_exception(error))
        text = f"{run} failed: {reason}\n\n{details}\nIts scene:\n\n{run.scene.text}"
        try:
            write_whole(self._file(run, FAILED_ENDING), lambda aside: aside.write_text(text, encoding="utf-8"))
        except ComputationError as unwritten:
            LOGGER.warning("%s: the note on its failure could not be written: %s", run, unwritten)
        return reason

    def _file(self, run: Run, ending: str) -> Path:
        return self.directory / f"{run.name}{ending}"


def _opened(paths: Iterable[Path]) -> Iterator[Callable[[], BinaryIO]]:
    """What opens each of the files, as `unsealed`; a thread compares the digests of a few files ahead."""
    with ThreadPoolExecutor(1) as thread:
        waiting: deque[Future[BinaryIO]] = deque()
        for path in paths:
            waiting.append(thread.submit(unsealed, path))
            if len(waiting) > FILES_AHEAD:
                yield waiting.popleft().result
        while waiting:
            yield waiting.popleft().result


def _undamaged(path: Path, run: Run, opened: Callable[[], BinaryIO]) -> RunRecord | None:
    try:
        with opened() as content, stored(content) as result:
            if (result.attrs.get("case_key"), result.attrs.get("complete")) != (run.key, 1):
                raise ValueError("it does not hold what was written into it")
            return record_of(result)
    # A damaged HDF5 file is reported by many types, RuntimeError and KeyError among them.
    except Exception as error:
        LOGGER.warning("%s is not usable and its case is computed again: %s", path, error)
        return None


@contextlib.contextmanager
def sole_writer(directory: Path, inside: str = "cases") -> Iterator[None]:
    """Lock the study's directory for this process, make the folder `inside` it, and remove what a killed study left
    half-written.

    Raises ComputationError where another study is writing there, or nothing can be written.
    """
    try:
        (directory / inside).mkdir(parents=True, exist_ok=True)
        lock = open(directory / ".lock", "w")
    except OSError as error:
        raise ComputationError(f"{directory}: cannot be written to: {error.strerror or error}") from error
    with lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            remedy = "Wait for it, or choose another directory with --output DIR."
            raise ComputationError(f"{directory}: another study is writing there. {remedy}") from None
        except OSError as error:
            LOGGER.debug("%s: no locks on this file system: %s", directory, error)
        for written in (directory, directory / inside):
            remove_left_over(written)
        yield
