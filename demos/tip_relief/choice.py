"""Tip relief for the least transmission error: measure, draw, write the table. Called by `run`."""

from __future__ import annotations

import sys
import time
from dataclasses import replace
from pathlib import Path

from demos.arguments import output_directory

PICTURES = ("tip_relief.png", "tip_relief_harris_map.png")
TABLE = "tip_relief.md"


def main(arguments: list[str] | None = None) -> int:
    """Measure, draw, write; returns 0."""
    directory = output_directory(
        "tip_relief",
        "Tip relief of the paper's gears, chosen for the least transmission error with friction and without.",
        arguments,
    )
    begun = time.perf_counter()
    for file in measured(directory):
        print(file)
    _say(f"done after {time.perf_counter() - begun:.0f} s")
    return 0


def measured(directory: Path) -> list[Path]:
    """Everything of this demonstration, written into a directory."""
    from demos.tip_relief import findings, pictures
    from demos.tip_relief.design import LINEAR, Bench, conditions, paper_scene
    from demos.tip_relief.table import table
    from fenics_gears.system.output import written_aside
    from fenics_gears.show.plots import save_figure
    from fenics_gears.runs.gear_store import GearStore

    store = GearStore()
    benches = {name: Bench(scene, store) for name, scene in conditions(paper_scene()).items()}
    teeth_alone = Bench(replace(benches[findings.STIFF].scene, friction=None), store)
    _say("maps over depth and length")
    maps = {name: findings.relief_map(benches[name]) for name in findings.DRAWN}
    _say("best reliefs")
    optima = findings.optima(benches)
    best = {name: optima[name, LINEAR] for name in findings.DRAWN}
    designs = findings.compared(best["μ = 0"].design)
    _say("other loads")
    torques = benches["μ = 0"].torque(findings.LOADS)
    over_load = {
        (name, design): left
        for name in findings.DRAWN
        for design, left in findings.over_load(benches[name], designs).items()
    }
    curves = {
        (name, which): benches[name].error(designs[which])
        for name in findings.DRAWN
        for which in ("true involutes", "best relief")
    }
    with written_aside(directory, written := []) as aside:
        save_figure(pictures.draw_choice(maps, best, curves, (torques, over_load)), aside / PICTURES[0])
        save_figure(pictures.draw_harris_map(teeth_alone, designs), aside / PICTURES[1])
        (aside / TABLE).write_text(table(benches, teeth_alone, optima, designs), encoding="utf-8")
    return written


def _say(words: str) -> None:
    print(words, file=sys.stderr, flush=True)


if __name__ == "__main__":
    sys.exit(main())
