"""The effects of a run, on and off, with the cost and change of each where `gears effects` has measured it."""

import csv
import math

from fenics_gears.many_runs import effects_on
from fenics_gears.pages import Block, Fold, PageSection, Picture, Table, Words, sentence
from fenics_gears.shown import NO_SCENE, ShownRun, effect_states, factor

MEASURED_TABLE = "effects.csv"
MEASURED_PICTURE = "effects.png"
# The line of the whole scene.
ALL = "all"
# Relative; the same scene gives the same transmission error, on another processor to round-off.
SAME_ANSWER = 1e-3


def effects(run: ShownRun) -> PageSection:
    """Each effect with what the model has by it or without it; below, what was measured."""
    if run.scene is None:
        return sentence("effects", "Effects", NO_SCENE, True)
    states = effect_states(run.scene)
    on = [(f"[{state.effect.written}]", state.words) for state in states if state.on]
    off = [(f"[{state.effect.written}]", state.words) for state in states if not state.on]
    tables: list[Block] = [
        Table(("Section", "The model has"), on, "On", numbers=9),
        Fold(f"Off: {len(off)}", [Table(("Section", "In its place the model has"), off, numbers=9)]),
    ]  # fmt: skip
    return PageSection("effects", "Effects on and off", [*tables, *_measured(run)])


def _measured(run: ShownRun) -> list[Block]:
    """The picture that `gears effects` wrote into the run's directory, where it is of this scene."""
    file = run.file.with_name(MEASURED_TABLE)
    picture = run.file.with_name(MEASURED_PICTURE)
    if not (file.is_file() and picture.is_file()):
        said = "What each effect costs and changes was not measured; the report's option `--effects` does it."
        return [Words(said)]
    try:
        with open(file, encoding="utf-8", newline="") as opened:
            whole = next(line for line in csv.DictReader(opened) if line["effects"] == ALL and line["step_time_s"])
        same = _same_scene(run, whole)
    except (OSError, UnicodeDecodeError, csv.Error, StopIteration, KeyError, TypeError, ValueError):
        said = f"{MEASURED_TABLE} beside the run is no table of this version's `gears effects`, and is left out."
        return [Words(said, warns=True)]
    if not same:
        said = (
            f"{MEASURED_TABLE} beside the run was measured on another scene, and is left out; the report's option"
            " `--effects` measures anew."
        )
        return [Words(said, warns=True)]
    machine = f"{whole['processor']}, load {whole['load']}; threads: {whole['threads']}; {whole['versions']}"
    drawn = Picture("What each effect costs and changes", picture.read_bytes(), f"All numbers: `{MEASURED_TABLE}`.")
    return [drawn, Words(f"Measured on {machine}.")]


def _same_scene(run: ShownRun, whole: dict[str, str]) -> bool:
    answer = run.dataset.attrs.get("peak_to_peak_transmission_error", math.nan) * run.micrometres
    measured = float(whole["transmission_error_peak_to_peak_mm"]) * factor("mm", "µm")
    same = not run.complete or math.isclose(measured, answer, rel_tol=SAME_ANSWER, abs_tol=1e-4)
    return same and set(whole["sections"].split()) == {each.section for each in effects_on(run.scene)}
