"""A study from its file to its combined dataset: the stages, in order."""

from __future__ import annotations

import functools
import logging
import sys
from dataclasses import dataclass, field
from pathlib import Path

from fenics_gears.studies.case_files import changed_since, kept_records, sole_writer
from fenics_gears.studies.combine import STUDY_FILE, CaseRecord, combined, save_study
from fenics_gears.studies.ranks import Alone, Together, ranks
from fenics_gears.studies.study import Case, Study
from fenics_gears.studies.study_file import load_study
from fenics_gears.studies.work import condense, gear_tasks, in_order_of_sharing, run_case
from fenics_gears.system.interruption import Interruption
from fenics_gears.system.output import check_writable
from fenics_gears.system.progress import Progress

LOGGER = logging.getLogger(__name__)


@dataclass
class Outcome:
    """Results of a study so far, and why cases failed, by the case's index; `kept`: how many results were there
    before."""

    study: Study
    file: Path | None = None
    kept: int = 0
    records: dict[int, CaseRecord] = field(default_factory=dict)
    failures: dict[int, str] = field(default_factory=dict)
    interrupted: bool = False


def run_study(path: Path, output: Path | None, progress: Progress, quiet: bool = False) -> Outcome | None:
    """Run what is missing of a study and write its dataset; None on every rank of an MPI job but 0.

    output: the study's directory, `results/<name of the study file>` where None. Raises SceneError, before anything is
        computed or
    written, where the study is wrong; ComputationError where its directory cannot be used.
    """
    with ranks() as team:
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
    outcome = Outcome(study)
    outcome.records = kept_records(study.cases, directory / "cases")
    outcome.kept = len(outcome.records)
    missing = [case for case in study.cases if case.index not in outcome.records]
    say = (lambda text: None) if quiet else (lambda text: print(text, file=sys.stderr, flush=True))
    say(_opening(study, outcome.kept, len(missing), changed_since(study, directory), team.size))
    with Interruption(progress) as interruption:
        try:
            condense_gears(missing, team, interruption)
            _compute(in_order_of_sharing(missing), directory / "cases", team, outcome, interruption)
        except KeyboardInterrupt:
            outcome.interrupted = True
        interruption.ignore()
        outcome.file = save_study(combined(study, outcome.records, outcome.failures), directory)
    return outcome


def _opening(study: Study, kept: int, missing: int, changed: str, size: int) -> str:
    """One line on how many cases are there and to be computed."""
    of_it = f"{kept} kept, {missing} to be computed" if kept else f"{missing} to be computed"
    return (
        f"{study.title}: {len(study.cases)} cases, {of_it}"
        + (f", by {size} processes." if size > 1 else ".")
        + (changed and f" {changed}")
    )


def condense_gears(missing: list[Case], team: Alone | Together, progress: Interruption) -> None:
    """Condense every gear of the study once, a process a gear; a gear that fails fails again, with its reason, in its
    cases."""
    tasks = gear_tasks(missing)
    if not tasks:
        return
    progress.stage("condense gears")
    done = 0

    def finished(index: int, result: Exception | None) -> None:
        nonlocal done
        done += 1
        if result is not None:
            LOGGER.debug("condensing the %s: %s", tasks[index].name, result)

    team.run(condense, tasks, finished, lambda: progress.update(done, len(tasks)))
    progress.update(done, len(tasks))


def _compute(
    missing: list[Case], directory: Path, team: Alone | Together, outcome: Outcome, progress: Interruption
) -> None:
    """Run every missing case; results and failures go into ``outcome`` as they come."""
    if not missing:
        return
    progress.stage("cases")

    def count() -> None:
        failed = len(outcome.failures)
        progress.update(
            len(outcome.records) - outcome.kept + failed, len(missing), f"{failed} failed" if failed else ""
        )

    def finished(index: int, result: CaseRecord | str | Exception) -> None:
        case = missing[index]
        if isinstance(result, CaseRecord):
            outcome.records[case.index] = result
            return
        # An exception is one that the worker could not even report, such as an MPI error.
        reason = result if isinstance(result, str) else f"{type(result).__name__}: {result}"
        outcome.failures[case.index] = reason
        LOGGER.warning("%s failed: %s", case, reason.splitlines()[0])

    team.run(functools.partial(run_case, directory), missing, finished, count)
    count()
