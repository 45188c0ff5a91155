"""`[accuracy] target` on five pairs and one with sharp tips: true errors and times beside the cheapest settings that reach the target, written into docs/accuracy.md.

    python -m tests.benchmarks.target_of_pairs [--only NAME]

True errors are distances from a reference (`target_reference`). The cheapest settings are looked for among `SEARCHED`, lucky ones whose
errors cancel included; the few that count are timed again, in turns with what the target chose.
"""

from __future__ import annotations

import argparse
import csv
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from tests.benchmarks.marked_section import write_section
from tests.benchmarks.target_pairs import pairs
from tests.benchmarks.target_reference import Reference, reference

from fenics_gears.errors import GearsError
from fenics_gears.model.model import model_of
from fenics_gears.model.resolution import NODE_SPACING
from fenics_gears.scene.data import Scene
from fenics_gears.scene.read import load_scene
from fenics_gears.simulation.warm_up import compile_kernels
from fenics_gears.studies.accuracy.measures import JUDGED, answer, distance
from fenics_gears.studies.accuracy.runs import Times, run_sharing, shared_gears
from fenics_gears.studies.accuracy.setting import Setting, half_width
from fenics_gears.studies.accuracy_target.choose import choose
from fenics_gears.studies.accuracy_target.trial_runs import TargetNotReached
from fenics_gears.studies.machine import machine
from fenics_gears.system.progress import SilentProgress

ROOT = Path(__file__).resolve().parents[2]
TARGETS = (0.05, 0.01, 0.002)
ROUNDS = 5
# Element, elements in a half-width, body elements in parts of their default; each at all numbers of steps.
SEARCHED = [("P2", flank, body) for flank in (0.5, 0.7, 1.0, 1.4, 2.0, 2.8, 4.0, 5.6) for body in (4.0, 1.0)]
SEARCHED += [(element, flank, 4.0) for element in ("P1", "Q1", "Q2") for flank in (1.0, 2.0, 4.0)]
STEPS = (10, 20, 40, 80, 160, 320, 640)
# Where none of these reaches a target: a corner of the curve may fall between 640 steps.
FINER = [("P2", flank, body) for flank in (2.8, 4.0, 5.6) for body in (1.0, 0.5)]
MORE_STEPS = (*STEPS, 1280, 2560)
HEADINGS = ("pair", "target, %", "chosen", "estimated, %", "true, %", "time, s", "cheapest found", "its error, %", "its time, s", "ratio", "runs to choose")


@dataclass(frozen=True)
class Row:
    """A pair and a target: what was chosen and what it is worth, beside the cheapest that reaches the target."""

    pair: str
    target: float
    chosen: Setting
    estimated: float
    true: float
    runs: int
    cheapest: Setting
    error: float
    times: tuple[Times, Times]

    @property
    def cells(self) -> tuple[str, ...]:
        """As a row of the table."""
        chosen, cheapest = (each.total for each in self.times)
        percent = (f"{100.0 * value:.2g}" for value in (self.target, self.estimated, self.true, self.error))
        target, estimated, true, error = percent
        return (
            self.pair, target, self.chosen.words, estimated, true, f"{chosen:.2g}", self.cheapest.words, error, f"{cheapest:.2g}",
            f"{chosen / cheapest:.2g}", str(self.runs),
        )  # fmt: skip


def true_error(found, known: Reference) -> float:
    """The larger of the judged measures' distances from the reference."""
    return max(distance(found, known.answer, name) for name in JUDGED)


