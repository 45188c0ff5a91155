"""``gears study STUDY``: run a parameter study and draw it, alone or under mpirun; a stopped study is continued."""

import argparse
from pathlib import Path

from .shared import add_memory_argument, add_output_argument, add_processes_argument, later


def add(commands, shared: argparse.ArgumentParser) -> None:
    command = commands.add_parser("study", parents=[shared])
    command.add_argument("study", type=Path, metavar="STUDY", help="a study file (TOML)")
    add_output_argument(command, "results/<name of the study file>")
    add_processes_argument(command)
    add_memory_argument(command)
    command.set_defaults(command=later("fenics_gears.commands.work.study:study"))
