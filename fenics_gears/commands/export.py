"""``gears export RUN``: write the curves of a run as a table (CSV) for spreadsheets."""

from __future__ import annotations

import argparse

from fenics_gears.commands.shared import add_output_argument, add_run_argument, loaded_run, print_files, run_file
from fenics_gears.errors import SceneError

CURVES_FILE = "curves.csv"


def add(commands, shared: argparse.ArgumentParser) -> None:
    """Add the command to the parser."""
    command = commands.add_parser("export", parents=[shared])
    add_run_argument(command)
    add_output_argument(command, f"{CURVES_FILE} beside run.nc", "file to write", "FILE")
    command.set_defaults(command=export)


def export(options: argparse.Namespace) -> int:
    """Write a run's table of curves."""
    from fenics_gears.system.output import check_writable, write_whole

    file = run_file(options.run)
    output = options.output or file.parent / CURVES_FILE
    if output.suffix != ".csv":
        raise SceneError(f"{output}: the table is a .csv file; give --output such a name.")
    check_writable(output.parent, output.name)
    from fenics_gears.results.curves_table import save_curves

    dataset = loaded_run(file)
    print_files([write_whole(output, lambda path: save_curves(dataset, path))], options.quiet)
    return 0
