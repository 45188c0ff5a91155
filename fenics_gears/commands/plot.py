"""``gears plot RUN``: draw the pictures of a run again."""

import argparse

from fenics_gears.show import FACE_PICTURE_FILES, PICTURE_FILES
from fenics_gears.system.output import check_writable

from .shared import add_output_argument, add_run_argument, loaded_run, plots, print_files, run_file


def add(commands, shared: argparse.ArgumentParser) -> None:
    command = commands.add_parser("plot", parents=[shared])
    add_run_argument(command)
    add_output_argument(command, "beside run.nc")
    command.set_defaults(command=plot)


def plot(options: argparse.Namespace) -> int:
    file = run_file(options.run)
    directory = options.output or file.parent
    check_writable(directory, *PICTURE_FILES, *FACE_PICTURE_FILES)
    print_files(plots().draw_run(loaded_run(file), directory), options.quiet)
    return 0
