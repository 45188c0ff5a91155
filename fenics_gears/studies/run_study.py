"""A study from its file to its combined dataset: the stages, in order."""

import logging
import sys
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from fenics_gears.runs.folder import Folder, sole_writer
from fenics_gears.runs.lines import FolderOfLines
from fenics_gears.runs.record import RunRecord, line_of, record_of_line
from fenics_gears.runs.run import Run
from fenics_gears.runs.runs import Failure, Runs
from fenics_gears.runs.spent import Spent
from fenics_gears.runs.team import Alone, Meanwhile, Together, ranks
from fenics_gears.system.output import check_writable
from fenics_gears.system.progress import Interruption, Progress

from .combine import STUDY_FILE, combined, save_study
from .index import INDEX, changed_since, directory_of
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
    records: dict[int, RunRecord] = field(default_factory=dict)
    failures: dict[int, str] = field(default_factory=dict)
    spent: Spent = field(default_factory=Spent)
    interrupted: bool = False


def run_study(
    path: Path, output: Path | None, progress: Progress, quiet: bool = False, meanwhile: Meanwhile | None = None
) -> Outcome | None:
    """Run what is missing of a study and write its dataset; None on every rank of an MPI job but 0.

    output: as in `index.directory_of`; meanwhile: as in `ranks`. Raises SceneError, before anything is computed or
    written, where the study is wrong; ComputationError where its directory cannot be used.
    """
    with ranks(meanwhile) as team:
        if team is None:
            return None
        return run_with(team, load_study(path, progress), directory_of(path, output), progress, quiet)


def kept_study(path: Path, output: Path | None, progress: Progress, quiet: bool = False) -> Outcome | None:
    """As `run_study`, of a study of which nothing is missing, without other processes; else None, and nothing is
    written."""
    return run_with(Alone(), load_study(path, progress), directory_of(path, output), progress, quiet, only_kept=True)


def run_with(
    team: Alone | Together,
    study: Study,
    directory: Path,
    progress: Progress,
    quiet: bool = False,
    only_kept: bool = False,
) -> Outcome | None:
    """Run what is missing of a study in its directory, with the processes of rank 0's team; with `only_kept` do nothing
    where something is, and return None. Raises ComputationError where the directory cannot be used."""
    check_writable(directory, STUDY_FILE, INDEX)
    with sole_writer(directory):
        cases = directory / "cases"
        store = Folder(cases) if study.asked is None else FolderOfLines(cases, line_of, study.asked)
        runs = Runs(store, team, study.cases)
        if only_kept and runs.missing(study.cases):
            return None
        return _run(runs, study, directory, progress, quiet)


def _run(runs: Runs, study: Study, directory: Path, progress: Progress, quiet: bool) -> Outcome:
    outcome = Outcome(study, kept=runs.kept, spent=runs.spent)
    missing = runs.missing(study.cases)
    opening = _opening(study, runs.kept, len(missing), changed_since(study, directory), runs.spent.processes)
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
            known = runs.known.get(case.key)
            if isinstance(known, Failure):
                outcome.failures[case.index] = str(known)
            elif known is not None:
                outcome.records[case.index] = known if isinstance(known, RunRecord) else record_of_line(known)
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

    def finished(case: Run, outcome: Any) -> None:
        nonlocal done, failed
        done += 1
        if isinstance(outcome, Failure):
            failed += 1
            LOGGER.warning("%s failed: %s", case, outcome.splitlines()[0])

    runs.compute(missing, count, finished)
    count()
