"""``gears effects SCENE``: run a scene with subsets of its effects; print and write, as table and picture, the time
each effect takes and how it changes the result. ``gears accuracy SCENE``: measure error and time of each accuracy
setting of a scene; print and write a table and a picture of error against time. ``gears report RUN --effects``: measure
the effects first.
"""

import argparse
from pathlib import Path

from fenics_gears.command_line import add_memory_argument, add_output_argument, add_scene_argument, later


def add(commands, shared: argparse.ArgumentParser) -> None:
    """Add both commands, and an option to ``report``."""
    command = commands.add_parser("effects", parents=[shared])
    add_scene_argument(command)
    add_output_argument(command)
    add_memory_argument(command)
    command.set_defaults(command=later("fenics_gears.extensions.measuring.work:effects"))
    command = commands.add_parser("accuracy", parents=[shared])
    add_scene_argument(command)
    add_output_argument(command)
    command.add_argument("--quick", action="store_true", help="few, coarse values of each setting, each timed once")
    add_memory_argument(command)
    command.set_defaults(command=later("fenics_gears.extensions.measuring.work:accuracy"))
    if "report" in commands.choices:
        words = "measure its effects first, as `gears effects` does"
        commands.choices["report"].add_argument("--effects", action="store_const", const=effects_of, help=words)


def effects_of(scene, directory: Path, progress) -> list[Path]:
    """Measure the effects of a run's scene, and write the files of ``gears effects`` into a directory."""
    # A report without them does not wait for what measures.
    from .work import effects_of

    return effects_of(scene, directory, progress)
