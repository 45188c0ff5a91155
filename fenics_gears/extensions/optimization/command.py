"""``gears optimize DESIGN``: search the best modification of a pair over loads and tolerances, alone or under mpirun; a
stopped search is continued."""

import argparse
from pathlib import Path

from fenics_gears.command_line import (
    add_memory_argument,
    add_output_argument,
    add_processes_argument,
    later,
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
    """Search, or start the processes that do."""
    if options.processes is None:
        return later("fenics_gears.extensions.optimization.work:search")(options)
    return under_mpirun(options, ["optimize", str(options.design), *(["--yes"] if options.yes else [])])
