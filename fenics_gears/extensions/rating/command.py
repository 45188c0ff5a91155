"""``gears rate RUN``: rate a run by ISO 6336, beside its computed loads and stresses."""

import argparse
from dataclasses import fields
from math import isnan
from pathlib import Path

from fenics_gears import SceneError, gear_pair
from fenics_gears.command_line import (
    add_output_argument,
    add_run_argument,
    file_to_write,
    loaded_run,
    number_of_option,
    run_file,
    write_whole,
)

FILE = "rating.csv"
# Options with a quantity: field of the finish, unit, lowest, highest, meaning.
_QUANTITIES = {
    "flank_limit": ("MPa", 100.0, 3000.0, "endurance limit sigma_Hlim of the flank"),
    "root_limit": ("MPa", 20.0, 1000.0, "endurance limit sigma_Flim of the root"),
    "flank_roughness": ("um", 0.1, 100.0, "roughness Rz of the flanks"),
    "root_roughness": ("um", 0.1, 100.0, "roughness Rz of the roots"),
}
_NUMBERS = {
    "tolerance_class": (1, 11, "flank tolerance class of ISO 1328-1 (default: that of [flank_errors], else 6)"),
    "viscosity_grade": (10, 1500, "viscosity grade ISO VG of the oil"),
    "application_factor": (0.5, 5, "application factor K_A"),
}


def add(commands, shared: argparse.ArgumentParser) -> None:
    from .finish import Finish

    defaults = {each.name: each.default for each in fields(Finish)}
    command = commands.add_parser("rate", parents=[shared])
    add_run_argument(command)
    for name, (unit, *_, meaning) in _QUANTITIES.items():
        command.add_argument(
            _option(name), metavar="VALUE", help=f'{meaning}, such as "{defaults[name]:g} {unit}" (default)'
        )
    for name, (*_, meaning) in _NUMBERS.items():
        default = "" if "default" in meaning else f" (default: {defaults[name]:g})"
        command.add_argument(_option(name), type=float, metavar="N", help=meaning + default)
    add_output_argument(command, f"{FILE} beside run.nc", "table to write", "FILE")
    command.set_defaults(command=rate)


def _option(name: str) -> str:
    return "--" + name.replace("_", "-")


def rate(options: argparse.Namespace) -> int:
    from fenics_gears import carried_scene

    from . import rating

    file = run_file(options.run)
    output = file_to_write(options, file.parent / FILE, "the table")
    result = loaded_run(file)
    scene = carried_scene(result)
    finish = _finish(options, scene)
    rows = rating.rate(result, scene, finish)
    write_whole(output, lambda path: _save(rows, path))
    if not options.quiet:
        _show(rows)
        if end := result.attrs.get("peak_contact_pressure_beside"):
            why = "where lines of contact end and their line load rises (buttressing); ISO 6336-2 has no such rise"
            print(f"sigma_H of this run is beside the {end} of the pinion's active profile, {why}.")
        if place := rating.of_place(result.attrs, gear_pair(scene.gears)):
            print(place)
        print(rating.of_misalignment(scene, finish))
        print(output)
    return 0


def _finish(options: argparse.Namespace, scene):
    from .finish import Finish

    given = {}
    if scene.flank_errors is not None and scene.flank_errors.tolerance_class is not None:
        given["tolerance_class"] = scene.flank_errors.tolerance_class
    for name, (unit, low, high, _) in _QUANTITIES.items():
        text = getattr(options, name)
        if text is not None:
            given[name] = number_of_option(_option(name), text, unit, low, high)
    for name, (low, high, _) in _NUMBERS.items():
        value = getattr(options, name)
        whole = name == "tolerance_class"
        if value is None:
            continue
        if not low <= value <= high or whole and value != int(value):
            kind = "a whole number " if whole else ""
            raise SceneError(f"{_option(name)} {value:g}: allowed is {kind}from {low:g} to {high:g}.")
        given[name] = int(value) if whole else value
    return Finish(**given)


def _save(rows, path: Path) -> None:
    import csv

    with open(path, "w", encoding="utf-8", newline="") as table:
        writer = csv.writer(table)
        writer.writerow(["quantity", "unit", "ISO 6336", "this run"])
        writer.writerows([row.name, row.unit, _written(row.standard, 8), _written(row.computed, 8)] for row in rows)


def _show(rows) -> None:
    print(f"{'':50}{'ISO 6336':>10}{'this run':>10}")
    for row in rows:
        unit = "" if row.unit == "1" else f" {row.unit}"
        name = row.name + ("," + unit if unit else "")
        print(f"{name:50}{_written(row.standard, 4):>10}{_written(row.computed, 4) or '-':>10}")
    print("K_v of this run: largest force of a tooth pair over that without inertia. Safeties: by the same limits.")
    if any(isnan(row.computed) for row in rows):
        print(
            "-: not in this run. Root stress needs [output] root_stress = true, the dynamic factor [inertia], face and"
        )
        print("   transverse factors a run over the face, such as with [misalignment].")


def _written(value: float, digits: int) -> str:
    return "" if isnan(value) else f"{value:.{digits}g}"
