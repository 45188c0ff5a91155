"""All stages of a REXS file as the scene of a gear train."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from fenics_gears import SceneError

from .attributes import Reading
from .flanks import loaded_flanks, note_what_is_left_out, relief_sections
from .gears import Sections, gear_sections
from .imported import check_complete
from .lead import lead_sections
from .loads import loaded_model, pinion_speed, wheel_torque
from .read import read_model
from .scene_text import train_text
from .stage import Stage, stages_in_a_row
from .values import ValueProblem


@dataclass(frozen=True)
class ImportedTrain:
    """The text of a scene, its stages, what had to be assumed, and what of the file it leaves out."""

    text: str
    stages: tuple[Stage, ...]
    assumed: tuple[str, ...]
    left_out: tuple[str, ...]


def imported_train(path: Path, load_case: str | None = None) -> ImportedTrain:
    """The stages of a REXS file, one after the other, as the text of a train's scene. Raises SceneError with all that
    is wrong."""
    reading = Reading()
    model = read_model(path)
    loaded = reading.attempt(lambda: loaded_model(model, load_case))
    try:
        stages = stages_in_a_row(loaded or model)
    except ValueProblem as problem:
        raise SceneError(f"{path}: {problem}\nNothing was written.") from None
    sections: Sections = {}
    ratios = []
    for stage in stages:
        own = _stage_sections(reading, stage)
        teeth = [own[f"gears.{name}"]["teeth"] for name in ("pinion", "wheel")]
        ratios.append(None if None in teeth else teeth[1].number / teeth[0].number)
        sections |= {_of_train(name, stage): fields for name, fields in own.items()}
    torque = reading.attempt(wheel_torque, loaded, stages[-1], ratios[-1])
    speed = reading.attempt(pinion_speed, loaded, stages[0], ratios[0])
    check_complete(reading, path)
    sections |= {"load": {"output_torque": torque}, "motion": {"input_speed": speed}}
    assumed = [
        f"{section}.{name} = {value.words}: {value.origin}"
        for section, fields in sections.items()
        for name, value in fields.items()
        if value.assumed
    ] + [each for stage in stages for each in loaded_flanks(stage)]
    left_out = [*reading.left_out, "directions of the wheels from the pinions, deviations of the flanks"]
    notes = {
        "Assumed, since the file does not say it:": assumed,
        "Left out, since a train has no place for it yet:": left_out,
    }
    return ImportedTrain(
        train_text(path.name, model, stages, sections, notes), tuple(stages), tuple(assumed), tuple(left_out)
    )


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
    """The name in a train of a section of a pair's scene."""
    home = f"stages.{name_of(stage)}"
    return home if section == "gears" else f"{home}.{section.removeprefix('gears.')}"
