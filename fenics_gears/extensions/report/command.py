"""``gears report RUN``: write one HTML page on a run or a study, readable without a network."""

import argparse
from pathlib import Path

from fenics_gears.command_line import REPORT_FILE, RUN_FILE, add_output_argument, later


def add(commands, shared: argparse.ArgumentParser) -> None:
    command = commands.add_parser("report", parents=[shared])
    command.add_argument(
        "run",
        type=Path,
        metavar="RUN",
        help="folder of a run or its run.nc, folder of a study, or file of one of its cases",
    )
    add_output_argument(command, f"{REPORT_FILE} beside {RUN_FILE}", "file or folder to write", "FILE|DIR")
    command.add_argument(
        "--at",
        type=float,
        metavar="PHASE",
        help="mesh cycles of the stress picture after the first with contact fields (default: at the largest force)",
    )
    command.add_argument(
        "--no-stress", action="store_true", help="leave out the stress picture, which takes some seconds"
    )
    command.add_argument(
        "--layout",
        type=Path,
        metavar="FILE.toml",
        help="title, author, date, logo, order of sections and limits of a report for a customer",
    )
    # `measuring` adds an option for it.
    command.set_defaults(command=later("fenics_gears.extensions.report.work:report"), effects=None)
