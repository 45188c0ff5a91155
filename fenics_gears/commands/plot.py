"""``gears plot RUN``: draw the pictures of a run again."""

from __future__ import annotations

import argparse
from pathlib import Path

from fenics_gears.commands.drawing import draw
from fenics_gears.commands.run_file import loaded_run, run_file


def add(commands, shared: argparse.ArgumentParser) -> None:
    """Add the command to the parser."""
    command = commands.add_parser("plot", parents=[shared], help="draw the pictures of a run again")
    command.add_argument("run", type=Path, metavar="RUN", help="a run's directory or its run.nc")
    command.add_argument("-o", "--output", type=Path, metavar="DIR", help="where to write (default: beside run.nc)")
    command.set_defaults(command=plot)


def plot(options: argparse.Namespace) -> int:
    """Draw a run's pictures."""
    from fenics_gears.system.output import check_writable

    file = run_file(options.run)
    directory = options.output or file.parent
    check_writable(directory)
    dataset = loaded_run(file)
    for picture in draw(dataset, directory):
        if not options.quiet:
            print(picture)
    return 0
