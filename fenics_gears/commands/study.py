"""``gears study STUDY``: run a parameter study and draw it, alone or under mpirun; a stopped study is continued."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from fenics_gears.errors import ComputationError
from fenics_gears.system.console import print_rows

from .shared import (
    INTERRUPTED,
    WITHOUT_SOMETHING,
    add_memory_argument,
    add_output_argument,
    add_processes_argument,
    after_result,
    plots,
    shown_progress,
    under_mpirun,
)

if TYPE_CHECKING:
    from fenics_gears.studies.run_study import Outcome


def add(commands, shared: argparse.ArgumentParser) -> None:
    command = commands.add_parser("study", parents=[shared])
    command.add_argument("study", type=Path, metavar="STUDY", help="a study file (TOML)")
    add_output_argument(command, "results/<name of the study file>")
    add_processes_argument(command)
    add_memory_argument(command)
    command.set_defaults(command=study)


def study(options: argparse.Namespace) -> int:
    if options.processes is None:
        from fenics_gears.studies.run_study import run_study

        outcome = run_study(options.study, options.output, shown_progress(options.quiet), options.quiet, plots)
        return 0 if outcome is None else _told(outcome, options)
    outcome = _of_kept(options)
    return under_mpirun(options, ["study", str(options.study)]) if outcome is None else _told(outcome, options)


def _of_kept(options: argparse.Namespace) -> Outcome | None:
    """The outcome where all cases are kept: several processes would take longer to start than one takes for that. None
    where something is to be computed."""
    from fenics_gears.studies.index import directory_of, seems_complete

    if not seems_complete(options.study, directory_of(options.study, options.output)):
        return None
    from fenics_gears.studies.run_study import kept_study

    return kept_study(options.study, options.output, shown_progress(options.quiet), options.quiet)


def _told(outcome: Outcome, options: argparse.Namespace) -> int:
    """Draw the study's dataset, say what came out of it, and return the exit code."""
    from fenics_gears.studies.summary import last_words, summary_rows

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
