"""The report of `gears accuracy` again, from the CSV that it wrote: for a picture drawn anew without measuring."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np

from fenics_gears.runs.timed import Times
from fenics_gears.scene.data import Scene
from fenics_gears.studies.accuracy import whole
from fenics_gears.studies.accuracy.convergence import Limit
from fenics_gears.studies.accuracy.measures import MEASURES, judged
from fenics_gears.studies.accuracy.refinement import fine, refinements
from fenics_gears.studies.accuracy.report import (
    DEFAULTS,
    OWN,
    AccuracyReport,
    LevelResult,
    RefinementResult,
    WholeResult,
)
from fenics_gears.studies.accuracy.setting import own_setting, without_settings
from fenics_gears.studies.accuracy.table import ORDERED

MACHINE = ("processor", "load", "threads", "versions")


def saved_report(scene: Scene, file: Path) -> AccuracyReport:
    """A scene's report with the errors and median times of its CSV; limits have orders alone, times no stages.

    Raises ValueError where the program would refine the scene otherwise than the CSV did.
    """
    with open(file, encoding="utf-8", newline="") as opened:
        lines = list(csv.DictReader(opened))
    results = _single(scene, [line for line in lines if line["kind"] == "single setting"])
    errors = {
        (each.refinement.name, each.refinement.levels.index(level.level)): judged(level.errors)
        for each in results
        for level in each.levels
    }
    ran = [each.refinement for each in results]
    known = {
        each.words: each
        for each in whole.path(fine(scene), ran, errors, lambda setting: whole.fits(scene, setting), whole.ENOUGH)
    }
    known |= {OWN: own_setting(scene), DEFAULTS: own_setting(without_settings(scene))}
    settings, models = [], []
    for line in lines:
        if line["kind"] == "setting":
            if line["name"] not in known:
                raise ValueError(f"{file}: the setting {line['name']!r} is none that would be run today; measure anew")
            chosen = known[line["name"]]
            settings.append(
                WholeResult(line["name"], chosen, _errors(line), whole.parts_of(chosen, ran, errors), _times(line))
            )
        elif line["kind"] == "model":
            models.append(WholeResult(line["name"], None, _errors(line), {}, _times(line)))
    reference = next(line for line in lines if line["kind"] == "reference")
    failures = tuple((line["name"], line["setting"]) for line in lines if line["kind"] == "failed")
    rounds = max(each.times.rounds for each in settings)
    return AccuracyReport(
        scene, fine(scene), results, tuple(settings), tuple(models), _errors(reference), failures,
        {name: reference[name] for name in MACHINE}, rounds,
    )  # fmt: skip


def _single(scene: Scene, lines: list[dict[str, str]]) -> tuple[RefinementResult, ...]:
    """Every setting refined alone, as far as it ran."""
    saved = {(line["name"], line["setting"]): line for line in lines}
    found = []
    for each in refinements(scene):
        levels = [
            (level, saved.pop((each.name, level.label))) for level in each.levels if (each.name, level.label) in saved
        ]
        if levels:
            limits = {name: Limit(np.zeros(0), _number(levels[0][1], "order", name), 0.0) for name in ORDERED}
            found.append(
                RefinementResult(
                    each, tuple(LevelResult(level, _errors(line), _times(line)) for level, line in levels), limits
                )
            )
    if saved:
        raise ValueError(f"{', '.join(map(' '.join, saved))}: no values that would be run today; measure anew")
    return tuple(found)


def _number(line: dict[str, str], what: str, name: str) -> float | None:
    text = line[f"{what}_{name.replace(' ', '_')}"]
    return float(text) if text else None


def _errors(line: dict[str, str]) -> dict[str, float]:
    return {name: _number(line, "error", name) for name in MEASURES}


def _times(line: dict[str, str]) -> Times:
    """The median run as often as was timed, all of it as march: medians of stages do not add up to that of the
    whole."""
    rounds = int(line["timed_runs"])
    return Times((0.0,) * rounds, (0.0,) * rounds, (float(line["time_s"]),) * rounds)
