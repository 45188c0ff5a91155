"""``[flank_errors]``: pitch, profile, helix and waviness deviations of single teeth (``geometry.flank_deviations``, ``contact.flank_gaps``).

Signs are those of ISO 1328-1. A pitch deviation is positive where the pitch is too long; a profile slope where the flank has material
in excess towards the tip; a profile form, which the standard gives no sign, where the middle of the flank stands out. Those of the helix are the like along the face, positive towards the right end, whatever the hand. Teeth are counted
in the order in which they mesh, from the tooth of either gear that meshes first; a pitch is that from the tooth before.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from dataclasses import replace
from hashlib import sha256
from math import lcm
from pathlib import Path
from typing import Any, Optional

from fenics_gears.effects.effect import Effect, ResultVariable
from fenics_gears.errors import SceneError
from fenics_gears.geometry.flank_error_data import FlankErrors, GearErrors
from fenics_gears.inputs.fields import Section, file_name, quantities, quantity, whole_number
from fenics_gears.inputs.problem import Problem
from fenics_gears.inputs.spelling import section_tree
from fenics_gears.inputs.tree import (
    GEARS,
    LARGEST_ERROR,
    NOT_IN_THE_PLANE,
    Tree,
    over_the_face,
    quantity_at,
    quantity_in,
    table,
    teeth_in,
    too_large_for_the_module,
    value_at,
)
from fenics_gears.inputs.written import as_written

HELIX = ("helix_slope", "helix_form")
LISTS = ("pitch", "profile_slope", "profile_form", *HELIX)
# Tables of curves: the field of their data, and the name of the columns that say where a point lies.
CURVES = {"profile_curves": ("measured_profile", "ALONG_PROFILE"), "helix_curves": ("measured_helix", "ALONG_FACE")}
REPLACED = {"profile_curves": ("profile_slope", "profile_form"), "helix_curves": HELIX}
TABLES = ("file", *CURVES)
# Share of the active profile, or of the face, that a curve must cover.
LEAST_MEASURED = 0.8
# Pitches of a measuring sheet are rounded to 0.1 um: their sum is off by at most half of that for each tooth.
PITCH_ROUNDING = 0.05e-3
# Reference diameters, modules and face widths (mm) that the tolerances of ISO 1328-1:2013 are for.
DIAMETERS, MODULES, WIDTHS = (5.0, 15e3), (0.5, 70.0), (4.0, 1200.0)

DRAWN = "random values within `tolerance_class`; without a class, zero"
DRAWN_OVER_FACE = f"{DRAWN}; not allowed in a plane scene"


class WavinessText(Section):
    """``[flank_errors.pinion.waviness]`` and the wheel's: a sinusoidal undulation around the gear."""

    amplitude: float = quantity(
        "1e-6 um", "100 mm", "1 um", meaning="amplitude", below="For flanks without waviness, leave the section out."
    )
    waves: int = whole_number(1, 1_000_000, 37, meaning="number of waves per revolution of the gear")
    phase: Optional[float] = quantity(
        "-360 deg", "360 deg", "90 deg", meaning="phase of the wave at the first tooth", otherwise="0 deg"
    )


class GearErrorsText(Section):
    """``[flank_errors.pinion]`` and ``[flank_errors.wheel]``: deviations of each tooth, as lists or as a table in a file."""

    file: Optional[str] = file_name(
        ".csv",
        "pinion.csv",
        meaning="table with a line for each tooth: the column `tooth`, counted from 1, and any of the columns `pitch (um)`, `profile_slope (um)`, "
        "`profile_form (um)`, `helix_slope (um)` and `helix_form (um)`; relative to the folder of the scene file",
        otherwise="no table",
    )

    pitch: Optional[tuple[float, ...]] = quantities(
        "-100 mm", "100 mm", "3.5 um", meaning="single pitch deviations, positive where the pitch is too long; their sum must be zero", otherwise=DRAWN
    )
    profile_slope: Optional[tuple[float, ...]] = quantities(
        "-100 mm", "100 mm", "4 um", meaning="profile slope deviations, positive with material in excess towards the tip", otherwise=DRAWN
    )
    profile_form: Optional[tuple[float, ...]] = quantities(
        "-100 mm", "100 mm", "3 um", meaning="profile form deviations, positive with material in excess in the middle of the flank", otherwise=DRAWN
    )
    helix_slope: Optional[tuple[float, ...]] = quantities(
        "-100 mm", "100 mm", "5 um", meaning="helix slope deviations over the face width, positive with material in excess towards the right end", otherwise=DRAWN_OVER_FACE
    )
    helix_form: Optional[tuple[float, ...]] = quantities(
        "-100 mm", "100 mm", "3 um", meaning="helix form deviations, positive with material in excess in the middle of the face", otherwise=DRAWN_OVER_FACE
    )
    profile_curves: Optional[str] = file_name(
        ".csv",
        "pinion_profile.csv",
        meaning="measured profiles: a table with a line for each point, the columns `tooth`, `deviation (um)`, positive with material in excess, and `roll_length (mm)`, "
        "`roll_angle (deg)` or `diameter (mm)`; a tooth without a curve has the mean of the curves; in place of `profile_slope` and `profile_form`",
        otherwise="no curves",
    )
    helix_curves: Optional[str] = file_name(
        ".csv",
        "pinion_helix.csv",
        meaning="measured helices: the same with `face_position (mm)` from mid-width to the right; in place of `helix_slope` and `helix_form`",
        otherwise="no curves; not allowed in a plane scene",
    )
    waviness: Optional[WavinessText] = None


