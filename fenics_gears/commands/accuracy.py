"""``gears accuracy SCENE``: measure error and time of each accuracy setting of a scene; print and write a table and a
picture of error against time."""

import argparse

from .shared import add_memory_argument, add_output_argument, add_scene_argument, later


def add(commands, shared: argparse.ArgumentParser) -> None:
    command = commands.add_parser("accuracy", parents=[shared])
    add_scene_argument(command)
    add_output_argument(command)
    command.add_argument("--quick", action="store_true", help="few, coarse values of each setting, each timed once")
    add_memory_argument(command)
    command.set_defaults(command=later("fenics_gears.commands.work.accuracy:accuracy"))
