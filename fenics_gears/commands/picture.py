"""``gears picture RUN``: draw the gears of a run in mesh with their stresses; write them for ParaView."""

import argparse
from pathlib import Path

from .shared import ANIMATION_FILE, PICTURE_FILE, add_output_argument, add_run_argument, later


def add(commands, shared: argparse.ArgumentParser) -> None:
    command = commands.add_parser("picture", parents=[shared])
    add_run_argument(command)
    command.add_argument(
        "--mesh", metavar="NAME", help="of a train: draw this mesh alone (default: all, each in a folder by its name)"
    )
    help_of_phase = "mesh cycles after the first step with contact fields (default: 0)"
    command.add_argument("--at", type=float, default=0.0, metavar="PHASE", help=help_of_phase)
    command.add_argument(
        "--scale", type=_scale, metavar="N",
        help="displacements are drawn N times as large (default: the largest suitable scale; in three dimensions 1)",
    )  # fmt: skip
    add_output_argument(command, f"{PICTURE_FILE} or {ANIMATION_FILE} beside run.nc", "file to write", "FILE")
    command.add_argument(
        "--animate",
        action="store_true",
        help="draw an animation of the mesh cycles with contact fields (.gif, or .mp4 where ffmpeg is installed)",
    )
    command.add_argument(
        "--vtu", type=Path, metavar="FILE", help="also write displacement and stress of both gears for ParaView"
    )
    command.add_argument(
        "--pvd",
        type=Path,
        metavar="FILE",
        help="also write the mesh cycles with contact fields for ParaView: FILE, and a .vtu file for each step",
    )
    command.set_defaults(command=later("fenics_gears.commands.work.picture:picture"))


def _scale(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = -1.0
    if not 0.0 <= value < float("inf"):
        raise argparse.ArgumentTypeError(f"{text!r} is not a number from 0")
    return value
