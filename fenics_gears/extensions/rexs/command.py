"""``gears import FILE.rexs``: write a gear pair of a REXS file as a scene. The scene names the origin of every
value."""

import argparse
from pathlib import Path

from fenics_gears.command_line import add_output_argument, later


def add(commands, shared: argparse.ArgumentParser) -> None:
    command = commands.add_parser("import", parents=[shared])
    command.add_argument("file", type=Path, metavar="FILE", help="a REXS file: .rexs, .rexsj or .rexsz")
    add_output_argument(command, "name of FILE with .toml, in the current folder", "scene file to write", "SCENE")
    command.add_argument(
        "--stage", type=int, metavar="ID", help="number of the component of the stage, if the file has several stages"
    )
    command.add_argument("--train", action="store_true", help="all stages of the file, as the scene of a gear train")
    shafts = "beside --train: its shafts bend on their bearings, as far as the file describes them"
    command.add_argument("--shafts", action="store_true", help=shafts)
    command.add_argument("--load-case", metavar="ID", help="number of the load case, if the file has several")
    torque = 'torque on the driven gear, of a train the last one, in place of that of the file, such as "437 N m"'
    command.add_argument("--wheel-torque", metavar="TORQUE", help=torque)
    speed = 'speed of the driving gear, of a train the first one, in place of that of the file, such as "750 rpm"'
    command.add_argument("--pinion-speed", metavar="SPEED", help=speed)
    command.set_defaults(command=later("fenics_gears.extensions.rexs.work:import_rexs"))
