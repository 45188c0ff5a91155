"""All stages of a REXS file as the scene of a gear train."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from fenics_gears import SceneError

from .attributes import Reading, needed
from .bent_shafts import shaft_sections
from .branches import Branches
from .circles import without_derived_tip
from .flanks import loaded_flanks, note_what_is_left_out, relief_sections
from .gears import Sections, gear_sections
from .imported import by_call, check_complete
from .lead import lead_sections
from .loads import model_with_loads, speed_of_input, torque_of_output
from .model import RexsModel
from .order import Unit, described, is_series, units_in_order
from .placing import direction, turning_axis
from .planetary import set_sections
from .read import read_model
from .rows import in_rows, names_of_gears, row_sections
from .scene_text import train_text
from .shaft_parts import SECTION
from .stage import Stage
from .transmission import is_force
from .values import Value, ValueProblem, numbered


@dataclass(frozen=True)
class ImportedTrain:
    """The text of a scene, who drives whom in it, what had to be assumed, and what of the file it leaves out."""

    text: str
    stages: tuple[str, ...]
    assumed: tuple[str, ...]
    left_out: tuple[str, ...]


def imported_train(
    path: Path,
    load_case: str | None = None,
    wheel_torque: str | None = None,
    pinion_speed: str | None = None,
    bent: bool = False,
) -> ImportedTrain:
    """The stages of a REXS file, one after the other, as the text of a train's scene. Raises SceneError with all that
    is wrong. `wheel_torque` of the last gear and `pinion_speed` of the first one replace the file's; `bent`: with its
    shafts, those that it describes completely."""
    given = by_call(wheel_torque, pinion_speed)
    reading = Reading()
    model = read_model(path)
    loaded = model_with_loads(reading, model, load_case, given)
    try:
        units = units_in_order(loaded or model)
    except ValueProblem as problem:
        raise SceneError(f"{path}: {problem}\nNothing was written.") from None
    branches = None if is_series(loaded or model, units) else Branches(loaded or model, _pairs(units), name_of)
    sections, left_out = _sections(reading, loaded or model, units, branches, bent)
    sections |= _loads(reading, loaded, units, branches, given)
    check_complete(reading, path)
    assumed = [
        f"{section}.{name} = {value.words}: {value.origin}"
        for section, fields in sections.items()
        for name, value in fields.items()
        if value.assumed
    ] + [each for stage in _pairs(units) for each in loaded_flanks(stage)]
    notes = {
        "Assumed, since the file does not say it:": assumed,
        "Left out, since a train has no place for it yet:": left_out,
    }
    who = tuple(f"{each.stage}: {described(each)}" for each in units)
    return ImportedTrain(train_text(path.name, model, who, sections, notes), who, tuple(assumed), tuple(left_out))


def _pairs(units: Sequence[Unit]) -> list[Stage]:
    return [each for each in units if isinstance(each, Stage)]


def _sections(
    reading: Reading, model: RexsModel, units: Sequence[Unit], branches: Branches | None, bent: bool
) -> tuple[Sections, list[str]]:
    """Sections of all stages, and what is left out."""
    sections: Sections = {}
    names: dict[int, str] = {} if branches is None else branches.names
    placed: list[bool] = []
    stages: list[Stage] = []
    for unit in (*units, None):
        if isinstance(unit, Stage):
            stages.append(unit)
            continue
        if stages:
            meshes = [_stage_sections(reading, stage, turning_axis(stages[0])) for stage in stages]
            placed += ["direction" in mesh["gears"] for mesh in meshes]
            rows = [[stage] for stage in stages] if branches else in_rows(stages)
            names |= {} if branches else names_of_gears(rows, name_of)
            sections |= _of_stages(reading, rows, meshes, branches)
            stages = []
        if unit is not None:
            found = set_sections(reading, model, unit)
            sections |= {f"stages.{name_of(unit)}{name and '.'}{name}": fields for name, fields in found.items()}
    shafts, left_out = _shafts(reading, model, units, branches, names, bent)
    return sections | shafts, left_out if all(placed) else [
        *left_out,
        "directions of wheels from pinions, which the file does not say",
    ]


def _of_stages(
    reading: Reading, rows: Sequence[Sequence[Stage]], meshes: Sequence[Sections], branches: Branches | None
) -> Sections:
    """Sections of stages that stand beside each other in the scene, from those of their meshes."""
    if branches is not None:
        meshes = branches.sections(reading, meshes)
    left = list(meshes)
    sections: Sections = {}
    for row in rows:
        own = [left.pop(0) for _ in row]
        found = own[0] if len(row) == 1 else row_sections(reading, row, own)
        sections |= {_of_train(name, row[0]): fields for name, fields in found.items()}
    return sections


def _shafts(
    reading: Reading,
    model: RexsModel,
    units: Sequence[Unit],
    branches: Branches | None,
    names: dict[int, str],
    bent: bool,
) -> tuple[Sections, list[str]]:
    """Sections of shafts that bend or carry several gears, and what is left out beside the gears."""
    stages = _pairs(units)
    if bent and len(stages) < len(units):
        bent = False
        reading.left_out.append("bending of shafts, which is not computed beside planetary sets")
    shafts = shaft_sections(reading, model, stages, names) if bent else {}
    left_out = [*reading.left_out, *_beside_the_gears(model, shafts)]
    carried = branches.shafts() if branches is not None else {}
    # A shaft that bends says itself what it carries.
    return {**carried, **shafts}, left_out


def _beside_the_gears(model: RexsModel, shafts: Sections) -> list[str]:
    """What of the shafts a scene leaves out; where some bend, the rest is told with each that does not."""
    components = model.components.values()
    kinds = {"forces on shafts": [each.id for each in components if is_force(each)]}
    if not shafts:
        kinds["shaft sections"] = [each.id for each in components if each.type == SECTION]
        kinds["bearings"] = [each.id for each in components if "_bearing" in each.type and "row" not in each.type]
    found = [f"{what}: {numbered(numbers)}" for what, numbers in kinds.items() if numbers]
    return [*found, "deviations of the flanks"]


def _loads(
    reading: Reading,
    model: RexsModel | None,
    units: Sequence[Unit],
    branches: Branches | None,
    given: tuple[Value | None, Value | None],
) -> Sections:
    """Torque on the last gear and speed of the first one; of a train with several ends the torques of all but one."""

    def ratio(unit: Unit) -> float | None:
        if not isinstance(unit, Stage):
            turns = unit.own.turns(unit.held)
            return abs(turns[unit.input] / turns[unit.output])
        teeth = [reading.attempt(needed, part, "teeth") for part in (unit.pinion, unit.wheel)]
        return None if None in teeth else abs(teeth[1].number / teeth[0].number)

    speed = given[1] or reading.attempt(speed_of_input, model, units[0], ratio(units[0]))
    motion = {"motion": {"input_speed": speed}}
    if branches is not None:
        return {"load": reading.attempt(partial(branches.loads, given[0])) or {}} | motion if model else motion
    torque = given[0] or reading.attempt(torque_of_output, model, units[-1], ratio(units[-1]))
    return {"load": {"output_torque": torque}} | motion


def _stage_sections(reading: Reading, stage: Stage, turning: np.ndarray) -> Sections:
    sections = gear_sections(reading, stage)
    sections |= relief_sections(reading, stage, sections)
    sections |= lead_sections(reading, stage, sections)
    without_derived_tip(sections)
    note_what_is_left_out(reading, stage)
    towards = reading.attempt(direction, stage, turning)
    sections["gears"] |= {"direction": towards} if towards is not None else {}
    return sections


def name_of(stage: Unit) -> str:
    """What a stage is called in the scene."""
    return f"stage_{stage.stage.id}"


def _of_train(section: str, stage: Stage) -> str:
    """The name in a train of a section of a pair's scene, or of a row's gear."""
    home = f"stages.{name_of(stage)}"
    if section == "gears":
        return home
    inner = section.removeprefix("gears.")
    return f"{home}.gears.{inner}" if inner[0].isdigit() else f"{home}.{inner}"
