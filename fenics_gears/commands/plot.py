"""``gears plot RUN``: draw the pictures of a run again."""

import argparse

from .shared import add_output_argument, add_run_argument, later


def add(commands, shared: argparse.ArgumentParser) -> None:
    command = commands.add_parser("plot", parents=[shared])
    add_run_argument(command)
    add_output_argument(command, "beside run.nc")
    command.set_defaults(command=later("fenics_gears.commands.work.plot:plot"))
