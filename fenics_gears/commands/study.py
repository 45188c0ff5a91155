"""``gears study STUDY``: run a parameter study and draw it, alone or under mpirun; a stopped study is continued."""

import argparse
import sys
from pathlib import Path

from fenics_gears.errors import ComputationError

from .shared import (
    INTERRUPTED,
    add_memory_argument,
    add_output_argument,
    add_processes_argument,
    plots,
    shown_progress,
    under_mpirun,
)


def add(commands, shared: argparse.ArgumentParser) -> None:
    command = commands.add_parser("study", parents=[shared])
    command.add_argument("study", type=Path, metavar="STUDY", help="a study file (TOML)")
    add_output_argument(command, "results/<name of the study file>")
    add_processes_argument(command)
    add_memory_argument(command)
    command.set_defaults(command=study)


def study(options: argparse.Namespace) -> int:
    if options.processes is not None:
        return under_mpirun(options, ["study", str(options.study)])
    from fenics_gears.studies.run_study import run_study
    from fenics_gears.studies.summary import last_words, summary_rows

    outcome = run_study(options.study, options.output, shown_progress(options.quiet), options.quiet, plots)
    if outcome is None:
        return 0
    pictures = [] if outcome.interrupted else plots().draw_study(outcome.file)
    if not options.quiet:
        from fenics_gears.system.console import print_rows

        print_rows(outcome.study.title, summary_rows(outcome))
        print_rows("Files", [("", str(file), "") for file in (outcome.file, *pictures)])
        print(f"`gears report {outcome.file.parent}` makes one page of it all.")
    if last_words(outcome):
        print(last_words(outcome), file=sys.stderr)
    if outcome.interrupted:
        return INTERRUPTED
    return ComputationError.exit_code if outcome.failures else 0
