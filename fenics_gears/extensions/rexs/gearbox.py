"""All stages of a REXS file as the scene of a gear train."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from fenics_gears import SceneError

from .attributes import Reading, needed
from .bent_shafts import shaft_sections
from .flanks import loaded_flanks, note_what_is_left_out, relief_sections
from .gears import Sections, gear_sections
from .imported import by_call, check_complete
from .lead import lead_sections
from .loads import model_with_loads, pinion_speed, wheel_torque
from .model import RexsModel
from .placing import direction, turning_axis
from .read import read_model
from .rows import in_rows, names_of_gears, row_sections
from .scene_text import train_text
from .shaft_parts import SECTION
from .stage import Stage, stages_in_a_row
from .train import is_force
from .values import Value, ValueProblem, numbered


@dataclass(frozen=True)
class ImportedTrain:
    """The text of a scene, its stages, what had to be assumed, and what of the file it leaves out."""

    text: str
    stages: tuple[Stage, ...]
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
        stages = stages_in_a_row(loaded or model)
    except ValueProblem as problem:
        raise SceneError(f"{path}: {problem}\nNothing was written.") from None
    sections, left_out = _sections(reading, loaded or model, stages, bent)
    sections |= _loads(reading, loaded, stages, given)
    check_complete(reading, path)
    assumed = [
        f"{section}.{name} = {value.words}: {value.origin}"
        for section, fields in sections.items()
        for name, value in fields.items()
        if value.assumed
    ] + [each for stage in stages for each in loaded_flanks(stage)]
    notes = {
        "Assumed, since the file does not say it:": assumed,
        "Left out, since a train has no place for it yet:": left_out,
    }
    return ImportedTrain(
        train_text(path.name, model, stages, sections, notes), tuple(stages), tuple(assumed), tuple(left_out)
    )


def _sections(reading: Reading, model: RexsModel, stages: list[Stage], bent: bool) -> tuple[Sections, list[str]]:
    """Sections of all stages, and what is left out."""
    turning = turning_axis(stages[0])
    sections: Sections = {}
    placed = True
    rows = in_rows(stages)
    for row in rows:
        meshes = []
        for stage in row:
            own = _stage_sections(reading, stage)
            towards = reading.attempt(direction, stage, turning)
            placed = placed and towards is not None
            own["gears"] |= {"direction": towards} if towards is not None else {}
            meshes.append(own)
        found = meshes[0] if len(row) == 1 else row_sections(reading, row, meshes)
        sections |= {_of_train(name, row[0]): fields for name, fields in found.items()}
    shafts = shaft_sections(reading, model, stages, names_of_gears(rows, name_of)) if bent else {}
    left_out = [*reading.left_out, *_beside_the_gears(model, shafts)]
    sections |= shafts
    return sections, left_out if placed else [
        *left_out,
        "directions of wheels from pinions, which the file does not say",
    ]


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
    reading: Reading, model: RexsModel | None, stages: list[Stage], given: tuple[Value | None, Value | None]
) -> Sections:
    """Torque on the last gear and speed of the first one."""

    def ratio(stage: Stage) -> float | None:
        teeth = [reading.attempt(needed, part, "teeth") for part in (stage.pinion, stage.wheel)]
        return None if None in teeth else teeth[1].number / teeth[0].number

    torque = given[0] or reading.attempt(wheel_torque, model, stages[-1], ratio(stages[-1]))
    speed = given[1] or reading.attempt(pinion_speed, model, stages[0], ratio(stages[0]))
    return {"load": {"output_torque": torque}, "motion": {"input_speed": speed}}


def _stage_sections(reading: Reading, stage: Stage) -> Sections:
    sections = gear_sections(reading, stage)
    sections |= relief_sections(reading, stage, sections)
    sections |= lead_sections(reading, stage, sections)
    note_what_is_left_out(reading, stage)
    return sections


def name_of(stage: Stage) -> str:
    """What a stage is called in the scene."""
    return f"stage_{stage.stage.id}"


def _of_train(section: str, stage: Stage) -> str:
    """The name in a train of a section of a pair's scene, or of a row's gear."""
    home = f"stages.{name_of(stage)}"
    if section == "gears":
        return home
    inner = section.removeprefix("gears.")
    return f"{home}.gears.{inner}" if inner[0].isdigit() else f"{home}.{inner}"
