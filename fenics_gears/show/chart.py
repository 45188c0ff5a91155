"""Charts as data: curves, bars, bands and a coloured field over two axes, with units, captions and colours.

``show.drawing`` draws them by matplotlib, for files and paper, ``show.interactive`` by plotly, for zooming. Room
in a picture is in inches.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import cycle
from typing import TYPE_CHECKING

import numpy as np

from .panels import DARK, PALETTE, limits

if TYPE_CHECKING:
    from matplotlib.axes import Axes

TIME = "time"
MESH_CYCLES = "Time (mesh cycles since the start)"
LINES = "lines"
MARKERS = "markers"
MARKED_LINES = "lines+markers"
BARS = "bars"
BAND = "band"
WORDS = "words"
# Smallest span that an axis shows, in parts of the largest value.
LEAST_SHARE = 0.02
# Width of a letter in a flag, in parts of the chart's width, on a page of usual width.
PART_OF_LETTER = 0.0105


@dataclass(frozen=True)
class Curve:
    """Values (n,) over places (n,) of the first axis, numbers or words; a band has values (2, n), its lower and upper
    edge.

    width: of the line in pixels, or of bars along the first axis. fill: colour inside a closed line. words: next to
    each place, on the side `beside` ("right", "top right").
    """

    name: str
    x: np.ndarray
    y: np.ndarray
    colour: str = PALETTE[0]
    dash: str = "solid"
    width: float = 1.6
    mode: str = LINES
    fill: str = ""
    listed: bool = True
    words: Sequence[str] = ()
    beside: str = "top right"


@dataclass(frozen=True)
class Field:
    """Values (m, n), not a number where there are none, in cells between edges (n + 1,) of the first and (m + 1,) of
    the second axis. limit: where the colours end, from low to high."""

    x: np.ndarray
    y: np.ndarray
    values: np.ndarray
    title: str
    limit: float
    colours: Sequence[str]


@dataclass(frozen=True)
class Second:
    """A second scale on the right: ``offset + factor * value``."""

    title: str
    factor: float
    offset: float = 0.0


@dataclass(frozen=True)
class Flag:
    """Words on a place of the chart, above all curves, with a line down to it."""

    x: float
    y: float
    words: str
    colour: str = DARK


@dataclass(frozen=True)
class Chart:
    """Curves over one axis. `note`: a sentence below. `least`: the smallest span that the second axis shows. `linked`:
    charts of a page with the same word are zoomed together. `logarithmic`: the axes ("x", "y", "xy") so divided.
    `equal`: a length is as long on either axis."""

    caption: str
    curves: Sequence[Curve]
    x_title: str
    y_title: str
    note: str = ""
    height: int = 300
    linked: str = ""
    least: float = 0.0
    x_range: tuple[float, float] | None = None
    y_range: tuple[float, float] | None = None
    logarithmic: str = ""
    equal: bool = False
    field: Field | None = None
    second: Second | None = None
    flags: Sequence[Flag] = ()

    @property
    def has_legend(self) -> bool:
        """Whether names are to be listed: of more than one curve, or of curves on a field."""
        return sum(curve.listed for curve in self.curves) > (self.field is None)

    @property
    def limits(self) -> tuple[float, float] | None:
        """Ends of the second axis around what is shown; None where the drawing module chooses them."""
        if self.y_range is not None or "y" in self.logarithmic or self.field is not None:
            return self.y_range
        shown = [self._shown(curve) for curve in self.curves]
        finite = np.concatenate([each[np.isfinite(each)] for each in shown]) if shown else np.zeros(0)
        if not finite.size:
            return None
        if any(curve.mode == BARS for curve in self.curves):
            return 0.0, 1.06 * float(finite.max()) or 1.0
        return limits(finite, self.least or (0.0 if np.ptp(finite) else 1.0))

    def _shown(self, curve: Curve) -> np.ndarray:
        values = np.asarray(curve.y, dtype=float)
        if self.x_range is not None and np.asarray(curve.x).dtype.kind in "fiu":
            values = values[..., self.in_range(curve.x)]
        return values.ravel()

    def in_range(self, x: np.ndarray) -> np.ndarray:
        """Which places (n,) are in the range of the first axis."""
        return (x >= self.x_range[0] - 1e-9) & (x <= self.x_range[1] + 1e-9)

    @property
    def flag_rows(self) -> list[int]:
        """The row above the curves for each flag's words, right of its line: no words over others or another's line."""
        first, last = self.x_range
        rows = [0] * len(self.flags)
        order = sorted(range(len(self.flags)), key=lambda each: self.flags[each].x)
        for turn in reversed(range(len(order))):
            flag = self.flags[order[turn]]
            end = flag.x + (len(flag.words) + 2) * PART_OF_LETTER * (last - first)
            beside = [rows[other] for other in order[turn + 1 :] if self.flags[other].x < end]
            rows[order[turn]] = 1 + max(beside, default=-1)
        return rows


def over_time(run, caption: str, y_title: str, curves: Sequence[tuple[str, np.ndarray, str]], **options) -> Chart:
    """Curves of name, values (time,) and colour over the mesh cycles of a run; such charts are zoomed together."""
    drawn = [Curve(name, run.phase, values, colour) for name, values, colour in curves]
    return Chart(caption, drawn, MESH_CYCLES, y_title, linked=TIME, x_range=run.window, **options)


def of_variables(
    run,
    caption: str,
    what: str,
    unit: str,
    names: dict[str, str],
    colours: Sequence[str] = PALETTE,
    least: float = 0.0,
    **options,
) -> list[Chart]:
    """A chart of the variables, by name and words, that a run's result has, in this unit; none where it has none of
    them. Those of both gears have a curve for either. least: the smallest span shown, else a part of the largest
    value."""
    curves: list[Curve] = []
    for (name, words), colour in zip(names.items(), colours):
        if name in run.dataset:
            values = run.values(name, unit)
            if values.ndim == 2:
                along = run.dataset[name].dims[1]
                listed = run.dataset[along].values.tolist()
                own = PALETTE[2:4] if along == "gear" else cycle(PALETTE)
                curves += zip(listed if along == "gear" else (f"{along} {each + 1}" for each in listed), values.T, own)
            else:
                curves.append((words, values, colour))
    if not curves:
        return []
    options = {"least": least or span(curves), "height": 240, **options}
    return [over_time(run, caption, f"{what} ({unit})", curves, **options)]


def span(curves: Sequence[tuple[str, np.ndarray, str]]) -> float:
    """Smallest span that an axis shows of curves, so that round-off fills no chart; 1 for nothing but zeros."""
    largest = max(float(np.abs(values[np.isfinite(values)]).max(initial=0.0)) for _, values, _ in curves)
    return LEAST_SHARE * largest or 1.0


def stems(places: np.ndarray, heights: np.ndarray, foot: float) -> tuple[np.ndarray, np.ndarray]:
    """A line that goes up and down at each place (n,) from its foot."""
    feet = np.full(len(places), foot)
    return np.repeat(places, 3), np.stack([feet, heights, feet], axis=1).ravel()


WIDTH = 10.0
GAP = 0.12
# The inside of a panel for each pixel of a chart's height.
PANEL = 0.0086
# Heights of a line of the heading and of a title, of a row of a legend and of flags, and of tick labels below an axis.
HEADING_LINE = 0.25
LINE = 0.22
LEGEND_ROW = 0.265
FLAG_ROW = 0.236
TICK_ROW = 0.33
# Widths of a letter at a tick, in a flag and in a legend, and of the rest of a legend's entry.
LETTER = 0.106
FLAG_LETTER = 0.092
LEGEND_LETTER = 0.092
LEGEND_HANDLE = 0.56
# A tick and the gap to its label; room of an axis' title; half a tick label beyond an axis' end; a colour bar and the
# room before it.
TICK = 0.05
TITLE = 0.28
HALF_LABEL = 0.3
BAR = 0.2
BAR_GAP = 0.24
# Least distance of ticks on an upright and on a level axis.
APART_UPRIGHT = 0.36
APART_LEVEL = 0.75
# Letters of a line of heading and titles.
LETTERS = 92
BAR_NAME = "colour bar"


@dataclass(frozen=True)
class Panel:
    """A chart with its title in lines, and whether its first axis is named."""

    chart: Chart
    title: str = ""
    named: bool = True

    @property
    def above(self) -> float:
        """Height of title and legend."""
        return GAP + LEGEND_ROW * self.legend_rows + (LINE * (self.title.count("\n") + 1) if self.title else 0.0)

    @property
    def inside(self) -> float:
        """Height between the axes' ends."""
        return PANEL * self.chart.height

    @property
    def height(self) -> float:
        """Height of all."""
        return self.above + self.inside + (TICK_ROW + TITLE) * self.named + GAP

    @property
    def has_grid(self) -> bool:
        """Whether lines lead from the ticks across; colours and drawings have none."""
        return self.chart.field is None and not self.chart.equal

    @property
    def overhang(self) -> float:
        """Width of a flag's words beyond the end of the first axis."""
        first, last = self.chart.x_range or (0.0, 1.0)
        beyond = (
            FLAG_LETTER * (len(flag.words) + 2) - 0.8 * WIDTH * (last - flag.x) / (last - first)
            for flag in self.chart.flags
        )
        return max(beyond, default=0.0)

    @property
    def legend_columns(self) -> int:
        """Names in rows, as wide as the widest where they are not all in one row."""
        widths = [LEGEND_HANDLE + LEGEND_LETTER * len(curve.name) for curve in self.chart.curves if curve.listed]
        return len(widths) if sum(widths) <= 0.82 * WIDTH else max(1, int(0.82 * WIDTH / max(widths)))

    @property
    def legend_rows(self) -> int:
        """Rows of these; none without a legend."""
        listed = sum(curve.listed for curve in self.chart.curves)
        return -(-listed // self.legend_columns) if self.chart.has_legend else 0


@dataclass(frozen=True)
class Scale:
    """Ticks of an axis of `axes`: their places (n,) and labels; the axis' title."""

    axes: Axes
    places: np.ndarray
    labels: Sequence[str]
    title: str

    @property
    def label_width(self) -> float:
        """Width of ticks and labels of an upright axis."""
        return 2 * TICK + LETTER * max(map(len, self.labels), default=0)

    @property
    def width(self) -> float:
        """Room that an upright axis takes, with the colour bar that it may be of."""
        return self.label_width + TITLE + (BAR_GAP + BAR if self.axes.get_label() == BAR_NAME else 0.0)
