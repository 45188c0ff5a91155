"""The effects of a run, on and off, with the cost and change of each where `gears effects` has measured it."""

import csv
import math
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path

import xarray as xr

from fenics_gears.many_runs import effects_on
from fenics_gears.pages import Block, Fold, PageSection, Picture, Table, Words, sentence
from fenics_gears.shown import NO_SCENE, ShownRun, TrainScene, effect_states, factor

MEASURED_TABLE = "effects.csv"
MEASURED_PICTURE = "effects.png"
# The line of the whole scene.
ALL = "all"
# Relative; the same scene gives the same transmission error, on another processor to round-off.
SAME_ANSWER = 1e-3
# By them a train that was measured is told from others, rad.
OVERALL_NUMBERS = "mean_overall_transmission_error", "peak_to_peak_overall_transmission_error"


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
    return PageSection("effects", "Effects on and off", [*tables, *_measured_pair(run)])


def effects_of_train(dataset: xr.Dataset, train: TrainScene, runs: Mapping[int, ShownRun], file: Path) -> PageSection:
    """Effects that meshes have; below, what was measured of the train, or of each mesh that is a pair by itself."""
    having: dict[tuple[str, str], list[str]] = {}
    for number, run in runs.items():
        for state in effect_states(run.scene):
            if state.on:
                having.setdefault((f"[{state.effect.written}]", state.words), []).append(train.meshes[number].name)
    rows = [(section, "; ".join(names), words) for (section, words), names in having.items()]
    blocks: list[Block] = [Table(("Section", "Meshes", "The model has"), rows, "In the meshes", numbers=9)]
    if not train.alone:
        return PageSection("effects", "Effects", [*blocks, *_measured(file, partial(_same_train, dataset))])
    for number in train.alone:
        blocks += [Words(f"Of mesh {train.meshes[number].name} by itself:"), *_measured_pair(runs[number])]
    return PageSection("effects", "Effects", blocks)


def _measured_pair(run: ShownRun) -> list[Block]:
    return _measured(run.file, partial(_same_scene, run))


def _measured(run: Path, is_same: Callable[[dict[str, str]], bool]) -> list[Block]:
    """The picture that `gears effects` wrote beside a run, where by the line of all effects it `is_same`."""
    file = run.with_name(MEASURED_TABLE)
    picture = run.with_name(MEASURED_PICTURE)
    if not (file.is_file() and picture.is_file()):
        said = "What each effect costs and changes was not measured; the report's option `--effects` does it."
        return [Words(said)]
    try:
        with open(file, encoding="utf-8", newline="") as opened:
            lines = [line for line in csv.DictReader(opened) if next(iter(line.values())) == ALL]
        whole = next(line for line in lines if line.get("step_time_s") or line.get("seconds"))
        same = is_same(whole)
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


def _same_train(dataset: xr.Dataset, whole: dict[str, str]) -> bool:
    return all(
        math.isclose(float(whole[name]), dataset.attrs[name], rel_tol=SAME_ANSWER, abs_tol=1e-9)
        for name in OVERALL_NUMBERS
    )
