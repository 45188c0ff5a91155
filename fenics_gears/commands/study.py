"""``gears study STUDY``: run what is missing of a parameter study, alone or as one of the processes that mpirun started."""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
from pathlib import Path

from fenics_gears.commands.shared import INTERRUPTED, add_memory_argument, plots, shown_progress
from fenics_gears.errors import ComputationError, SceneError


def add(commands, shared: argparse.ArgumentParser) -> None:
    """Add the command to the parser."""
    command = commands.add_parser("study", parents=[shared], help="run a parameter study and draw it, alone or under mpirun; a stopped study is continued")
    command.add_argument("study", type=Path, metavar="STUDY", help="a study file (TOML)")
    command.add_argument("-o", "--output", type=Path, metavar="DIR", help="folder to write into (default: results/<name of the study file>)")
    add_processes_argument(command)
    add_memory_argument(command)
    command.set_defaults(command=study)


def add_processes_argument(command) -> None:
    """The option --processes of a command that shares its runs among processes."""
    command.add_argument("-n", "--processes", type=_count, metavar="N", help="start mpirun with N processes, which share the runs")


def study(options: argparse.Namespace) -> int:
    """Run a study."""
    if options.processes is not None:
        return under_mpirun("study", options.study, options)
    from fenics_gears.studies.run_study import run_study
    from fenics_gears.studies.summary import last_words, summary_rows

    outcome = run_study(options.study, options.output, shown_progress(options.quiet), options.quiet)
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


def under_mpirun(name: str, file: Path, options: argparse.Namespace) -> int:
    """The same command under mpirun, which finds its settings (as root, say) in the environment that `prepare` has completed."""
    mpirun = shutil.which("mpirun")
    if mpirun is None:
        raise SceneError("There is no mpirun on PATH. Install Open MPI or MPICH, or leave --processes out to run the study alone.")
    command = [mpirun, "-n", str(options.processes)]
    if options.processes > (os.cpu_count() or 1):
        command.append("--oversubscribe")
    command += [sys.executable, "-m", "fenics_gears", name, str(file)]
    command += ["--output", str(options.output)] if options.output is not None else []
    command += ["--quiet"] if options.quiet else []
    running = subprocess.Popen(command)
    try:
        return running.wait()
    except KeyboardInterrupt:
        # Ctrl-C is mpirun's as well, which ends its processes; to kill it meanwhile would leave them behind.
        running.wait()
        print("Interrupted. Finished runs are kept; the same command goes on from there.", file=sys.stderr)
        return INTERRUPTED


def _count(text: str) -> int:
    """A whole number above zero, for argparse."""
    if not text.isdigit() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number above 0")
    return int(text)