class FlankErrorsText(Section):
    """``[flank_errors]``: deviations that are not given are random values within a tolerance class."""

    tolerance_class: Optional[int] = whole_number(
        1, 11, 6, meaning="flank tolerance class of ISO 1328-1 that limits the random deviations", otherwise="no random deviations"
    )
    seed: Optional[int] = whole_number(0, 2**31 - 1, 1, meaning="seed of the random numbers", otherwise="1")
    pinion: Optional[GearErrorsText] = None
    wheel: Optional[GearErrorsText] = None


def write(errors: FlankErrors) -> dict:
    """The section; what stands in tables is left to them."""
    found = section_tree(errors, FlankErrorsText)
    for gear in GEARS:
        for column in getattr(errors, gear).columns:
            found[gear].pop(column, None)
    return found


def located(errors: FlankErrors, directory: Path) -> FlankErrors:
    """The errors with those that stand in tables, found from a directory on."""
    return replace(errors, pinion=_with_table(errors.pinion, directory), wheel=_with_table(errors.wheel, directory))


def _with_table(errors: GearErrors, directory: Path) -> GearErrors:
    if not any(getattr(errors, name) for name in TABLES):
        return errors
    from fenics_gears.effects import flank_errors_file as files

    # `check` reports what is wrong; a scene that is only looked at needs no table.
    name = "file"
    try:
        if errors.file is not None:
            found = files.deviations_in(_found(directory, errors.file), LISTS)
            twice = next((each for each in LISTS if each in found and getattr(errors, each) is not None), None)
            if twice is not None:
                raise files.FileProblem(f"the table has {twice}, which the scene has, too. Leave one of the two out.")
            errors = replace(errors, columns=tuple(found), **found)
        for name, (measured, along) in CURVES.items():
            if getattr(errors, name) is not None:
                curves = files.curves_in(_found(directory, getattr(errors, name)), getattr(files, along))
                errors = replace(errors, **{measured: curves})
    except files.FileProblem as problem:
        return replace(errors, problem=(name, str(problem)))
    return errors


def files(errors: FlankErrors) -> dict[str, str]:
    """Names of the tables, with a hash of what they say."""
    found = {}
    for own in (errors.pinion, errors.wheel):
        said = {"file": {name: getattr(own, name) for name in own.columns}} | {name: repr(getattr(own, measured)) for name, (measured, _) in CURVES.items()}
        found |= {getattr(own, name): sha256(repr(said[name]).encode()).hexdigest() for name in TABLES if getattr(own, name) is not None}
    return found


def _found(directory: Path, name: str) -> Path:
    # `Path.resolve` raises where a link leads to itself.
    return Path(os.path.realpath(directory / name))


def check(errors: FlankErrors, scene, pair) -> None:
    """Raise SceneError for a table that is wrong or not of its gear."""
    for gear in GEARS:
        own = getattr(errors, gear)
        name, problem = own.problem or _problem_of_tables(own, scene, pair, gear)
        if problem:
            raise SceneError(f"flank_errors.{gear}.{name} = {as_written(getattr(own, name))}: {problem}\nNothing was computed or written.")
        in_table = [name for name in HELIX if own.file is not None and getattr(own, name) is not None]
        if in_table and not scene.three_dimensional:
            raise SceneError(f"flank_errors.{gear}.file = {as_written(own.file)}: the column {in_table[0]} {NOT_IN_THE_PLANE}\nNothing was computed or written.")


