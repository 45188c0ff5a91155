"""``gears run SCENE``: run a scene; write run.nc and pictures."""

import argparse

from .shared import add_memory_argument, add_output_argument, add_scene_argument, later


def add(commands, shared: argparse.ArgumentParser) -> None:
    command = commands.add_parser("run", parents=[shared])
    add_scene_argument(command)
    add_output_argument(command)
    command.add_argument(
        "--no-pictures", action="store_true", help="write run.nc without pictures; `gears plot` can draw them later"
    )
    add_memory_argument(command)
    command.set_defaults(command=later("fenics_gears.commands.work.run:run"))
