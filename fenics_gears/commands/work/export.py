"""What ``gears export`` does."""

import argparse

from fenics_gears.results.curves_table import save_curves
from fenics_gears.system.output import write_whole

from ..shared import CURVES_FILE
from .runs import loaded_run, run_file
from .shared import file_to_write, print_files


def export(options: argparse.Namespace) -> int:
    file = run_file(options.run)
    output = file_to_write(options, file.parent / CURVES_FILE, "the table")
    dataset = loaded_run(file, trains=True)
    print_files([write_whole(output, lambda path: save_curves(dataset, path))], options.quiet)
    return 0
