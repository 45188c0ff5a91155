"""A study from its file to its combined dataset: the stages, in order."""

import json
import logging
import sys
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from fenics_gears.numbers_version import NUMBERS_VERSION
from fenics_gears.runs.folder import Folder, sole_writer
from fenics_gears.runs.record import Record
from fenics_gears.runs.run import Run
from fenics_gears.runs.runs import Failure, Runs
from fenics_gears.runs.spent import Spent
from fenics_gears.runs.team import Alone, Meanwhile, Together, ranks
from fenics_gears.system.output import check_writable, write_whole
from fenics_gears.system.progress import Interruption, Progress

from .combine import STUDY_FILE, combined, save_study
from .study import Study
from .study_file import load_study

LOGGER = logging.getLogger(__name__)


@dataclass
class Outcome:
    """Results of a study so far, and why cases failed, by the case's index; `kept`: how many results were there before;
    `spent`: on the others."""

    study: Study
    file: Path | None = None
    kept: int = 0
    records: dict[int, Record] = field(default_factory=dict)
    failures: dict[int, str] = field(default_factory=dict)
    spent: Spent = field(default_factory=Spent)
    interrupted: bool = False


def run_study(
    path: Path, output: Path | None, progress: Progress, quiet: bool = False, meanwhile: Meanwhile | None = None
) -> Outcome | None:
    """Run what is missing of a study and write its dataset; None on every rank of an MPI job but 0.

    output: the study's directory, `results/<name of the study file>` where None; meanwhile: as in `ranks`. Raises
    SceneError, before anything is computed or written, where the study is wrong; ComputationError where its directory
    cannot be used.
    """
    with ranks(meanwhile) as team:
        if team is None:
            return None
        study = load_study(path)
        return run_with(team, study, output or Path("results") / study.name, progress, quiet)


def run_with(team: Alone | Together, study: Study, directory: Path, progress: Progress, quiet: bool = False) -> Outcome:
    """Run what is missing of a study in its directory, with the processes of rank 0's team. Raises ComputationError
    where the directory cannot be used."""
    check_writable(directory, STUDY_FILE, "study.json")
    with sole_writer(directory):
        return _run(study, directory, team, progress, quiet)


def _run(study: Study, directory: Path, team: Alone | Together, progress: Progress, quiet: bool) -> Outcome:
    runs = Runs(Folder(directory / "cases"), team, study.cases)
    outcome, missing = Outcome(study, kept=runs.kept, spent=runs.spent), runs.missing(study.cases)
    opening = _opening(study, runs.kept, len(missing), changed_since(study, directory), team.size)
    if not quiet:
        print(opening, file=sys.stderr, flush=True)
    with Interruption(progress) as interruption:
        try:
            runs.condense(missing, interruption)
            _compute(runs, missing, interruption)
        except KeyboardInterrupt:
            outcome.interrupted = True
        interruption.ignore()
        for case in study.cases:
            found = runs.known.get(case.key)
            if isinstance(found, Failure):
                outcome.failures[case.index] = str(found)
            elif found is not None:
                outcome.records[case.index] = found
        outcome.file = save_study(combined(study, outcome.records, outcome.failures), directory)
    return outcome


def _opening(study: Study, kept: int, missing: int, changed: str, size: int) -> str:
    of_it = f"{kept} kept, {missing} to be computed" if kept else f"{missing} to be computed"
    by = f", by {size} processes" if size > 1 else ""
    return f"{study.title}: {len(study.cases)} cases, {of_it}{by}. {changed}".rstrip()


def _compute(runs: Runs, missing: list[Run], progress: Interruption) -> None:
    if not missing:
        return
    progress.stage("cases")
    done = failed = 0

    def count() -> None:
        progress.update(done, len(missing), f"{failed} failed" if failed else "")

    def finished(case: Run, found: Any) -> None:
        nonlocal done, failed
        done += 1
        if isinstance(found, Failure):
            failed += 1
            LOGGER.warning("%s failed: %s", case, found.splitlines()[0])

    runs.compute(missing, count, finished)
    count()


def changed_since(study: Study, directory: Path) -> str:
    """A sentence where the study was last run here by a version of the program with other numbers, or with another base
    scene; else empty. Writes `study.json` with the present ones, which also lists which file holds which case."""
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
