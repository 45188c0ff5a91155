"""``gears effects SCENE``: run a scene with subsets of its effects; print and write, as table and picture, the time
each effect takes and how it changes the result."""

import argparse

from .shared import add_memory_argument, add_output_argument, add_scene_argument, later


def add(commands, shared: argparse.ArgumentParser) -> None:
    command = commands.add_parser("effects", parents=[shared])
    add_scene_argument(command)
    add_output_argument(command)
    add_memory_argument(command)
    command.set_defaults(command=later("fenics_gears.commands.work.effects:effects"))
