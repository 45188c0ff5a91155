"""The best tip relief by `gears optimize` and by brute force, with friction and without, with tolerances and without.
Called by `run`."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from demos.arguments import output_directory
from fenics_gears.extensions.optimization.conditions import samples
from fenics_gears.extensions.optimization.evaluations import Evaluation, Evaluator
from fenics_gears.extensions.optimization.optimize import SearchOutcome, optimize
from fenics_gears.runs.team import Alone
from fenics_gears.system.progress import Interruption
from fenics_gears.system.progress import LineProgress

HERE = Path(__file__).parent
NAMES = {
    "frictionless": "Without friction", "friction": "With friction, μ = 0.1",
    "frictionless_tolerances": "Without friction, nine of ten pairs within tolerances",
    "friction_tolerances": "With friction, nine of ten pairs within tolerances",
}  # fmt: skip
DEPTH, LENGTH, ERROR = "tip_relief.depth", "tip_relief.length_on_path", "peak_to_peak_transmission_error"
DEPTHS, LENGTHS = np.linspace(5.0, 50.0, 10), np.linspace(3.0, 9.0, 9)
PICTURE, TABLE = "best_relief.png", "best_relief.md"


@dataclass(frozen=True)
class Compared:
    """What was found, and the goal (depths, lengths), um, of all reliefs of a grid."""

    found: SearchOutcome
    depths: np.ndarray
    lengths: np.ndarray
    map: np.ndarray

    @property
    def least_of_map(self) -> tuple[float, float, float]:
        """Depth (um), length (mm) and goal (um) of the best relief of the grid."""
        row, column = np.unravel_index(np.argmin(self.map), self.map.shape)
        return self.depths[row], self.lengths[column], self.map[row, column]


def main(arguments: list[str] | None = None) -> int:
    """Search, map, draw, write; returns 0."""
    directory = output_directory(
        "best_relief",
        "The best tip relief with friction and tolerances and without, by gears optimize and by brute force.",
        arguments,
    )
    for file in written({name: compared(HERE / f"{name}.toml", directory / name) for name in NAMES}, directory):
        print(file)
    return 0


def compared(
    design: Path, directory: Path, depths: Sequence[float] = DEPTHS, lengths: Sequence[float] = LENGTHS
) -> Compared:
    """The search of a design file, and the map of its goal over a grid; a second call finds the runs of the first."""
    print(f"{design.stem}:", file=sys.stderr)
    found = optimize(design, directory, LineProgress())
    with Interruption(LineProgress()) as progress:
        progress.stage("map")
        evaluator = Evaluator(found.design, directory / "runs", Alone(), progress)
        grid = [{DEPTH: float(depth), LENGTH: float(length)} for depth in depths for length in lengths]
        goals = [each.goals[ERROR] for each in evaluator.of_designs(grid, samples(found.design))]
    return Compared(found, np.asarray(depths), np.asarray(lengths), np.reshape(goals, (len(depths), len(lengths))))


def written(every: dict[str, Compared], directory: Path) -> list[Path]:
    """The picture and the table of what was compared, by the names of the design files."""
    from demos.best_relief.picture import drawn
    from fenics_gears.show.plots import save_figures
    from fenics_gears.system.output import write_whole

    pictures = save_figures({PICTURE: drawn({NAMES[name]: each for name, each in every.items()})}, directory)
    return [*pictures, write_whole(directory / TABLE, lambda aside: aside.write_text(table(every), encoding="utf-8"))]


def table(every: dict[str, Compared]) -> str:
    """Markdown: a row for each search, and what reliefs give under conditions that they were not chosen for."""
    rows = [
        (
            "| condition | best depth (um) | best length (mm) | goal (um) | best of the grid (um) | goal before (um) |"
            " designs |"
        ),
        "|---|---|---|---|---|---|---|",
    ]
    for name, each in every.items():
        values, found = each.found.chosen.values, each.found
        rows.append(
            f"| {NAMES[name]} | {values[DEPTH]:.1f} | {values[LENGTH]:.2f} | {found.chosen.goals[ERROR]:.2f} |"
            f" {each.least_of_map[2]:.2f} | {found.before.goals[ERROR]:.2f} | {len(found.tried)} |"
        )
    return "\n".join([*rows, "", *_exchanged(every)]) + "\n"


def _exchanged(every: dict[str, Compared]) -> list[str]:
    """What a relief that was chosen under other conditions gives, beside the one that was chosen for these; both under
    samples that neither search knew."""
    rows = [
        "| conditions | relief chosen for | goal (um) | goal of the relief chosen for these conditions (um) |",
        "|---|---|---|---|",
    ]
    for chosen, judged in (
        ("frictionless", "friction"),
        ("frictionless", "frictionless_tolerances"),
        ("friction", "friction_tolerances"),
    ):
        if {chosen, judged} <= set(every):
            other, own = (
                f"{each.goals[ERROR]:.2f}"
                for each in fresh(every[judged].found, [every[name].found.chosen.values for name in (chosen, judged)])
            )
            rows.append(f"| {NAMES[judged]} | {NAMES[chosen].lower()} | {other} | {own} |")
    return rows


def fresh(found: SearchOutcome, reliefs: Sequence[dict[str, float]]) -> list[Evaluation]:
    """Reliefs under the conditions of a search, but under other samples of its tolerances than it was judged by."""
    with Interruption(LineProgress()) as progress:
        progress.stage("fresh samples")
        return Evaluator(found.design, found.directory / "runs", Alone(), progress).of_designs(
            reliefs, samples(found.design, fresh=True)
        )


if __name__ == "__main__":
    sys.exit(main())