def _problem_of_tables(errors: GearErrors, scene, pair, gear: str) -> tuple[str, str]:
    """The field that names a table which does not fit the gear, and why; empty where all fit."""
    teeth, module = getattr(pair, gear).teeth, scene.gears.module
    problem = "" if errors.file is None else _problem_of_table(errors, teeth, module, gear)
    if problem:
        return "file", problem
    from fenics_gears.geometry.flank_deviations import measured_share

    for name, (measured, _) in CURVES.items():
        curves = getattr(errors, measured)
        if curves is None:
            continue
        for replaced in REPLACED[name]:
            if getattr(errors, replaced) is not None:
                return name, f"stands beside {replaced}, which the curves replace. Leave one of the two out."
        for curve in curves.curves:
            if curve.tooth > teeth:
                return name, f"has a curve of tooth {curve.tooth}, but the {gear} has {teeth} teeth. Allowed: teeth from 1 to {teeth}, counted as they mesh."
            worst = max(abs(each) for each in curve.deviations)
            if worst > LARGEST_ERROR * module:
                return name, f"has a deviation of {worst:.4g} mm on tooth {curve.tooth}, too large for a module of {module:g} mm. Allowed: up to {LARGEST_ERROR * module:g} mm."
            share = measured_share(curve, curves.along, pair, gear)
            if share < LEAST_MEASURED:
                whole = "active profile" if measured == "measured_profile" else "face"
                return name, (
                    f"measures {100.0 * share:.0f} % of the {whole} of tooth {curve.tooth}. Allowed: at least {100.0 * LEAST_MEASURED:.0f} %; beyond its ends a curve is continued level."
                )
    return "", ""


def _problem_of_table(errors: GearErrors, teeth: int, module: float, gear: str) -> str:
    """What does not fit the gear, by the rules of lists; empty where all does."""
    for name in LISTS:
        values = getattr(errors, name)
        if values is None:
            continue
        if len(values) != teeth:
            return f"has {len(values)} teeth, but the {gear} has {teeth}. Allowed: a line for each tooth."
        worst = max(range(teeth), key=lambda tooth: abs(values[tooth]))
        if abs(values[worst]) > LARGEST_ERROR * module:
            return (
                f"{name} of tooth {worst + 1} is {values[worst]:.4g} mm, too large an error of manufacture for a module of {module:g} mm. "
                f"Allowed: up to {LARGEST_ERROR * module:g} mm."
            )
        if name == "pitch" and not abs(sum(values)) <= PITCH_ROUNDING * teeth:
            return f"pitch {_not_closed(sum(values))} The table has single pitch deviations, not cumulative ones."
    return ""


def errors_fit_the_gears(tree: Tree) -> Iterator[Problem]:
    """There are errors; lists have a value for each tooth; pitches close over a turn; the tolerance class is for gears of this size."""
    errors = table(tree, "flank_errors")
    if errors is None:
        return
    if "seed" in errors and "tolerance_class" not in errors:
        message = "is missing. Allowed: a class from 1 to 11; without one the seed draws nothing."
        yield Problem(("flank_errors", "tolerance_class"), None, message)
    if "tolerance_class" in errors:
        yield from _class_is_for_the_gears(tree, errors)
    elif not any(table(errors, gear) for gear in GEARS):
        message = "has no errors. Add a tolerance_class, or [flank_errors.pinion] with a list or a file. For true flanks, leave the section out."
        yield Problem(("flank_errors",), "", message)
    for gear in GEARS:
        own = table(errors, gear) or {}
        yield from _lists_fit_the_teeth(own, teeth_in(tree, gear), gear)
        yield from _errors_are_small(tree, own, gear)
        if not over_the_face(tree):
            in_space = (*HELIX, "helix_curves")
            yield from (Problem(("flank_errors", gear, name), as_written(own[name]), NOT_IN_THE_PLANE) for name in in_space if name in own)


def _errors_are_small(tree: Tree, errors: Tree, gear: str) -> Iterator[Problem]:
    """Deviations are small against the tooth, whose place and shape stay what they are."""
    values = {(name,): errors.get(name) for name in LISTS}
    values["waviness", "amplitude"] = value_at(errors, "waviness", "amplitude")
    for path, written in values.items():
        yield from too_large_for_the_module(tree, ("flank_errors", gear, *path), written)


def _lists_fit_the_teeth(errors: Tree, teeth: int | None, gear: str) -> Iterator[Problem]:
    for name in LISTS:
        values = errors.get(name)
        if not isinstance(values, list) or teeth is None or not values:
            continue
        path = ("flank_errors", gear, name)
        if len(values) != teeth:
            message = f"has {len(values)} values, but the {gear} has {teeth} teeth. Allowed: a value for each tooth."
            yield Problem(path, as_written(values), message)
        elif name == "pitch":
            yield from _pitches_close(values, path)


def _pitches_close(values: list, path: tuple[str, ...]) -> Iterator[Problem]:
    """The single pitch deviations of a whole turn sum to zero; the last tooth would not meet the first otherwise."""
    numbers = [quantity_in(value) for value in values]
    if None in numbers:
        return
    total = sum(numbers)
    if not abs(total) <= PITCH_ROUNDING * len(numbers):
        yield Problem(path, as_written(values), _not_closed(total))


