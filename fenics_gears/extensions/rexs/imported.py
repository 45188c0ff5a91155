"""A pair of a REXS file as a scene, with values of the command line in place of the file's."""

import json
from dataclasses import dataclass
from pathlib import Path

from fenics_gears import SceneError, units

from .attributes import Reading, first
from .circles import without_derived_tip
from .flanks import loaded_flanks, note_what_is_left_out, relief_sections, tolerance_class
from .gears import Sections, gear_sections
from .lead import lead_sections
from .loads import model_with_loads, pinion_speed, wheel_torque
from .model import RexsModel
from .read import read_model
from .scene_text import scene_text
from .stage import Stage, chosen_stage
from .values import Value, ValueProblem


@dataclass(frozen=True)
class ImportedScene:
    """The text of a scene; of which stage it is; what had to be assumed, as ``field = value: why``; what of the file it
    leaves out."""

    text: str
    stage: Stage
    assumed: tuple[str, ...]
    left_out: tuple[str, ...]


def imported_scene(
    path: Path,
    stage: int | None = None,
    load_case: str | None = None,
    wheel_torque: str | None = None,
    pinion_speed: str | None = None,
) -> ImportedScene:
    """A pair of a REXS file as the text of a scene. Raises SceneError with all that is wrong.

    `stage`, `load_case`: which stage and load case are meant, None for the only one; `wheel_torque` and `pinion_speed`,
    of the driven and the driving gear, replace the file's.
    """
    given = by_call(wheel_torque, pinion_speed)
    model = read_model(path)
    reading = Reading()
    loaded = model_with_loads(reading, model, load_case, given)
    try:
        chosen = chosen_stage(loaded or model, stage)
    except ValueProblem as problem:
        raise SceneError(f"{path}: {problem}\nNothing was written.") from None
    sections = gear_sections(reading, chosen)
    sections |= relief_sections(reading, chosen, sections)
    sections |= lead_sections(reading, chosen, sections)
    without_derived_tip(sections)
    sections |= _load_sections(reading, loaded, chosen, sections, given)
    sections |= _error_sections(reading, chosen, sections)
    densities = {name: reading.attempt(first, part, "density") for name, part in chosen.named.items()}
    note_what_is_left_out(reading, chosen)
    check_complete(reading, path)
    assumed = [
        f"{section}.{name} = {value.words}: {value.origin}"
        for section, fields in sections.items()
        for name, value in fields.items()
        if value.assumed
    ] + loaded_flanks(chosen)
    notes = {
        "Assumed, since the file does not say it:": assumed,
        "Left out, since a scene has no place for it:": reading.left_out,
        "For [inertia], from which the masses and moments of inertia of both gears follow:": [
            f"[inertia.{name}] density = {density.written}, {density.origin}"
            for name, density in densities.items()
            if density is not None
        ],
    }
    text = scene_text(path.name, model, chosen, sections, notes)
    return ImportedScene(text, chosen, tuple(assumed), tuple(reading.left_out))


def check_complete(reading: Reading, path: Path) -> None:
    """Raise SceneError with all that the reading met."""
    if count := len(reading.problems):
        told = [f"{path}: {each}" for each in reading.problems]
        total = f"{count} mistake{'' if count == 1 else 's'} in {path}. Nothing was written."
        raise SceneError("\n".join([*told, total]))


def _load_sections(
    reading: Reading, model: RexsModel | None, stage: Stage, gears: Sections, given: tuple[Value | None, Value | None]
) -> Sections:
    """Torque and speed; ``model``: in its load case, None where that is not known."""
    teeth = gears["gears.pinion"]["teeth"], gears["gears.wheel"]["teeth"]
    ratio = None if None in teeth else abs(teeth[1].number / teeth[0].number)
    torque = given[0] or reading.attempt(wheel_torque, model, stage, ratio)
    speed = given[1] or reading.attempt(pinion_speed, model, stage, ratio)
    return {"load": {"wheel_torque": torque}, "motion": {"pinion_speed": speed}}


def _error_sections(reading: Reading, stage: Stage, sections: Sections) -> Sections:
    """The tolerance class, and how long the run takes."""
    tolerance = reading.attempt(tolerance_class, reading, stage)
    written = "1"
    why = "quasi-static, so that all mesh cycles are alike"
    if tolerance is not None:
        written = '"hunting tooth period"'
        why = "errors differ from tooth to tooth; so long until all have met"
    motion = {**sections["motion"], "mesh_cycles": Value(0.0, written, why, assumed=True)}
    return {"motion": motion, **({"flank_errors": {"tolerance_class": tolerance}} if tolerance is not None else {})}


def by_call(wheel_torque: str | None, pinion_speed: str | None) -> tuple[Value | None, Value | None]:
    """Torque and speed that the call has in place of the file's. Raises SceneError."""
    return _option("--wheel-torque", wheel_torque, "437 N m"), _option("--pinion-speed", pinion_speed, "750 rpm")


def _option(name: str, text: str | None, example: str) -> Value | None:
    """What an option says in the place of the file. Raises SceneError where it is no such quantity."""
    if text is None:
        return None
    try:
        number, _ = units.of_kind(text, units.quantity(example)[1])
    except units.QuantityError as error:
        raise SceneError(f'{name} "{text}" {error} Allowed: such as "{example}".') from None
    return Value(number, json.dumps(text, ensure_ascii=False), name)
