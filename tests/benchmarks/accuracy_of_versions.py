"""Error against time of the same settings in two versions of the program: `python -m
tests.benchmarks.accuracy_of_versions OTHER_CHECKOUT [SCENE ...]`.

Runs SETTINGS of the paper's scene (scenes as in `accuracy_of_paper`) in this checkout and in another one, in turns and
without the cache, and compares both with this version's reference. Errors are those of T_E (L2 at common steps, mean
removed) and of T_EPP. Writes the picture docs/pictures/accuracy_versions.png, the numbers beside it, and the section of
docs/evidence/accuracy.md.
"""

from __future__ import annotations

import argparse
import csv
import json
import os
import statistics
import subprocess
import sys
import tempfile
from dataclasses import asdict, dataclass
from itertools import product
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator
from tests.benchmarks.accuracy_of_paper import PAGE, PICTURES, markers, scenes
from tests.benchmarks.accuracy_overview import TITLES
from tests.benchmarks.marked_section import write_section

from fenics_gears.scene.data import Scene
from fenics_gears.scene.defaults import NODE_SPACING
from fenics_gears.show.panels import DARK, GREY, PALETTE, styled
from fenics_gears.studies.accuracy.measures import CURVE, SPAN, distance
from fenics_gears.studies.accuracy.refinement import BODY, FAMILY, LENGTH, STEPS
from fenics_gears.studies.accuracy.report import AccuracyStudy
from fenics_gears.studies.accuracy.setting import Setting, half_width
from fenics_gears.studies.accuracy.table import percent, seconds
from fenics_gears.studies.accuracy.whole import pareto_front
from fenics_gears.studies.machine import machine
from fenics_gears.system.progress import LineProgress

HERE = Path(__file__).resolve().parents[2]
FILE = PICTURES / "accuracy_versions"
# Flank elements in a half-width, steps per mesh cycle; all with half the default contact window, in which all contact
# is.
ELEMENTS, STEP_COUNTS, WINDOW = (1.0, 2.0, 4.0), (20, 40, 80, 160, 320), 0.5
TARGETS = (0.01, 0.005, 0.002, 0.001)
OLD, NEW = "before", "now"
# Runs in either checkout. Settings come by standard input; prints the curve (mm), T_EPP (mm) and the time (s) of each.
# The first run, which compiles, is not counted.
RUN = """
import json, sys
from dataclasses import replace
from fenics_gears.scene.data import Accuracy, Motion
from fenics_gears.scene.read import load_scene
from fenics_gears.studies.accuracy.runs import run_sharing, shared_gears
given = json.load(sys.stdin)
scene = load_scene(given["scene"])
if given["quasi_static"]:
    scene = replace(scene, inertia=None, damping=None, motion=Motion(200.0, 2, 1))
if given["frictionless"]:
    scene = replace(scene, friction=None)
for place, accuracy in enumerate([given["settings"][0], *given["settings"]]):
    run, _ = run_sharing(replace(scene, accuracy=Accuracy(**accuracy)), shared_gears())
    radius, steps = run.attrs["base_radius_wheel"], accuracy["steps_per_mesh_cycle"]
    curve = [radius * each for each in run["transmission_error"].values[-steps:].tolist()]
    height = radius * run.attrs["peak_to_peak_transmission_error"]
    if place:
        time = sum(run.attrs[f"time_{stage}"] for stage in ("mesh", "condense", "march"))
        print(json.dumps([curve, height, time]), flush=True)
"""


@dataclass(frozen=True)
class Point:
    """A setting in one version: relative errors of T_E and T_EPP, median time (s)."""

    scene: str
    version: str
    setting: str
    curve: float
    height: float
    time: float
    rounds: int

    @property
    def error(self) -> float:
        """The larger of both errors."""
        return max(self.curve, self.height)


def settings(scene: Scene, window: float) -> list[Setting]:
    """Every number of elements with every number of steps; `window`: the default one, mm."""
    flanks = [half_width(scene) / each for each in ELEMENTS]
    return [
        Setting("P2", flank, NODE_SPACING * flank, WINDOW * window, 1.0, steps)
        for flank, steps in product(flanks, STEP_COUNTS)
    ]


