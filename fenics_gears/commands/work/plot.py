"""What ``gears plot`` does."""

import argparse

from fenics_gears.show import FACE_PICTURE_FILES, PICTURE_FILES
from fenics_gears.system.output import check_writable

from .runs import loaded_run, run_file
from .shared import plots, print_files


def plot(options: argparse.Namespace) -> int:
    file = run_file(options.run)
    directory = options.output or file.parent
    check_writable(directory, *PICTURE_FILES, *FACE_PICTURE_FILES)
    print_files(plots().draw_run(loaded_run(file), directory), options.quiet)
    return 0
