"""``gears optimize DESIGN``: search the best modification of a pair over loads and tolerances, alone or under mpirun; a
stopped search is continued."""

import argparse
import sys
from pathlib import Path

from fenics_gears.command_line import (
    INTERRUPTED,
    WITHOUT_SOMETHING,
    add_memory_argument,
    add_output_argument,
    add_processes_argument,
    after_result,
    shown_progress,
    under_mpirun,
)


def add(commands, shared: argparse.ArgumentParser) -> None:
    command = commands.add_parser("optimize", parents=[shared])
    command.add_argument("design", type=Path, metavar="DESIGN", help="a design file (TOML)")
    add_output_argument(command, "results/<name of the design file>")
    yes = "start whatever time is expected (else: refused where it is more than 8 h)"
    command.add_argument("-y", "--yes", action="store_true", help=yes)
    add_processes_argument(command)
    add_memory_argument(command)
    command.set_defaults(command=optimize)


def optimize(options: argparse.Namespace) -> int:
    if options.processes is not None:
        return under_mpirun(options, ["optimize", str(options.design), *(["--yes"] if options.yes else [])])
    from .optimize import optimize
    from .result import write_result

    try:
        outcome = optimize(options.design, options.output, shown_progress(options.quiet), options.quiet, options.yes)
    except KeyboardInterrupt:
        print("Interrupted. Finished runs are kept; the same command goes on from there.", file=sys.stderr)
        return INTERRUPTED
    if outcome is None:
        return 0
    files = write_result(outcome)
    from .charts import summary_rows, write_pictures
    from .page import write_page

    drawn = after_result(files[0], "pictures", lambda: write_pictures(outcome))
    page = after_result(files[0], "page", lambda: [write_page(outcome)])
    files += [*(drawn or []), *(page or [])]
    if not options.quiet:
        from fenics_gears.command_line import print_rows

        print_rows(outcome.design.title, summary_rows(outcome))
        print_rows("Files", [("", str(file), "") for file in files])
    return WITHOUT_SOMETHING if drawn is None or page is None else 0