def reference(scene: Scene) -> tuple[dict[str, np.ndarray], float, float]:
    """The reference of this version, its relative uncertainty, and the length of the default contact window, mm."""
    progress = LineProgress()
    study = AccuracyStudy(scene, progress, quick=False, rounds=1)
    study.refinements = tuple(each for each in study.refinements if each.name in (FAMILY, BODY, STEPS, LENGTH))
    value, uncertainty = study.reference(study.refine())
    progress.close()
    return value, max(uncertainty[CURVE], uncertainty[SPAN]), study.base.length


def run(checkout: Path, name: str, chosen: list[Setting], module: float) -> list[tuple[np.ndarray, float, float]]:
    """Curve (n,), mm, T_EPP, mm, and time, s, of settings, by a checkout."""
    given = {
        "scene": str(HERE / "demos" / "lundvall2004.toml"), "quasi_static": name.startswith("quasi_static"),
        "frictionless": name.endswith("frictionless"),
        "settings": [asdict(each.accuracy(module)) for each in chosen],
    }  # fmt: skip
    with tempfile.TemporaryDirectory() as directory:
        environment = {**os.environ, "PYTHONPATH": str(checkout)}
        ran = subprocess.run(
            [sys.executable, "-P", "-c", RUN],
            input=json.dumps(given),
            capture_output=True,
            text=True,
            check=True,
            env=environment,
            cwd=directory,
        )
    return [(np.array(curve), height, time) for curve, height, time in map(json.loads, ran.stdout.splitlines())]


def points(name: str, other: Path, rounds: int) -> tuple[list[Point], float]:
    """All settings in both versions, in turns, and the uncertainty of their reference."""
    scene = scenes()[name]
    exact, uncertainty, window = reference(scene)
    chosen, answers, times = settings(scene, window), {}, {OLD: [], NEW: []}
    for _ in range(rounds):
        for version, checkout in ((OLD, other), (NEW, HERE)):
            answers[version] = run(checkout, name, chosen, scene.gears.module)
            times[version].append([time for _, _, time in answers[version]])
    found = []
    for version, ran in answers.items():
        for place, (setting, (curve, height, _)) in enumerate(zip(chosen, ran)):
            answer = {CURVE: curve - curve.mean(), SPAN: np.array([height])}
            median = statistics.median(each[place] for each in times[version])
            found.append(
                Point(
                    name,
                    version,
                    setting.words,
                    *(distance(answer, exact, measure) for measure in (CURVE, SPAN)),
                    median,
                    rounds,
                )
            )
    return found, uncertainty


def front(found: list[Point], name: str, version: str) -> list[Point]:
    """The Pareto front of a scene in a version, the quickest first."""
    own = [each for each in found if (each.scene, each.version) == (name, version)]
    return [own[place] for place in pareto_front([(each.time, each.error) for each in own])]


def cost(found: list[Point], name: str, version: str, target: float) -> str:
    """What a target costs in words."""
    reached = [each for each in front(found, name, version) if each.error <= target]
    return (
        f"{seconds(reached[0].time)} s"
        if reached
        else f"not reached, {percent(front(found, name, version)[-1].error)} % at best"
    )


