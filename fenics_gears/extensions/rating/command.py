"""``gears rate RUN``: rate a run by ISO 6336, beside its computed loads and stresses."""

import argparse
from dataclasses import fields

from fenics_gears.command_line import add_output_argument, add_run_argument, later

from .finish import Finish

FILE = "rating.csv"
# Options with a quantity: field of the finish, unit, lowest, highest, meaning.
QUANTITIES = {
    "flank_limit": ("MPa", 100.0, 3000.0, "endurance limit sigma_Hlim of the flank"),
    "root_limit": ("MPa", 20.0, 1000.0, "endurance limit sigma_Flim of the root"),
    "flank_roughness": ("um", 0.1, 100.0, "roughness Rz of the flanks"),
    "root_roughness": ("um", 0.1, 100.0, "roughness Rz of the roots"),
}
NUMBERS = {
    "tolerance_class": (1, 11, "flank tolerance class of ISO 1328-1 (default: that of [flank_errors], else 6)"),
    "viscosity_grade": (10, 1500, "viscosity grade ISO VG of the oil"),
    "application_factor": (0.5, 5, "application factor K_A"),
}


def add(commands, shared: argparse.ArgumentParser) -> None:
    defaults = {each.name: each.default for each in fields(Finish)}
    command = commands.add_parser("rate", parents=[shared])
    add_run_argument(command)
    for name, (unit, *_, meaning) in QUANTITIES.items():
        command.add_argument(
            option_of(name), metavar="VALUE", help=f'{meaning}, such as "{defaults[name]:g} {unit}" (default)'
        )
    for name, (*_, meaning) in NUMBERS.items():
        default = "" if "default" in meaning else f" (default: {defaults[name]:g})"
        command.add_argument(option_of(name), type=float, metavar="N", help=meaning + default)
    add_output_argument(command, f"{FILE} beside run.nc", "table to write", "FILE")
    command.set_defaults(command=later("fenics_gears.extensions.rating.work:rate"))


def option_of(name: str) -> str:
    return "--" + name.replace("_", "-")