def _not_closed(total: float) -> str:
    return f"sums to {1e3 * total:.4g} um over the whole turn. Allowed: pitch deviations that sum to zero, rounding to 0.1 um apart."


def _class_is_for_the_gears(tree: Tree, errors: Tree) -> Iterator[Problem]:
    module = quantity_at(tree, "gears", "module")
    path, written = ("flank_errors", "tolerance_class"), as_written(errors["tolerance_class"])
    if module is None:
        return
    if not MODULES[0] <= module <= MODULES[1]:
        message = f"is for modules from {MODULES[0]:g} to {MODULES[1]:g} mm (ISO 1328-1), not {module:g} mm. Allowed: lists of errors instead."
        yield Problem(path, written, message)
    for gear in GEARS:
        width = quantity_at(tree, "gears", gear, "face_width") or quantity_at(tree, "gears", "face_width")
        if over_the_face(tree) and width is not None and not WIDTHS[0] <= width <= WIDTHS[1]:
            message = f"is for face widths from {WIDTHS[0]:g} mm to {WIDTHS[1]:g} mm (ISO 1328-1), not {width:g} mm. Allowed: lists of errors instead."
            yield Problem(path, written, message)
        diameter = module * (teeth_in(tree, gear) or 100)
        if not DIAMETERS[0] <= diameter <= DIAMETERS[1]:
            message = f"is for reference diameters from 5 mm to 15 m (ISO 1328-1), not {diameter:g} mm. Allowed: lists of errors instead."
            yield Problem(path, written, message)


def gaps(errors: FlankErrors, model):
    """What the errors of the teeth that meet add to the gaps."""
    from fenics_gears.contact.flank_gaps import flank_gaps

    return flank_gaps(errors, model.pair, model.resolution.steps_per_mesh_cycle, model.face)


def results(errors: FlankErrors, scene, cycle, steps) -> dict[str, Any]:
    """The deviations of every tooth, given and drawn; slope and form of measured curves are evaluated by ISO 1328-1."""
    from fenics_gears.geometry.flank_deviations import flank_deviations, slope_and_form

    values = {}
    for gear, found in zip(GEARS, flank_deviations(errors, cycle.pair, None if cycle.face is None else cycle.face.middles)):
        dimension = (f"{gear}_tooth",)
        values[f"{gear}_index_deviation"] = dimension, found.index
        slope, form = slope_and_form(found)
        values[f"{gear}_profile_slope"] = dimension, slope
        values[f"{gear}_profile_form"] = dimension, form
        if found.helix is not None:
            slope, form = slope_and_form(found.helix)
            values[f"{gear}_helix_slope"] = dimension, slope
            values[f"{gear}_helix_form"] = dimension, form
    return values


def period(errors: FlankErrors, scene) -> int:
    """Mesh cycles of whole turns of the gears whose teeth differ."""
    names, drawn = LISTS if scene.three_dimensional else [name for name in LISTS if name not in HELIX], errors.tolerance_class is not None
    return lcm(*(getattr(scene.gears, gear).teeth for gear in GEARS if _differ(getattr(errors, gear), names, drawn)))


def _differ(own: GearErrors, names: Sequence[str], drawn: bool) -> bool:
    """Whether a gear's teeth are not all alike in deviations of some names; what is not given is `drawn`, or there is none of it."""
    given = [getattr(own, name) for name in names]
    measured = own.profile_curves is not None or own.helix_curves is not None
    return own.waviness is not None or measured or any(drawn if values is None else len(set(values)) > 1 for values in given)


EFFECT = Effect(
    section="flank_errors",
    description="pitch, profile and helix deviations and waviness of the teeth, given for each tooth or random within a flank tolerance class",
    absent="all teeth are alike and at their nominal places",
    text=FlankErrorsText,
    data=FlankErrors,
    terms=("gaps that differ from tooth to tooth, over a hunting tooth period",),
    variables=tuple(
        ResultVariable(f"{gear}_{name}", "mm", f"{words} of each tooth of the {gear}", dims=(f"{gear}_tooth",), over_face=name in HELIX)
        for gear in GEARS
        for name, words in (
            ("index_deviation", "cumulative pitch deviation"),
            ("profile_slope", "profile slope deviation"),
            ("profile_form", "profile form deviation"),
            ("helix_slope", "helix slope deviation"),
            ("helix_form", "helix form deviation"),
        )
    ),
    write=write,
    located=located,
    files=files,
    check=check,
    rules=errors_fit_the_gears,
    gaps=gaps,
    period=period,
    results=results,
)
