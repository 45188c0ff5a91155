"""``gears check SCENE``: check a scene; print its geometry, effects, accuracy and expected cost; compute nothing."""

import argparse

from .shared import add_memory_argument, add_scene_argument, later


def add(commands, shared: argparse.ArgumentParser) -> None:
    command = commands.add_parser("check", parents=[shared])
    add_scene_argument(command)
    add_memory_argument(command)
    command.set_defaults(command=later("fenics_gears.commands.work.check:check"))
