"""The picture of `gears effects`: cost and change of each effect, a line for each subset of the scene's effects."""

import textwrap

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from fenics_gears import Scene
from fenics_gears.charts import DARK, GREY, PALETTE, conditions, styled

from ..machine import in_words
from .measured import EffectReport, MeasuredRow
from .subsets import ALL, ALONE, BARE, LEFT_OUT
from .table import MICRO, MILLI, change, in_percent, own_remarks

COLOURS = {BARE: DARK, ALONE: PALETTE[2], LEFT_OUT: PALETTE[1], ALL: DARK}
# What colours of bars and styles of lines stand for, by the rows that have them.
WORDS = {
    ALONE: "green bars: bare scene and one effect (change from bare)",
    LEFT_OUT: "orange bars: all effects but one (change from all)",
    BARE: "dotted line: bare scene",
    ALL: "dashed line: all effects",
}
LINE_HEIGHT = 0.36
OF_FACE = {"face_load_factor": "K$_{Hβ}$", "peak_pressure": "Peak pressure (MPa)"}
LABEL = {
    "xytext": (5, 0),
    "textcoords": "offset points",
    "va": "center",
    "fontsize": 10.5,
    "bbox": {"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 0.4},
}


@styled
def effect_costs(report: EffectReport) -> Figure:
    """Unknowns and time of a step on the left, transmission error and peak force on the right."""
    rows = report.rows
    # Less leaves no room between heading and footnotes.
    height = max(2.8 + LINE_HEIGHT * len(rows), 4.6)
    figure = Figure(figsize=(15.0, height), layout="constrained")
    # Room for three lines below.
    figure.get_layout_engine().set(w_pad=0.1, h_pad=0.1, rect=(0, 0.6 / height, 1, 1 - 0.6 / height))
    panels = [(name, OF_FACE[name]) for name in report.of_face]
    figure.set_figwidth(15.0 + 3.4 * len(panels))
    widths = (1.0, *[1.1] * (3 + len(panels)))
    axes = figure.subplots(1, len(widths), sharey=True, gridspec_kw={"width_ratios": widths})
    places = _places(rows)
    _unknowns(axes[0], rows, places)
    _bars(axes[1], report, places, "step_time", MICRO, "Time per step (µs, median)")
    _whiskers(axes[1], rows, places)
    _bars(axes[2], report, places, "transmission_error", MILLI, "T$_{EPP}$ (µm)")
    _bars(axes[3], report, places, "peak_force", 1.0, "Peak contact force (N)")
    for panel, (name, title) in zip(axes[4:], panels):
        _bars(panel, report, places, name, 1.0, title)
    axes[0].set_yticks(places, [row.subset.name + ("*" if own_remarks(report, row) else "") for row in rows])
    axes[0].set_ylim(max(places) + 0.8, -0.8)
    for panel in axes:
        panel.grid(axis="y", visible=False)
        panel.tick_params(axis="y", length=0)
        panel.spines["right"].set_visible(False)
    _words(figure, report)
    return figure


def _places(rows: tuple[MeasuredRow, ...]) -> np.ndarray:
    steps = [0.0] + [1.0 if before.subset.kind == row.subset.kind else 1.5 for before, row in zip(rows, rows[1:])]
    return np.cumsum(steps)


def _unknowns(axes: Axes, rows: tuple[MeasuredRow, ...], places: np.ndarray) -> None:
    centres = np.array([row.coordinates for row in rows])
    contact = np.array([row.contact_rows for row in rows])
    axes.barh(places, centres, color=PALETTE[0], label="centre coordinates", height=0.7)
    axes.barh(places, contact, left=centres, color=PALETTE[4], label="contact forces", height=0.7)
    for place, total in zip(places, centres + contact):
        axes.annotate(f"{total:.0f}", (total, place), **LABEL)
    axes.set_xlim(0, 1.15 * (centres + contact).max())
    axes.set_title("Unknowns")
    below = (0.5, -0.45 / (LINE_HEIGHT * len(rows)))
    axes.legend(loc="upper center", bbox_to_anchor=below, ncol=2, handlelength=1.2, columnspacing=1.0, fontsize=10.5)


def _bars(axes: Axes, report: EffectReport, places: np.ndarray, name: str, factor: float, title: str) -> None:
    """One number of every row that has it, with its change, and the bare and the full scene's as lines."""
    rows = report.rows
    values = np.nan_to_num([getattr(row, name) * factor for row in rows])
    axes.barh(places, values, color=[COLOURS.get(row.subset.kind, GREY) for row in rows], height=0.7)
    for kind, style in ((BARE, ":"), (ALL, "--")):
        row = report.row(kind)
        if row is not None and not np.isnan(getattr(row, name)):
            axes.axvline(getattr(row, name) * factor, color=GREY, linestyle=style, linewidth=1.2, zorder=0.5)
    ends = np.array([max(row.step_times) for row in rows]) * factor if name == "step_time" else values
    for place, value, end, row in zip(places, values, ends, rows):
        changed = change(report, row, name)
        words = "none" if np.isnan(getattr(row, name)) else _number(value, values.max())
        axes.annotate(words + ("" if changed is None else f"  {in_percent(changed)}"), (end, place), **LABEL)
    axes.set_xlim(0, 1.8 * max(ends.max(), 1e-300))
    axes.set_title(title)


def _number(value: float, largest: float) -> str:
    """A value with three digits or more; round-off of the largest is zero."""
    if abs(value) < 1e-9 * abs(largest):
        return "0"
    return f"{value:,.0f}" if value >= 1e3 else f"{value:.3g}"


def _whiskers(axes: Axes, rows: tuple[MeasuredRow, ...], places: np.ndarray) -> None:
    least, most = (np.array([of(row.step_times) for row in rows]) * MICRO for of in (min, max))
    axes.hlines(places, least, most, color=GREY, linewidth=1.6)


def measured_heading(figure: Figure, what: str, scene: Scene) -> None:
    """What was measured of a scene, its title and its conditions, above a figure."""
    title = textwrap.shorten(scene.title, 80, placeholder=" …")
    words = f"{what}: {title}\n{conditions(scene)}"
    figure.suptitle(words, x=0.008, ha="left", fontsize=14, color=DARK, parse_math=False)


def _words(figure: Figure, report: EffectReport) -> None:
    measured_heading(figure, "What the effects cost and change", report.scene)
    kinds = {row.subset.kind for row in report.rows}
    colours = "; ".join(words for kind, words in WORDS.items() if kind in kinds)
    entries = [
        "T$_{EPP}$: transmission error, peak to peak, at the wheel's base circle",
        "grey whiskers: fastest and slowest round",
    ]
    if any(own_remarks(report, row) for row in report.rows):
        entries.append("* with a remark that the whole scene does not have, see effects.csv")
    words = f"{colours}\n{'; '.join(entries)}\n{in_words(report.machine)}"
    figure.text(0.008, 0.1 / figure.get_figheight(), words, fontsize=9.5, color=DARK)
