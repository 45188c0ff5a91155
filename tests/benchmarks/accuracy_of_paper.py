"""What accuracy of the paper's scene costs, into docs/evidence/accuracy.md and docs/evidence/performance.md: `python -m
tests.benchmarks.accuracy_of_paper`.

Runs what `gears accuracy` runs on demos/lundvall2004.toml quasi-static and at 200 Hz, with friction and without; writes
each one's tables between its two markers, its picture to docs/pictures/ and all its numbers beside it as CSV; then, of
all four together, a picture and a table into docs/evidence/performance.md, and the orders of all four into
docs/evidence/accuracy.md.
Times are this machine's; errors must not change. Names of scenes as arguments run those alone.
"""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path

from tests.benchmarks.accuracy_overview import TITLES, orders_section, overview, overview_picture, overview_section
from tests.benchmarks.accuracy_saved import saved_report
from tests.benchmarks.marked_section import write_section

from fenics_gears.scene.data import Motion, Output, Scene
from fenics_gears.scene.read import load_scene
from fenics_gears.simulation.warm_up import compile_kernels
from fenics_gears.studies.accuracy import table
from fenics_gears.studies.accuracy.report import AccuracyReport, measure, scene_of
from fenics_gears.studies.accuracy.runs import Times, run_sharing, shared_gears
from fenics_gears.studies.machine import machine
from fenics_gears.system.progress import LineProgress, Progress

ROOT = Path(__file__).parents[2]
SCENE, PICTURES, EVIDENCE = ROOT / "demos" / "lundvall2004.toml", ROOT / "docs" / "pictures", ROOT / "docs" / "evidence"
PAGE, OVERVIEW = EVIDENCE / "accuracy.md", EVIDENCE / "performance.md"


def scenes() -> dict[str, Scene]:
    """The paper's scene four times."""
    fast = load_scene(SCENE)
    slow = replace(fast, inertia=None, damping=None, motion=Motion(200.0, 2, 1))
    found = {"200_hz_friction": fast, "quasi_static_friction": slow}
    found |= {name.replace("friction", "frictionless"): replace(each, friction=None) for name, each in found.items()}
    return found


def markers(name: str) -> tuple[str, str]:
    """The lines of the page between which a scene's section stands."""
    return f"<!-- accuracy, {name}: begin -->", f"<!-- accuracy, {name}: end -->"


def section(name: str, report: AccuracyReport) -> str:
    """The sentence, the picture, both tables and the remarks."""
    own = ["|".join(["", *cells, ""]) for cells in ((_with_units(*table.headings(report))), *table.table_rows(report))]
    own.insert(1, "|---" * len(table.headings(report)[0]) + "|")
    whole = [
        "|".join(["", *cells, ""]) for cells in (_with_units(*table.whole_headings(report)), *table.whole_rows(report))
    ]
    whole.insert(1, "|---" * len(table.whole_headings(report)[0]) + "|")
    where = report.machine
    measured = (
        f"{table.timed(report)} {where['processor']}, load {where['load']}; threads: {where['threads']};"
        f" {where['versions']}."
    )
    remarks = [
        f"* {remark}"
        for remark in (*table.remarks(report), *(f"not run: {what}: {why}" for what, why in report.failures))
    ]
    return "\n".join([
        f"**{table.in_one_sentence(report)}**", "", f"![](../pictures/accuracy_{name}.png)", "",
        f"Combinations of settings, and cheaper models; \\* on the Pareto front. All numbers: "
        f"[accuracy_{name}.csv](../pictures/accuracy_{name}.csv).",
        "",
        *(line.replace(" *|", " \\*|") for line in whole), "",
        f"Each setting alone, the others at {report.fine.words}:", "", *own, "", *remarks, "", measured,
    ])  # fmt: skip


def _with_units(headings, units) -> tuple[str, ...]:
    return tuple(f"{heading}, {unit}" if unit else heading for heading, unit in zip(headings, units))


def main() -> None:
    """Measure, write pictures, numbers and the page's sections, each as soon as it is there."""
    from fenics_gears.show.plots import save_figure
    from fenics_gears.show.work_precision import work_precision

    all_scenes = scenes()
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", default=list(all_scenes), help="of scenes; all unless given")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument(
        "--timing-seconds",
        type=float,
        default=300.0,
        help="for each scene, on single settings run again for their times",
    )
    parser.add_argument(
        "--write-again",
        action="store_true",
        help="all pictures, and the table of docs/evidence/performance.md, from what is saved, without measuring",
    )
    parser.add_argument(
        "--times-again",
        action="store_true",
        help="time the combinations and models that are saved, and keep all errors",
    )
    options = parser.parse_args()
    for name in options.names:
        print(name, flush=True)
        saved = PICTURES / f"accuracy_{name}.csv"
        if options.write_again:
            save_figure(work_precision(saved_report(all_scenes[name], saved)), saved.with_suffix(".png"))
            continue
        progress = LineProgress()
        if options.times_again:
            report = timed_again(saved_report(all_scenes[name], saved), options.rounds, progress)
        else:
            report = measure(
                all_scenes[name], progress, rounds=options.rounds, seconds_on_single=options.timing_seconds
            )
        progress.close()
        save_figure(work_precision(report), saved.with_suffix(".png"))
        table.write_csv(report, saved)
        write_section(PAGE, *markers(name), section(name, report))
    write_overview()


def timed_again(report: AccuracyReport, rounds: int, progress: Progress) -> AccuracyReport:
    """A report whose combinations and models are run `rounds` times in turns, and all else is kept."""
    chosen = [*report.settings, *report.models]
    times = {each.name: Times() for each in chosen}
    compile_kernels(report.scene.friction is not None)
    progress.stage("times")
    for turn in range(rounds):
        for place, each in enumerate(chosen):
            progress.update(turn * len(chosen) + place, rounds * len(chosen), each.name)
            scene = replace(scene_of(report.scene, each.name, each.setting), output=Output())
            times[each.name] = times[each.name].and_also(run_sharing(scene, shared_gears())[0])
    settings, models = (
        tuple(replace(each, times=times[each.name]) for each in group) for group in (report.settings, report.models)
    )
    return replace(report, settings=settings, models=models, rounds=rounds, machine=machine())


def write_overview() -> None:
    """All scenes together, from what is saved of them, into docs/evidence/performance.md; the orders of all into
    docs/evidence/accuracy.md."""
    from fenics_gears.show.plots import save_figure

    found = {name: overview(PICTURES / f"accuracy_{name}.csv") for name in TITLES}
    save_figure(overview_picture(found), PICTURES / "accuracy.png")
    write_section(OVERVIEW, *markers("of the paper's scene"), overview_section(found))
    write_section(
        PAGE, *markers("orders"), orders_section({name: PICTURES / f"accuracy_{name}.csv" for name in TITLES})
    )


if __name__ == "__main__":
    main()
