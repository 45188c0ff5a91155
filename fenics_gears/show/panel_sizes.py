"""How much room a chart and the ticks of an axis take in a picture. Lengths are in inches."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes

from fenics_gears.show.chart import Chart

WIDTH, GAP = 10.0, 0.12
# The inside of a panel for each pixel of a chart's height.
PANEL = 0.0086
# Heights of a line of the heading and of a title, of a row of a legend and of flags, and of tick labels below an axis.
HEADING_LINE, LINE, LEGEND_ROW, FLAG_ROW, TICK_ROW = 0.25, 0.22, 0.265, 0.236, 0.33
# Widths of a letter at a tick, in a flag and in a legend, and of what a legend's entry has besides.
LETTER, FLAG_LETTER, LEGEND_LETTER, LEGEND_HANDLE = 0.106, 0.092, 0.092, 0.56
# A tick and the gap to its label; room of an axis' title; half a tick label beyond an axis' end; a colour bar and the
# room before it.
TICK, TITLE, HALF_LABEL, BAR, BAR_GAP = 0.05, 0.28, 0.3, 0.2, 0.24
# Least distance of ticks on an upright and on a level axis.
APART_UPRIGHT, APART_LEVEL = 0.36, 0.75
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
        return max(
            (
                FLAG_LETTER * (len(flag.words) + 2) - 0.8 * WIDTH * (last - flag.x) / (last - first)
                for flag in self.chart.flags
            ),
            default=0.0,
        )

    @property
    def legend_columns(self) -> int:
        """Names beside each other; as wide as the widest where they are not all in one row."""
        widths = [LEGEND_HANDLE + LEGEND_LETTER * len(curve.name) for curve in self.chart.curves if curve.listed]
        return len(widths) if sum(widths) <= 0.82 * WIDTH else max(1, int(0.82 * WIDTH / max(widths)))

    @property
    def legend_rows(self) -> int:
        """Rows of these; none without a legend."""
        return (
            -(-sum(curve.listed for curve in self.chart.curves) // self.legend_columns) if self.chart.has_legend else 0
        )


@dataclass(frozen=True)
class Scale:
    """Ticks of an axis of `axes`: places (n,) on it and their labels; the axis' title."""

    axes: Axes
    places: np.ndarray
    labels: Sequence[str]
    title: str

    @property
    def label_width(self) -> float:
        """Room of ticks and labels beside an upright axis."""
        return 2 * TICK + LETTER * max(map(len, self.labels), default=0)

    @property
    def width(self) -> float:
        """Room that an upright axis takes, with the colour bar that it may be of."""
        return self.label_width + TITLE + (BAR_GAP + BAR if self.axes.get_label() == BAR_NAME else 0.0)
