"""``gears export RUN``: write the curves of a run as a table (CSV) for spreadsheets."""

import argparse

from .shared import CURVES_FILE, add_output_argument, add_run_argument, later


def add(commands, shared: argparse.ArgumentParser) -> None:
    command = commands.add_parser("export", parents=[shared])
    add_run_argument(command)
    add_output_argument(command, f"{CURVES_FILE} beside run.nc", "file to write", "FILE")
    command.set_defaults(command=later("fenics_gears.commands.work.export:export"))
