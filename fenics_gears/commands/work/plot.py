"""What ``gears plot`` does."""

import argparse

from fenics_gears.show import FACE_PICTURE_FILES, PICTURE_FILES
from fenics_gears.system.output import check_writable

from .runs import loaded_run, of_train, run_file
from .shared import plots, print_files


def plot(options: argparse.Namespace) -> int:
    file = run_file(options.run)
    directory = options.output or file.parent
    check_writable(directory, *PICTURE_FILES, *FACE_PICTURE_FILES)
    dataset = loaded_run(file, trains=True)
    if of_train(dataset):
        written = plots("train").draw_train(dataset, directory)
    else:
        written = plots().draw_run(dataset, directory)
    print_files(written, options.quiet)
    return 0
