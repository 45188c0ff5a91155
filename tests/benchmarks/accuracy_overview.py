"""What accuracy of the paper's scene costs, four times, in one picture and a table of a few lines: from the CSVs of
`accuracy_of_paper`."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter

from fenics_gears.show.panels import DARK, GREY, PALETTE, styled
from fenics_gears.studies.accuracy.report import DEFAULTS, OWN
from fenics_gears.studies.accuracy.table import percent, seconds

TITLES = {
    "quasi_static_friction": "Quasi-static, with friction",
    "quasi_static_frictionless": "Quasi-static, without friction",
    "200_hz_friction": "200 Hz, with friction", "200_hz_frictionless": "200 Hz, without friction",
}  # fmt: skip
TARGETS = (0.01, 0.003, 0.001)
MODEL_MARKS = ("s", "^", "D")


@dataclass(frozen=True)
class Point:
    """A whole setting or a cheaper model: its total error, relative, its time (s), whether it is on the Pareto front
    and what limits it."""

    name: str
    error: float
    time: float
    pays: bool
    limited_by: str
    model: bool


@dataclass(frozen=True)
class Overview:
    """One scene's study; `floor`: the reference's own uncertainty, relative; `timed`: how often every point was."""

    points: tuple[Point, ...]
    floor: float
    machine: dict[str, str]
    timed: int = 1

    @property
    def front(self) -> list[Point]:
        """What pays, the quickest first."""
        return sorted((each for each in self.points if each.pays), key=lambda each: each.time)

    @property
    def own(self) -> Point:
        """The scene's own setting."""
        return next(each for each in self.points if each.name == OWN)

    @property
    def defaults(self) -> Point:
        """The program's default settings."""
        return next(each for each in self.points if each.name == DEFAULTS)

    def cheapest(self, target: float) -> Point | None:
        """What reaches a target in the shortest time; None where nothing does, or the reference cannot tell."""
        return next((each for each in self.front if each.error <= target), None) if target >= self.floor else None


def overview(file: Path) -> Overview:
    """Of a CSV of `gears accuracy`."""
    with open(file, encoding="utf-8", newline="") as opened:
        lines = list(csv.DictReader(opened))
    points = tuple(
        Point(
            line["name"], float(line["total_error"]), float(line["time_s"]), line["on_front"] == "1",
            line["limited_by"], line["kind"] == "model",
        )  # fmt: skip
        for line in lines if line["kind"] in ("setting", "model")
    )  # fmt: skip
    reference = next(line for line in lines if line["kind"] == "reference")
    timed = min(int(line["timed_runs"]) for line in lines if line["kind"] in ("setting", "model"))
    return Overview(
        points,
        float(reference["judged_error"]),
        {name: lines[0][name] for name in ("processor", "load", "threads", "versions")},
        timed,
    )


def table_lines(found: dict[str, Overview]) -> list[str]:
    """The table of docs/evidence/performance.md."""
    headings = [
        "scene",
        *(f"{100 * target:g} % costs" for target in TARGETS),
        "the scene's own settings",
        "their largest error",
        "the default settings",
        "their largest error",
    ]
    lines = [f"| {' | '.join(headings)} |", "|---" * len(headings) + "|"]
    for name, each in found.items():
        given = [
            cell
            for point in (each.own, each.defaults)
            for cell in (f"{percent(point.error)} % in {seconds(point.time)} s", point.limited_by)
        ]
        lines.append(f"| {' | '.join([TITLES[name], *(_cost(each, target) for target in TARGETS), *given])} |")
    return lines


def _cost(each: Overview, target: float) -> str:
    if target < each.floor:
        return f"unknown: the reference is uncertain by {percent(each.floor)} %"
    found = each.cheapest(target)
    return "not reached" if found is None else f"{seconds(found.time)} s ({found.name.partition(', body')[0]})"


@styled
def overview_picture(found: dict[str, Overview]) -> Figure:
    """A panel for each scene, error against time."""
    figure = Figure(figsize=(14.0, 10.0), layout="constrained")
    figure.get_layout_engine().set(w_pad=0.12, h_pad=0.12, rect=(0, 0.095, 1, 0.905))
    panels = figure.subplots(2, 2, sharex=True, sharey=True).ravel()
    for panel, (name, each) in zip(panels, found.items()):
        _panel(panel, each)
        panel.set_title(TITLES[name])
    for panel in panels[2:]:
        panel.set_xlabel("Time of a run (s, median; meshing, condensing, time stepping)")
    figure.supylabel("Relative error (%), the larger of T$_E$ in L$_2$ and T$_{EPP}$", fontsize=12)
    # Each kind of mark once, whichever panels have it.
    marks = {label: handle for panel in panels for handle, label in zip(*panel.get_legend_handles_labels())}
    figure.legend(marks.values(), marks, loc="lower center", ncol=4, bbox_to_anchor=(0.5, 0.03), fontsize=11)
    figure.suptitle("What accuracy of the paper's scene costs in time", x=0.01, ha="left", fontsize=15, color=DARK)
    where = next(iter(found.values())).machine
    figure.text(0.01, 0.008, f"{where['processor']}; {where['versions']}", fontsize=9.5, color=DARK, parse_math=False)
    return figure


