"""``gears cache``: show what the cache of condensed gears holds, or empty it."""

import argparse

from .shared import later


def add(commands, shared: argparse.ArgumentParser) -> None:
    command = commands.add_parser("cache", parents=[shared])
    command.add_argument(
        "--clear", action="store_true", help="remove all entries; gears are condensed again when they are needed"
    )
    command.set_defaults(command=later("fenics_gears.commands.work.cache:cache"))
