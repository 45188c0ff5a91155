"""What the effects of the paper's scene cost and change, into docs/evidence/performance.md: `python -m
tests.benchmarks.effects_of_paper`.

Runs `gears effects` on demos/lundvall2004.toml, writes its table between two markers of that page and its picture to
docs/pictures/effects.png. Times are this machine's; T_EPP and forces must not change.
"""

from __future__ import annotations

import statistics
from pathlib import Path

from fenics_gears.scene.read import load_scene
from fenics_gears.studies.effect_lattice import table
from fenics_gears.studies.effect_lattice.measured import EffectReport, measure
from fenics_gears.studies.effect_lattice.subsets import ALL, BARE
from fenics_gears.system.progress import LineProgress

ROOT = Path(__file__).parents[2]
SCENE, PAGE, PICTURE = (
    ROOT / "demos" / "lundvall2004.toml",
    ROOT / "docs" / "evidence" / "performance.md",
    ROOT / "docs" / "pictures" / "effects.png",
)
BEGIN, END = "<!-- effects of the paper's scene: begin -->", "<!-- effects of the paper's scene: end -->"


def section(report: EffectReport) -> str:
    """The table and the sentences below it."""
    headings = (
        "effects",
        "unknowns",
        "closed nodes (most)",
        "Newton iterations per step",
        "time per step, us",
        "condensing, s",
        "T_EPP, um",
        "peak force, N",
    )
    lines = [f"| {' | '.join(headings)} |", "|---" * len(headings) + "|"]
    lines += [f"| {' | '.join((*cells[:5], *cells[6:9]))} |" for cells in table.table_rows(report)]
    where = report.machine
    measured = (
        f"Measured on {where['processor']}, load {where['load']}; threads: {where['threads']}; {where['versions']}."
    )
    return "\n".join([*lines, "", _ratio(report), measured])


def _ratio(report: EffectReport) -> str:
    """Bare against full scene, measured and expected."""
    bare, full, ratios = report.row(BARE), report.row(ALL), report.ratios
    return (
        f"Bare (frictionless, quasi-static, rigid shafts and bearings) against all: {bare.unknowns:.0f} against"
        f" {full.unknowns:.0f} unknowns, {bare.step_time * 1e6:.0f} against {full.step_time * 1e6:.0f} us a step, ratio"
        f" {statistics.median(ratios):.1f} ({min(ratios):.1f} to {max(ratios):.1f} in {len(ratios)} rounds). Expected:"
        f" {full.operations / bare.operations:.1f} from the count of operations alone; but a step of so few unknowns"
        " takes most of its time whatever their number."
    )


def main() -> None:
    """Measure, write the picture and the page's section."""
    from fenics_gears.show.effect_costs import effect_costs
    from fenics_gears.show.plots import save_figure

    before, marker, rest = PAGE.read_text(encoding="utf-8").partition(BEGIN)
    _, end, after = rest.partition(END)
    if not (marker and end):
        raise SystemExit(f"{PAGE}: the lines {BEGIN} and {END} are missing; put them where the table shall stand")
    progress = LineProgress()
    report = measure(load_scene(SCENE), progress)
    progress.close()
    save_figure(effect_costs(report), PICTURE)
    PAGE.write_text(f"{before}{BEGIN}\n\n{section(report)}\n\n{END}{after}", encoding="utf-8")
    print(section(report))


if __name__ == "__main__":
    main()
