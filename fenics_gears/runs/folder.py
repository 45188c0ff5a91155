"""The files of a study's cases: a NetCDF file for each, or a text on why it failed. A later run of the study finds them
by their content."""

from __future__ import annotations

import contextlib
import fcntl
import json
import logging
import os
from collections.abc import Iterable, Iterator
from pathlib import Path

import xarray as xr

from fenics_gears import results
from fenics_gears.errors import ComputationError
from fenics_gears.numbers_version import NUMBERS_VERSION
from fenics_gears.studies.combine import CaseRecord, record_of
from fenics_gears.studies.study import Case, Study
from fenics_gears.system.output import remove_left_over, write_whole

LOGGER = logging.getLogger(__name__)
ENDING, FAILED_ENDING = ".nc", ".failed.txt"


def save_case(run: xr.Dataset, case: Case, directory: Path) -> CaseRecord:
    """Write the run of a case and return its record; a note on an earlier failure goes."""
    results.save(
        run.assign_attrs(case_key=case.key, case_values=json.dumps(case.values)), directory / f"{case.name}{ENDING}"
    )
    (directory / f"{case.name}{FAILED_ENDING}").unlink(missing_ok=True)
    return record_of(run)


def save_failure(case: Case, reason: str, details: str, directory: Path) -> None:
    """Write why a case failed, and its scene."""
    text = f"{case} failed: {reason}\n\n{details}\nIts scene:\n\n{case.scene.text}"
    try:
        write_whole(directory / f"{case.name}{FAILED_ENDING}", lambda aside: aside.write_text(text, encoding="utf-8"))
    except ComputationError as error:
        LOGGER.warning("%s: the note on its failure could not be written: %s", case, error)


def kept_records(cases: Iterable[Case], directory: Path) -> dict[int, CaseRecord]:
    """Records, by the case's index, of the cases whose whole and undamaged runs are there.

    A file whose case has another index by now gets its new name.
    """
    files = {path.stem.rpartition("-")[2]: path for path in sorted(directory.glob(f"*{ENDING}"))}
    found = {}
    for case in cases:
        path = files.get(case.name.rpartition("-")[2])
        record = None if path is None else _undamaged(path, case)
        if record is not None:
            found[case.index] = record
            if path.stem != case.name:
                os.replace(path, directory / f"{case.name}{ENDING}")
    return found


def _undamaged(path: Path, case: Case) -> CaseRecord | None:
    try:
        run = results.load(path)
        if (run.attrs.get("case_key"), run.attrs.get("complete")) != (case.key, 1):
            raise ValueError("it does not hold what was written into it")
        return record_of(run)
    # A damaged HDF5 file is reported by many types, RuntimeError and KeyError among them.
    except Exception as error:
        LOGGER.warning("%s is not usable and its case is computed again: %s", path, error)
        return None


@contextlib.contextmanager
def sole_writer(directory: Path, inside: str = "cases") -> Iterator[None]:
    """Lock the study's directory for this process, make the folder `inside` it, and remove half-written files of a
    study that was killed.

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
            raise ComputationError(
                f"{directory}: another study is writing there. Wait for it, or choose another directory with --output"
                " DIR."
            ) from None
        except OSError as error:
            LOGGER.debug("%s: no locks on this file system: %s", directory, error)
        for left in (directory / "cases").glob(".*.part"):
            left.unlink(missing_ok=True)
        for written in (directory, directory / inside):
            remove_left_over(written)
        yield


def changed_since(study: Study, directory: Path) -> str:
    """A sentence where the study was last run here by a version of the program with other numbers, or with another base
    scene; else empty.

    Writes `study.json` with the present ones, which also lists which file holds which case.
    """
    path = directory / "study.json"
    try:
        index = json.loads(path.read_text(encoding="utf-8"))
        before, numbers = index.get("base_scene"), index.get("numbers_version")
    except (OSError, ValueError, AttributeError):
        before = numbers = None
    index = {
        "title": study.title,
        "base_scene": study.base_key,
        "numbers_version": NUMBERS_VERSION,
        "cases": {case.name: case.values for case in study.cases},
    }
    write_whole(path, lambda aside: aside.write_text(json.dumps(index, indent=1, ensure_ascii=False), encoding="utf-8"))
    if before is None or before == study.base_key:
        return ""
    if numbers != NUMBERS_VERSION:
        return "Results that are here of a version of the program with other numbers are not used."
    return "The base scene has changed since the last time."