def searched(scene: Scene, known: Reference, window: float, kinds=SEARCHED, counts=STEPS) -> list[tuple[float, float, Setting]]:
    """Seconds, true error and setting of all that are searched. Quasi-static and frictionless, fewer steps are some of many steps."""
    unit, gears, found = half_width(scene), shared_gears(2), []
    length = model_of(scene).resolution.contact_grid.length
    for element, flank, body in kinds:
        spacing = NODE_SPACING if element.endswith("2") else 1.0
        setting = Setting(element, unit / flank, spacing * unit / flank, length, body, counts[-1])
        try:
            run, _ = run_sharing(setting.of(scene), gears)
        except GearsError as error:
            print(f"  {setting.words}: {error}")
            continue
        for steps in counts:
            part = run.isel(time=slice(None, None, counts[-1] // steps))
            part.attrs["peak_to_peak_transmission_error"] = float(np.ptp(part.transmission_error.values))
            seconds = run.attrs["time_mesh"] + run.attrs["time_condense"] + run.attrs["time_march"] * steps / counts[-1]
            found.append((seconds, true_error(answer(part, window), known), replace(setting, steps=steps)))
    return sorted(found, key=lambda each: each[0])


def in_turns(scene: Scene, settings: tuple[Setting, ...]) -> tuple[Times, ...]:
    """Times of whole runs, every setting once a round."""
    times = [Times() for _ in settings]
    for _ in range(ROUNDS):
        for place, setting in enumerate(settings):
            run, _ = run_sharing(replace(scene, accuracy=setting.accuracy(scene.gears.module)), shared_gears())
            times[place] = times[place].and_also(run)
    return tuple(times)


def rows_of(name: str, scene: Scene, not_reached: list[str]) -> tuple[list[Row], Reference]:
    """All targets of a pair, and the reference that they are judged by; adds to `not_reached` what the program itself says is not."""
    window = model_of(scene).resolution.contact_grid.length
    known = reference(scene, window, told=lambda words: None)
    print(f"{name}: reference uncertain by {100.0 * max(known.uncertainty.values()):.2g} %", flush=True)
    candidates, rows = searched(scene, known, window), []
    for target in TARGETS:
        try:
            chosen = choose(scene, target, SilentProgress())
        except TargetNotReached as reason:
            print(f"  {reason}", flush=True)
            not_reached.append(f"{name} at {100.0 * target:g} %: {reason}")
            continue
        run, _ = run_sharing(replace(scene, accuracy=chosen.accuracy), shared_gears())
        true = true_error(answer(run, window), known)
        if all(error > target for _, error, _ in candidates):
            candidates = sorted(candidates + searched(scene, known, window, FINER, MORE_STEPS), key=lambda each: each[0])
        _, error, cheapest = next((each for each in candidates if each[1] <= target), (0.0, true, chosen.setting))
        times = in_turns(scene, (chosen.setting, cheapest))
        rows.append(Row(name, target, chosen.setting, chosen.estimated_error, true, chosen.runs, cheapest, error, times))
        print("  " + " | ".join(rows[-1].cells[1:]), flush=True)
    return rows, known


def page(rows: list[Row], references: dict[str, Reference], not_reached: list[str]) -> str:
    """The section of docs/accuracy.md."""
    lines = [f"|{'|'.join(HEADINGS)}|", "|" + "---|" * len(HEADINGS), *(f"|{'|'.join(row.cells)}|" for row in rows)]
    told = [f"{name}: {100.0 * max(each.uncertainty.values()):.2g} %" for name, each in references.items()]
    where = machine()
    ratios = [row.times[0].total / row.times[1].total for row in rows]
    within = sum(row.true <= row.target for row in rows)
    refused = "".join(f"\n\nRefused: {each}" for each in not_reached)
    return (
        f"**Of {len(rows)} targets {within} are reached; the chosen settings take {np.median(ratios):.2g} times as long as the cheapest settings found (median), "
        f"at most {max(ratios):.2g} times.**\n\nSettings are the element, the size of flank elements, the number of contact nodes, the steps per mesh cycle, and the size of body elements "
        "relative to the default (body x4).\n\n" + "\n".join(lines) + refused + f"\n\nUncertainty of the references: {'; '.join(told)}. All runs are quasi-static, without "
        "friction; all pairs but the last have 30 um of tip relief. "
        f"The cheapest settings are the quickest of {len(SEARCHED) * len(STEPS)} for each pair that reach the target by their true error, in which single errors may cancel by chance. "
        f"Finer settings were added where none of these reached it. Times are without the cache, medians of {ROUNDS} in "
        f"turns; load {where['load']}, {where['processor']}, {where['versions']}."
    )


def main() -> None:
    """Measure, print, write."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", help="one pair, by the beginning of its name; nothing is written")
    options = parser.parse_args()
    compile_kernels(tangential=False)
    rows, references, not_reached = [], {}, []
    for name, scene in pairs(load_scene(ROOT / "demos/lundvall2004.toml")).items():
        if options.only is None or name.startswith(options.only):
            found, references[name] = rows_of(name, scene, not_reached)
            rows += found
    if options.only is not None:
        return
    write_section(ROOT / "docs/accuracy.md", "<!-- target: begin -->", "<!-- target: end -->", page(rows, references, not_reached))
    with (ROOT / "docs/pictures/target_of_pairs.csv").open("w", newline="") as file:
        csv.writer(file).writerows([HEADINGS, *(row.cells for row in rows)])


if __name__ == "__main__":
    main()
