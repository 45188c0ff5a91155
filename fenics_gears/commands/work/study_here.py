"""A study in this process, or in all processes of its job: its outcome and what is said of it."""

import argparse
import sys
from pathlib import Path

from fenics_gears.errors import ComputationError
from fenics_gears.studies.run_study import Outcome, kept_study, run_study
from fenics_gears.studies.summary import last_words, summary_rows
from fenics_gears.system.console import print_rows

from ..shared import INTERRUPTED, WITHOUT_SOMETHING
from .shared import after_result, plots, shown_progress


def outcome_of(options: argparse.Namespace) -> Outcome | None:
    """The outcome of the command's study; None on other ranks than 0. With --processes, which are not started yet, of
    the kept cases alone: None where one is missing."""
    if options.processes is None:
        return run_study(options.study, options.output, shown_progress(options.quiet), options.quiet, plots)
    return kept_study(options.study, options.output, shown_progress(options.quiet), options.quiet)


def told(outcome: Outcome | None, options: argparse.Namespace) -> int:
    """Draw the study's dataset, say what came out of it, and return the exit code. None: another rank than 0."""
    if outcome is None:
        return 0
    pictures: list[Path] | None = []
    if not outcome.interrupted:
        pictures = after_result(outcome.file, "pictures", lambda: plots("study_pictures").draw_study(outcome.file))
    if not options.quiet:
        print_rows(outcome.study.title, summary_rows(outcome))
        print_rows("Files", [("", str(file), "") for file in (outcome.file, *(pictures or []))])
        print(f"`gears report {outcome.file.parent}` makes one page of it all.")
    if last_words(outcome):
        print(last_words(outcome), file=sys.stderr)
    if outcome.interrupted:
        return INTERRUPTED
    if outcome.failures:
        return ComputationError.exit_code
    return WITHOUT_SOMETHING if pictures is None else 0