def _panel(axes: Axes, found: Overview) -> None:
    others = [each for each in found.points if not (each.pays or each.model or each.name in (OWN, DEFAULTS))]
    if others:
        axes.plot(
            [each.time for each in others],
            [each.error for each in others],
            "o",
            color=GREY,
            markersize=5,
            label="other settings",
        )
    front = found.front
    axes.plot(
        [each.time for each in front], [each.error for each in front], "-o", color=PALETTE[0], label="Pareto front"
    )
    axes.plot(found.own.time, found.own.error, "*", color=PALETTE[1], markersize=16, label="the scene's own")
    axes.plot(found.defaults.time, found.defaults.error, "P", color=PALETTE[3], markersize=11, label="default settings")
    for mark, each in zip(MODEL_MARKS, (each for each in found.points if each.model)):
        axes.plot(each.time, each.error, mark, color=PALETTE[2], markersize=8, label=f"model: {each.name}")
    axes.axhspan(1e-6, found.floor, color=GREY, alpha=0.15, linewidth=0, label="less than the reference's uncertainty")
    axes.set_xscale("log")
    axes.set_yscale("log")
    # Errors of the models reach 100 %; above is room for the words.
    axes.set_ylim(1e-4, 80.0)
    for target in TARGETS:
        axes.axhline(
            target,
            color=GREY,
            linestyle=":",
            linewidth=1.0,
            label="targets: " + ", ".join(f"{100 * each:g} %" for each in TARGETS),
        )
    # The corner that a falling front leaves free.
    axes.text(
        0.98, 0.97, "\n".join(_words(found, target) for target in TARGETS), transform=axes.transAxes, ha="right",
        va="top", fontsize=10.5,
        color=DARK, linespacing=1.5, bbox={"facecolor": "white", "edgecolor": "#E3E3E3", "alpha": 0.9, "pad": 5.0},
    )  # fmt: skip
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{100 * value:g}"))


def _words(found: Overview, target: float) -> str:
    reached = found.cheapest(target)
    if reached:
        return f"{100 * target:g} %: {seconds(reached.time)} s, limited by the {reached.limited_by}"
    return f"{100 * target:g} %: " + (
        "not reached by these settings" if target >= found.floor else "below the reference's uncertainty"
    )


def orders_section(files: dict[str, Path]) -> str:
    """A table of the orders of T_E, and the error of T_E at the finest value, of each setting in each scene; `files`:
    their CSVs."""
    cells: dict[str, dict[str, str]] = {}
    for scene, file in files.items():
        with open(file, encoding="utf-8", newline="") as opened:
            lines = [
                line for line in csv.DictReader(opened) if line["kind"] == "single setting" and line["order_expected"]
            ]
        for line in lines:
            # The finest value comes last.
            error, order = float(line["error_T_E"]), line["order_T_E"]
            cells.setdefault(line["name"], {})[scene] = (
                f"{f'{float(order):.1f}' if order else 'none'}; {percent(error)}"
            )
            cells[line["name"]]["expected"] = f"{float(line['order_expected']):g}"
    headings = ["setting", "expected", *(TITLES[scene] for scene in files)]
    rows = [[name, row["expected"], *(row.get(scene, "-") for scene in files)] for name, row in cells.items()]
    return "\n".join([f"|{'|'.join(row)}|" for row in (headings, ["---"] * len(headings), *rows)])


def overview_section(found: dict[str, Overview]) -> str:
    """Picture and table."""
    machine = next(iter(found.values())).machine
    loads = ", ".join(each.machine["load"] for each in found.values())
    return "\n".join([
        "![What accuracy of the paper's scene costs in time](../pictures/accuracy.png)", "", *table_lines(found), "",
        "Errors are [total errors](accuracy.md#how-errors-are-measured), the larger of those of T_E and of T_EPP. "
        "Times are medians of "
        f"{min(each.timed for each in found.values())} runs. {machine['processor']}, load {loads}; threads: "
        f"{machine['threads']}; {machine['versions']}.",
    ])  # fmt: skip
