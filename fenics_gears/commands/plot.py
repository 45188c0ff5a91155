"""``gears plot RUN``: draw the pictures of a run again."""

from __future__ import annotations

import argparse
from pathlib import Path

from fenics_gears.commands.drawing import draw
from fenics_gears.commands.run import RUN_FILE
from fenics_gears.errors import ComputationError, SceneError


def add(commands, shared: argparse.ArgumentParser) -> None:
    """Add the command to the parser."""
    command = commands.add_parser("plot", parents=[shared], help="draw the pictures of a run again")
    command.add_argument("run", type=Path, metavar="RUN", help="a run's directory or its run.nc")
    command.add_argument("-o", "--output", type=Path, metavar="DIR", help="where to write (default: beside run.nc)")
    command.set_defaults(command=plot)


def plot(options: argparse.Namespace) -> int:
    """Draw a run's pictures."""
    from fenics_gears.output import check_writable

    file = options.run / RUN_FILE if options.run.is_dir() else options.run
    if not file.is_file():
        raise SceneError(f"{file}: there is no such file. A run is the directory that `gears run` wrote, or the {RUN_FILE} in it.")
    directory = options.output or file.parent
    check_writable(directory)
    from fenics_gears import results

    try:
        dataset = results.load(file)
    except ComputationError as error:
        # Nothing was computed: the call is wrong.
        raise SceneError(str(error)) from error
    for picture in draw(dataset, directory):
        if not options.quiet:
            print(picture)
    return 0
