"""Tables that a scene's flank errors name: found, and compared with their gears. Not an effect by itself."""

import os
from dataclasses import replace
from hashlib import sha256
from pathlib import Path

from fenics_gears.errors import SceneError
from fenics_gears.geometry.flank_deviations import measured_share
from fenics_gears.geometry.flank_errors import CURVES, LISTS, REPLACED, TABLES, FlankErrors, GearErrors, lists_of
from fenics_gears.inputs.tree import GEARS, LARGEST_ERROR, NOT_IN_THE_PLANE
from fenics_gears.inputs.written import as_written

from . import flank_errors_file as tables
from .flank_errors_rules import PITCH_ROUNDING, not_closed

# Share of the active profile, or of the face, that a curve must cover.
LEAST_MEASURED = 0.8


def located(errors: FlankErrors, directory: Path) -> FlankErrors:
    """The errors with the values of their tables, whose paths start at a directory."""
    return errors.changed(lambda own: _with_table(own, directory))


def _with_table(errors: GearErrors, directory: Path) -> GearErrors:
    if not any(getattr(errors, name) for name in TABLES):
        return errors
    # `check` reports what is wrong; a scene that is only looked at needs no table.
    name = "file"
    try:
        if errors.file is not None:
            lists = tables.deviations_in(_in_folder(directory, errors.file), LISTS)
            twice = next((each for each in LISTS if each in lists and getattr(errors, each) is not None), None)
            if twice is not None:
                raise tables.FileProblem(f"the table has {twice}, which the scene has, too. Leave one of the two out.")
            errors = replace(errors, columns=tuple(lists), **lists)
        for name, (measured, along) in CURVES.items():
            if getattr(errors, name) is not None:
                curves = tables.curves_in(_in_folder(directory, getattr(errors, name)), getattr(tables, along))
                errors = replace(errors, **{measured: curves})
    except tables.FileProblem as problem:
        return replace(errors, problem=(name, str(problem)))
    return errors


def _in_folder(directory: Path, name: str) -> Path:
    # `Path.resolve` raises where a link leads to itself.
    return Path(os.path.realpath(directory / name))


def files(errors: FlankErrors) -> dict[str, str]:
    hashes: dict[str, str] = {}
    for own in errors.of_gears:
        said = {"file": {name: getattr(own, name) for name in own.columns}}
        said |= {name: repr(getattr(own, measured)) for name, (measured, _) in CURVES.items()}
        hashes |= {
            getattr(own, name): sha256(repr(said[name]).encode()).hexdigest()
            for name in TABLES
            if getattr(own, name) is not None
        }
    return hashes


def check(errors: FlankErrors, scene, pair) -> None:
    """Raise SceneError for a table that is wrong or not of its gear."""
    for gear in GEARS:
        own = getattr(errors, gear)
        name, problem = own.problem or _problem_of_tables(own, scene, pair, gear)
        in_table = [column for column in own.columns if column not in lists_of(scene)]
        if not problem and in_table:
            name = "file"
            problem = f"the column {in_table[0]} {NOT_IN_THE_PLANE}"
        if problem:
            written = as_written(getattr(own, name))
            raise SceneError(f"flank_errors.{gear}.{name} = {written}: {problem}\nNothing was computed or written.")


def _problem_of_tables(errors: GearErrors, scene, pair, gear: str) -> tuple[str, str]:
    """The field that names a table which does not fit the gear, and why; empty where all fit."""
    teeth = getattr(pair, gear).teeth
    module = scene.gears.module
    problem = "" if errors.file is None else _problem_of_table(errors, teeth, module, gear)
    if problem:
        return "file", problem
    for name, (measured, _) in CURVES.items():
        curves = getattr(errors, measured)
        if curves is None:
            continue
        for replaced in REPLACED[name]:
            if getattr(errors, replaced) is not None:
                return name, f"is given together with {replaced}, which the curves replace. Leave one of the two out."
        whole = "active profile" if measured == "measured_profile" else "face"
        for curve in curves.curves:
            if problem := _problem_of_curve(curve, curves.along, module, pair, gear, whole):
                return name, problem
    return "", ""


def _problem_of_curve(curve, along, module: float, pair, gear: str, whole: str) -> str:
    """What does not fit the gear; `whole`: of what a curve measures a part."""
    teeth = getattr(pair, gear).teeth
    largest = LARGEST_ERROR * module
    if curve.tooth > teeth:
        return (
            f"has a curve of tooth {curve.tooth}, but the {gear} has {teeth} teeth. Allowed: teeth from 1 to {teeth},"
            " counted as they mesh."
        )
    worst = max(abs(each) for each in curve.deviations)
    if worst > largest:
        return (
            f"has a deviation of {worst:.4g} mm on tooth {curve.tooth}, too large for a module of {module:g} mm."
            f" Allowed: up to {largest:g} mm."
        )
    share = measured_share(curve, along, pair, gear)
    if share < LEAST_MEASURED:
        return (
            f"measures {100.0 * share:.0f} % of the {whole} of tooth {curve.tooth}. Allowed: at least"
            f" {100.0 * LEAST_MEASURED:.0f} %; beyond its ends a curve is continued level."
        )
    return ""


def _problem_of_table(errors: GearErrors, teeth: int, module: float, gear: str) -> str:
    for name in LISTS:
        values = getattr(errors, name)
        if values is None:
            continue
        if len(values) != teeth:
            return f"has {len(values)} teeth, but the {gear} has {teeth}. Allowed: a line for each tooth."
        worst = max(range(teeth), key=lambda tooth: abs(values[tooth]))
        if abs(values[worst]) > LARGEST_ERROR * module:
            return (
                f"{name} of tooth {worst + 1} is {values[worst]:.4g} mm, too large an error of manufacture for a module"
                f" of {module:g} mm. Allowed: up to {LARGEST_ERROR * module:g} mm."
            )
        if name == "pitch" and not abs(sum(values)) <= PITCH_ROUNDING * teeth:
            return f"pitch {not_closed(sum(values))} The table has single pitch deviations, not cumulative ones."
    return ""
