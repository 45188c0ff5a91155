"""`[accuracy] target`: true errors and costs beside the cheapest settings that reach the target. True errors are
distances from a reference (`target_reference`); costs are counted as the program counts them; what choosing takes is
processor time."""

from __future__ import annotations

import argparse
import csv
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from tests.benchmarks.target_pairs import held_out, pairs
from tests.benchmarks.target_reference import Reference, at_sizes, counted_seconds, reference

from fenics_gears.model.model import model_of
from fenics_gears.runs.settings.measures import JUDGED, Answer, distance, judged_answer
from fenics_gears.runs.settings.setting import Setting
from fenics_gears.runs.settings.target import Chosen, choose
from fenics_gears.runs.settings.trial_runs import TargetNotReached
from fenics_gears.runs.timed import run_sharing, shared_gears
from fenics_gears.scene.data import Scene
from fenics_gears.scene.read import load_scene
from fenics_gears.simulation.warm_up import compile_kernels
from fenics_gears.system.progress import SilentProgress

ROOT = Path(__file__).resolve().parents[2]
FILE = ROOT / "docs/pictures/target_of_pairs.csv"
TARGETS = (0.05, 0.01, 0.002)
MESHES, STEPS = (4.0, 3.0, 2.0, 1.4, 1.0, 0.7), (20, 40, 80, 160, 320)
HEADINGS = (
    "pair",
    "target, %",
    "chosen",
    "estimated, %",
    "true, %",
    "counted, s",
    "choosing, in runs",
    "trial runs",
    "cheapest found",
    "its error, %",
    "it counts, s",
    "ratio",
    "without luck",
)

# Counted seconds, true error, setting.
Found = tuple[float, float, Setting]


@dataclass(frozen=True)
class Row:
    """A pair and a target: what was chosen, its true error and `counted` seconds, `choosing` in runs, beside the
    cheapest that reaches it and the cheapest that reaches it together with all that are finer."""

    pair: str
    target: float
    chosen: Chosen
    true: float
    counted: float
    choosing: float
    cheapest: Found | None
    dependable: Found | None

    def ratio(self, found: Found | None) -> float:
        """Cost of the chosen settings in that of some that were found; 1 where none were."""
        return self.counted / found[0] if found else 1.0

    @property
    def cells(self) -> tuple[str, ...]:
        """As a row of the table."""
        beside = ("none", "", "", "", "")
        if self.cheapest:
            seconds, error, setting = self.cheapest
            beside = (
                setting.words,
                f"{100.0 * error:.2g}",
                f"{seconds:.2g}",
                f"{self.ratio(self.cheapest):.3g}",
                f"{self.ratio(self.dependable):.3g}" if self.dependable else "",
            )
        errors = (f"{100.0 * value:.2g}" for value in (self.chosen.estimated_error, self.true))
        times = f"{self.counted:.2g}", f"{self.choosing:.2g}", str(self.chosen.runs)
        return (self.pair, f"{100.0 * self.target:g}", self.chosen.setting.words, *errors, *times, *beside)


def timed(work: Callable):
    """What it returns, and the processor's seconds."""
    begun = time.process_time()
    found = work()
    return found, time.process_time() - begun


def true_error(found: Answer, known: Reference) -> float:
    """The larger of the judged measures' distances from the reference."""
    return max(distance(found, known.answer, name) for name in JUDGED)


def searched(scene: Scene, known: Reference) -> list[Found]:
    """All that are searched, the cheapest first; gears of a mesh are condensed once."""
    found = []
    counts = STEPS if scene.friction is not None or scene.inertia is not None else STEPS[:1]
    for mesh in MESHES:
        gears = shared_gears(2)
        for setting in (at_sizes(scene, mesh, steps) for steps in counts):
            answer = judged_answer(run_sharing(model_of(setting.of(scene)), gears)[0])
            found.append((counted_seconds(scene, setting), true_error(answer, known), setting))
    return sorted(found, key=lambda each: each[0])


def is_finer(one: Found, other: Found) -> bool:
    """Whether no size of a setting is coarser than another's."""
    return one[2].flank <= other[2].flank and one[2].steps >= other[2].steps


def rows_of(name: str, scene: Scene, not_reached: list[str]) -> list[Row]:
    """All targets of a pair; adds to `not_reached` what the program itself says is not."""
    known, rows = reference(scene), []
    print(f"{name}: reference uncertain by {100.0 * known.uncertainty:.2g} %", flush=True)
    candidates = searched(scene, known)
    for target in TARGETS:
        try:
            chosen, choosing = timed(lambda: choose(scene, target, SilentProgress()))
        except TargetNotReached as reason:
            not_reached.append(f"{name} at {100.0 * target:g} %: {reason}")
            print(f"  {reason}", flush=True)
            continue
        (run, _), seconds = timed(lambda: run_sharing(model_of(chosen.setting.of(scene)), shared_gears()))
        cheapest = [each for each in candidates if each[1] <= target]
        dependable = [
            each for each in cheapest if all(other in cheapest for other in candidates if is_finer(other, each))
        ]
        best = next(iter(cheapest), None), next(iter(dependable), None)
        worth = true_error(judged_answer(run), known), counted_seconds(scene, chosen.setting), choosing / seconds
        rows.append(Row(name, target, chosen, *worth, *best))
        print("  " + " | ".join(rows[-1].cells[1:]), flush=True)
    return rows


def write(rows: list[Row], names: list[str]) -> None:
    """Write rows, and the file's lines of other pairs that are still measured."""
    kept, others = set(names) - {row.pair for row in rows}, []
    if FILE.exists():
        with FILE.open(encoding="utf-8", newline="") as file:
            others = [line for line in list(csv.reader(file))[1:] if line[0] in kept]
    lines = sorted([*others, *(row.cells for row in rows)], key=lambda line: names.index(line[0]))
    with FILE.open("w", encoding="utf-8", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([HEADINGS, *lines])


def main() -> None:
    """Measure, print, after each pair write its lines in place of those that the file has of it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", help="pairs by the beginning of their name")
    parser.add_argument("--seed", type=int, help="other pairs at random, held out, nothing is written")
    options = parser.parse_args()
    for tangential in (False, True):
        compile_kernels(tangential=tangential)
    paper = load_scene(ROOT / "demos/lundvall2004.toml")
    measured = pairs(paper) if options.seed is None else held_out(paper, options.seed)
    rows, not_reached = [], []
    for name, scene in measured.items():
        if options.only is not None and not name.startswith(options.only):
            continue
        rows += rows_of(name, scene, not_reached)
        if options.seed is None:
            write(rows, list(measured))
    print("\n".join(not_reached))


if __name__ == "__main__":
    main()
