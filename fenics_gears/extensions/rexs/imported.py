"""A pair of a REXS file as a scene, with values of the command line in place of the file's."""

import json
from dataclasses import dataclass
from pathlib import Path

from fenics_gears import SceneError, units

from .attributes import Reading, first
from .flanks import note_what_is_left_out, relief_sections, tolerance_class
from .gears import Sections, gear_sections
from .lead import lead_sections
from .loads import loaded_model, pinion_speed, wheel_torque
from .model import Model
from .read import read_model
from .scene_text import scene_text
from .stage import Stage, chosen_stage
from .values import Value, ValueProblem

# Options that stand in for what the file says, with an example each.
TORQUE, SPEED = ("--wheel-torque", "437 N m"), ("--pinion-speed", "750 rpm")


@dataclass(frozen=True)
class ImportedScene:
    """The text of a scene; of which stage it is; what had to be assumed, as ``field = value: why``; what of the file it
    leaves out."""

    text: str
    stage: Stage
    assumed: tuple[str, ...]
    left_out: tuple[str, ...]


@dataclass(frozen=True)
class Choice:
    """Which stage and load case of a file are meant, None for the only one; torque of the driven and speed of the
    driving gear, as quantities of a scene, that stand before those of the file."""

    stage: int | None = None
    load_case: str | None = None
    wheel_torque: str | None = None
    pinion_speed: str | None = None


def imported_scene(path: Path, choice: Choice = Choice()) -> ImportedScene:
    """A pair of a REXS file as the text of a scene. Raises SceneError with all that is wrong."""
    by_call = _by_call(TORQUE, choice.wheel_torque), _by_call(SPEED, choice.pinion_speed)
    model, reading = read_model(path), Reading()
    loaded = reading.attempt(_loaded, model, choice)
    try:
        stage = chosen_stage(loaded or model, choice.stage)
    except ValueProblem as problem:
        raise SceneError(f"{path}: {problem}\nNothing was written.") from None
    sections = gear_sections(reading, stage)
    sections |= relief_sections(reading, stage, sections)
    sections |= lead_sections(reading, stage, sections)
    sections |= _load_sections(reading, loaded, stage, sections, by_call)
    sections |= _error_sections(reading, stage, sections)
    densities = {name: reading.attempt(first, part, "density") for name, part in zip(("pinion", "wheel"), stage.gears)}
    note_what_is_left_out(reading, stage)
    _check_all_found(reading, path)
    assumed = [
        f"{section}.{name} = {value.words}: {value.origin}"
        for section, found in sections.items()
        for name, value in found.items()
        if value.assumed
    ]
    notes = {
        "Assumed, since the file does not say it:": assumed,
        "Left out, since a scene has no place for it:": reading.left_out,
        "For [inertia], from which the masses and moments of inertia of both gears follow:": [
            f"[inertia.{name}] density = {density.written}, {density.origin}"
            for name, density in densities.items()
            if density is not None
        ],
    }
    text = scene_text(path.name, model, stage, sections, notes)
    return ImportedScene(text, stage, tuple(assumed), tuple(reading.left_out))


def _check_all_found(reading: Reading, path: Path) -> None:
    if reading.problems:
        count = "1 mistake" if len(reading.problems) == 1 else f"{len(reading.problems)} mistakes"
        raise SceneError(
            "\n".join([*(f"{path}: {each}" for each in reading.problems), f"{count} in {path}. Nothing was written."])
        )


def _loaded(model: Model, choice: Choice) -> Model:
    """The model in the chosen load case; as it is where the call says all that a load case is asked for."""
    if choice.load_case is None and choice.wheel_torque is not None and choice.pinion_speed is not None:
        return model
    return loaded_model(model, choice.load_case)


def _load_sections(
    reading: Reading, model: Model | None, stage: Stage, gears: Sections, by_call: tuple[Value | None, Value | None]
) -> Sections:
    """Torque and speed; ``model``: in its load case, None where that is not known."""
    teeth = gears["gears.pinion"]["teeth"], gears["gears.wheel"]["teeth"]
    ratio = None if None in teeth else teeth[1].number / teeth[0].number
    torque = by_call[0] or reading.attempt(wheel_torque, model, stage, ratio)
    speed = by_call[1] or reading.attempt(pinion_speed, None if model is None else stage, ratio)
    return {"load": {"wheel_torque": torque}, "motion": {"pinion_speed": speed}}


def _error_sections(reading: Reading, stage: Stage, sections: Sections) -> Sections:
    """The tolerance class, and how long the run takes."""
    tolerance = reading.attempt(tolerance_class, reading, stage)
    if tolerance is None:
        cycles = Value(1, "1", "quasi-static, so that all mesh cycles are alike", assumed=True)
        return {"motion": {**sections["motion"], "mesh_cycles": cycles}}
    cycles = Value(
        0, '"hunting tooth period"', "errors differ from tooth to tooth; so long until all have met", assumed=True
    )
    return {"motion": {**sections["motion"], "mesh_cycles": cycles}, "flank_errors": {"tolerance_class": tolerance}}


def _by_call(option: tuple[str, str], text: str | None) -> Value | None:
    """What the call says in the place of the file. Raises SceneError where it is no such quantity."""
    if text is None:
        return None
    name, example = option
    try:
        number, _ = units.of_kind(text, units.quantity(example)[1])
    except units.QuantityError as error:
        raise SceneError(f'{name} "{text}" {error} Allowed: such as "{example}".') from None
    return Value(number, json.dumps(text, ensure_ascii=False), name)
