"""The effects of a run, on and off, with the cost and change of each where `gears effects` has measured it."""

from __future__ import annotations

import csv
import math
from pathlib import Path

from fenics_gears.effects import effects_on
from fenics_gears.model.description import effect_states
from fenics_gears.show.report.page import Block, Fold, Picture, Section, Table, Words
from fenics_gears.show.run import NO_SCENE, Run
from fenics_gears.studies.effect_costs.subsets import ALL
from fenics_gears.studies.effect_costs.table import CSV_COLUMNS, MICRO, MILLI, in_percent

# The columns that hold a number in each line.
NUMBERS = CSV_COLUMNS[2:14]
CHANGES = ("change_of_transmission_error", "change_of_peak_force")
MEASURED_TABLE, MEASURED_PICTURE = "effects.csv", "effects.png"
# Relative; the same scene gives the same transmission error, on another processor to round-off.
SAME_ANSWER = 1e-3


def effects(run: Run) -> Section:
    """Each effect with what the model has by it or without it; below, what was measured."""
    if run.scene is None:
        return Section("effects", "Effects", [Words(NO_SCENE, warns=True)])
    states = effect_states(run.scene)
    on = [(f"[{state.effect.written}]", state.words) for state in states if state.on]
    off = [(f"[{state.effect.written}]", state.words) for state in states if not state.on]
    tables = [
        Table(("Section", "The model has"), on, "On", numbers=9),
        Fold(f"Off: {len(off)}", [Table(("Section", "In its place the model has"), off, numbers=9)]),
    ]  # fmt: skip
    return Section("effects", "Effects on and off", [*tables, *_measured(run)])


def _measured(run: Run) -> list[Block]:
    """What `gears effects` wrote into the run's directory, where it is of this scene."""
    file = run.file.parent / MEASURED_TABLE
    if not file.is_file():
        return [
            Words(
                "What each effect costs and changes was not measured; the report's option `--effects` does it (it runs"
                " the scene with and without each)."
            )
        ]
    lines = _lines(file)
    if lines is None:
        return [
            Words(
                f"{MEASURED_TABLE} beside the run is no table of this version's `gears effects`, and is left out.",
                warns=True,
            )
        ]
    if not _same_scene(run, lines):
        return [
            Words(
                f"{MEASURED_TABLE} beside the run was measured on another scene, and is left out; the report's option"
                " `--effects` measures anew.",
                warns=True,
            )
        ]
    blocks: list[Block] = [*_tables(lines)]
    picture = file.with_name(MEASURED_PICTURE)
    if picture.is_file():
        blocks.append(Picture("Cost and change of the effects", picture.read_bytes()))
    first = lines[0]
    blocks.append(
        Words(
            f"Measured on {first['processor']}, load {first['load']}; threads: {first['threads']}; {first['versions']}."
        )
    )
    return blocks


def _lines(file: Path) -> list[dict[str, str]] | None:
    """The table's lines; None where it is none of `gears effects`. A subset that was not run has no numbers."""
    try:
        with open(file, encoding="utf-8", newline="") as opened:
            reader = csv.DictReader(opened)
            lines, headings = list(reader), tuple(reader.fieldnames or ())
        for line in lines:
            for name in NUMBERS if line["step_time_s"] else ():
                float(line[name])
            for name in CHANGES:
                float(line[name] or 0.0)
    except (OSError, UnicodeDecodeError, csv.Error, KeyError, TypeError, ValueError):
        return None
    return lines if lines and headings == CSV_COLUMNS else None


def _same_scene(run: Run, lines: list[dict[str, str]]) -> bool:
    """Whether the scene as a whole is there, with this run's transmission error."""
    whole = {each.section for each in effects_on(run.scene)}
    found = next(
        (
            line
            for line in lines
            if line["step_time_s"] and line["effects"] == ALL and set(line["sections"].split()) == whole
        ),
        None,
    )
    if found is None:
        return False
    answer = run.dataset.attrs.get("peak_to_peak_transmission_error", math.nan) * run.micrometres
    measured = float(found["transmission_error_peak_to_peak_mm"]) * MILLI
    return not run.complete or math.isclose(measured, answer, rel_tol=SAME_ANSWER, abs_tol=1e-4)


def _tables(lines: list[dict[str, str]]) -> list[Block]:
    headings = (
        "Effects",
        "Unknowns",
        "Newton iterations per step",
        "Time per step (µs)",
        "Condensing (s)",
        "T_EPP (µm)",
        "Peak force (N)",
    )
    rows, skipped = [], []
    for line in lines:
        if not line["step_time_s"]:
            skipped.append((line["effects"], line["remarks"]))
            continue
        number = {name: float(line[name]) for name in NUMBERS}
        changes = [f" ({in_percent(float(line[name]))})" if line[name] else "" for name in CHANGES]
        rows.append((
            line["effects"], f"{number['centre_coordinates']:.0f} + {number['contact_rows']:.1f}",
            f"{number['newton_iterations_per_step']:.2f}", f"{number['step_time_s'] * MICRO:.3g}",
            f"{number['condensing_s']:.2f}",
            f"{number['transmission_error_peak_to_peak_mm'] * MILLI:.3f}{changes[0]}",
            f"{number['peak_force_N']:,.0f}{changes[1]}",
        ))  # fmt: skip
    caption = (
        "What each effect costs and changes: one more (changes are from the bare scene), one less (changes are from"
        " all)"
    )
    tables = [Table(headings, rows, caption)]
    return tables + [Table(("Not run", "Why"), skipped, numbers=9)] if skipped else tables
