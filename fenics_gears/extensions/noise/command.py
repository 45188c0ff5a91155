"""``gears listen RUN``: write a curve of a run as sound (WAV). ``gears plot RUN --spectrum``: its noise figures."""

import argparse
from collections.abc import Callable
from functools import partial

from fenics_gears.command_line import add_output_argument, add_run_argument, later

SECONDS = 5.0
AUTOMATIC = "auto"
WINDOWS = ("auto", "none", "hann", "flat-top")


def add(commands, shared: argparse.ArgumentParser) -> None:
    """Add the command to the parser, and an option to the core's ``plot``."""
    command = commands.add_parser("listen", parents=[shared])
    add_run_argument(command)
    curve = "variable over time to hear (default: normal_force, the mesh force; of a train overall_transmission_error)"
    command.add_argument("--curve", metavar="NAME", help=curve)
    seconds = f"length of a steady run's sound (default: {SECONDS:g}); a speed ramp is heard once"
    command.add_argument("--seconds", type=float, default=SECONDS, metavar="N", help=seconds)
    full = 'value of the curve at which the file is full, such as "500 N" (default: from the loudest sample)'
    command.add_argument("--full-scale", metavar="VALUE", help=full)
    add_output_argument(command, "CURVE.wav beside run.nc", "file to write", "FILE")
    command.set_defaults(command=later("fenics_gears.extensions.noise.work:listen"))
    pictures = commands.choices["plot"]
    pictures.add_argument(
        "--spectrum", nargs="?", choices=WINDOWS, const=AUTOMATIC, metavar="WINDOW",
        help="draw and write levels in dB over mesh orders with the energy of their sidebands, of a speed ramp over "
            "the speed; WINDOW is none, hann or flat-top (default: none for whole mesh cycles, flat-top for a ramp)",
    )  # fmt: skip
    pictures.set_defaults(command=partial(plot, pictures.get_default("command")))


def plot(core: Callable[[argparse.Namespace], int], options: argparse.Namespace) -> int:
    """Write a run's noise figures; without --spectrum its pictures, as the `core` does."""
    wanted = core if options.spectrum is None else later("fenics_gears.extensions.noise.work:plot_spectrum")
    return wanted(options)
