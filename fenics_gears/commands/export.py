"""``gears export RUN``: write the curves of a run as a table (CSV) for spreadsheets."""

import argparse

from fenics_gears.system.output import write_whole

from .shared import add_output_argument, add_run_argument, file_to_write, loaded_run, print_files, run_file

CURVES_FILE = "curves.csv"


def add(commands, shared: argparse.ArgumentParser) -> None:
    command = commands.add_parser("export", parents=[shared])
    add_run_argument(command)
    add_output_argument(command, f"{CURVES_FILE} beside run.nc", "file to write", "FILE")
    command.set_defaults(command=export)


def export(options: argparse.Namespace) -> int:
    file = run_file(options.run)
    output = file_to_write(options, file.parent / CURVES_FILE, "the table")
    from fenics_gears.results.curves_table import save_curves

    dataset = loaded_run(file)
    print_files([write_whole(output, lambda path: save_curves(dataset, path))], options.quiet)
    return 0