@styled
def picture(found: list[Point], floors: dict[str, float], where: dict[str, str]) -> Figure:
    """A panel for each scene: all settings and the Pareto front of both versions."""
    figure = Figure(figsize=(max(7.2 * len(floors), 10.5), 6.2), layout="constrained")
    figure.get_layout_engine().set(w_pad=0.12, h_pad=0.12, rect=(0, 0.06, 1, 0.94))
    for axes, (name, floor) in zip(figure.subplots(1, len(floors), squeeze=False, sharey=True).ravel(), floors.items()):
        for version, colour, mark in ((OLD, GREY, "s"), (NEW, PALETTE[0], "o")):
            own, best = (
                [each for each in found if (each.scene, each.version) == (name, version)],
                front(found, name, version),
            )
            axes.plot(
                [each.time for each in own], [each.error for each in own], mark, color=colour, markersize=5, alpha=0.45
            )
            axes.plot(
                [each.time for each in best],
                [each.error for each in best],
                "-" + mark,
                color=colour,
                markersize=7,
                label=version,
            )
        axes.axhspan(1e-6, floor, color=GREY, alpha=0.15, linewidth=0, label="less than the reference's uncertainty")
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.set_ylim(1e-4, 0.3)
        axes.xaxis.set_minor_locator(LogLocator(subs=(2, 5)))
        axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axes.xaxis.set_minor_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{100 * value:g}"))
        axes.set_title(TITLES[name])
        axes.set_xlabel("Time of a run (s, median; meshing, condensing, time stepping)")
        axes.legend(loc="upper right")
    figure.axes[0].set_ylabel("Relative error (%), the larger of T$_E$ in L$_2$ and T$_{EPP}$")
    figure.suptitle(
        "The same settings before and now: error against time; lines: Pareto fronts",
        x=0.01,
        ha="left",
        fontsize=14,
        color=DARK,
    )
    figure.text(
        0.01,
        0.012,
        f"{where['processor']}, load {where['load']}; {where['versions']}",
        fontsize=9.5,
        color=DARK,
        parse_math=False,
    )
    return figure


def section(found: list[Point], floors: dict[str, float], where: dict[str, str], revision: str) -> str:
    """Picture and table."""
    lines = [
        "|scene|version|" + "|".join(f"{100 * target:g} % costs" for target in TARGETS) + "|reference uncertain by, %|",
        "|---" * (len(TARGETS) + 3) + "|",
    ]
    for name, floor in floors.items():
        for version in (OLD, NEW):
            costs = "|".join(cost(found, name, version, target) if target >= floor else "unknown" for target in TARGETS)
            lines.append(f"|{TITLES[name]}|{version}|{costs}|{percent(floor)}|")
    return "\n".join([
        "![Error against time before and now](../pictures/accuracy_versions.png)", "", *lines, "",
        f"{len(ELEMENTS) * len(STEP_COUNTS)} settings: {', '.join(f'{each:g}' for each in ELEMENTS)} flank elements "
        f"in a half-width, "
        f"{', '.join(map(str, STEP_COUNTS))} steps. Errors are distances from the reference, the larger of T_E and "
        f"T_EPP; before: revision {revision}. "
        f"Times are medians of {found[0].rounds} in turns. {where['processor']}, load {where['load']}; "
        f"{where['versions']}. "
        "All numbers: [accuracy_versions.csv](../pictures/accuracy_versions.csv).",
    ])  # fmt: skip


def main() -> None:
    """Measure, write picture, numbers and section as soon as a scene is there."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("other", type=Path, help="checkout of the other version")
    parser.add_argument("names", nargs="*", default=["quasi_static_friction", "200_hz_friction"], help="of scenes")
    parser.add_argument("--rounds", type=int, default=5)
    options = parser.parse_args()
    revision = subprocess.run(
        ["git", "-C", options.other, "rev-parse", "--short", "HEAD"], capture_output=True, text=True, check=True
    ).stdout.strip()
    found, floors = [], {}
    for name in options.names:
        more, floors[name] = points(name, options.other.resolve(), options.rounds)
        found += more
        write(found, floors, revision)


def write(found: list[Point], floors: dict[str, float], revision: str) -> None:
    """Picture, numbers and section of the scenes so far."""
    from fenics_gears.show.plots import save_figure

    where = machine()
    save_figure(picture(found, floors, where), FILE.with_suffix(".png"))
    with open(FILE.with_suffix(".csv"), "w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, list(asdict(found[0])))
        writer.writeheader()
        writer.writerows(map(asdict, found))
    write_section(PAGE, *markers("two versions"), section(found, floors, where, revision))


if __name__ == "__main__":
    main()
