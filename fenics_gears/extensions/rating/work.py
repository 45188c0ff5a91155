"""What ``gears rate`` does."""

import argparse
from math import isnan
from pathlib import Path

from fenics_gears import SceneError, carried_scene, gear_pair
from fenics_gears.command_line import file_to_write, loaded_run, number_of_option, run_file, write_whole

from . import rating
from .command import FILE, NUMBERS, QUANTITIES, option_of
from .finish import Finish


def rate(options: argparse.Namespace) -> int:
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
            print(f"sigma_H of this run is near the {end} of the pinion's active profile, {why}.")
        if place := rating.of_place(result.attrs, gear_pair(scene.gears)):
            print(place)
        print(rating.of_misalignment(scene, finish))
        print(output)
    return 0


def _finish(options: argparse.Namespace, scene):
    given = {}
    if scene.flank_errors is not None and scene.flank_errors.tolerance_class is not None:
        given["tolerance_class"] = scene.flank_errors.tolerance_class
    for name, (unit, low, high, _) in QUANTITIES.items():
        text = getattr(options, name)
        if text is not None:
            given[name] = number_of_option(option_of(name), text, unit, low, high)
    for name, (low, high, _) in NUMBERS.items():
        value = getattr(options, name)
        whole = name == "tolerance_class"
        if value is None:
            continue
        if not low <= value <= high or whole and value != int(value):
            kind = "a whole number " if whole else ""
            raise SceneError(f"{option_of(name)} {value:g}: allowed is {kind}from {low:g} to {high:g}.")
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
