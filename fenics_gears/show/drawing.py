"""Draws charts by matplotlib: below each other as the picture of a run, or alone as a still image in a page."""

from __future__ import annotations

import io
import textwrap
from collections.abc import Sequence

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, MaxNLocator

from fenics_gears.show.chart import BAND, BARS, LINES, MARKED_LINES, MARKERS, Chart, Curve
from fenics_gears.show.panels import DARK, styled
from fenics_gears.show.thinning import thinned

DASHES = {"solid": "-", "dash": (0, (5, 2.5)), "dot": (0, (1, 1.6)), "dashdot": (0, (6, 2, 1, 2))}
# Points; of a legend's row, of a letter in it, and of what an entry has besides letters.
LEGEND_ROW, LEGEND_LETTER, LEGEND_HANDLE = 19.0, 6.6, 40.0
FLAG_ROW = 17.0
# Inches; letters of a heading's line.
WIDTH, LETTERS = 10.0, 92
# A still image is 900 points wide: more than these of a curve are not seen in it.
STILL_POINTS = 1000


@styled
def picture(heading: str, charts: Sequence[Chart], colour: str = DARK) -> Figure:
    """Charts below each other under a heading."""
    heights = [chart.height / 100.0 for chart in charts]
    figure = Figure(figsize=(WIDTH, 1.4 + sum(heights)), layout="constrained")
    figure.get_layout_engine().set(w_pad=0.12, h_pad=0.1)
    every = figure.subplots(len(charts), squeeze=False, gridspec_kw={"height_ratios": heights})[:, 0]
    for place, (axes, chart) in enumerate(zip(every, charts)):
        draw(axes, chart, chart.caption)
        if place + 1 < len(charts) and charts[place + 1].x_title == chart.x_title:
            axes.set_xlabel("")
    # A title may hold dollar signs that are no formula.
    figure.suptitle(heading, x=0.012, ha="left", fontsize=14, color=colour, parse_math=False)
    return figure


@styled
def still(chart: Chart) -> bytes:
    """A chart alone as SVG, without its caption and note."""
    from matplotlib.backends.backend_svg import FigureCanvasSVG

    figure = Figure(figsize=(WIDTH, chart.height / 96.0 + 0.3), layout="constrained")
    draw(figure.subplots(), chart)
    content = io.BytesIO()
    with matplotlib.rc_context({"svg.fonttype": "none", "svg.hashsalt": "fenics_gears", "path.simplify_threshold": 0.3}):
        FigureCanvasSVG(figure)
        figure.savefig(content, format="svg", dpi=150, metadata={"Date": None, "Creator": None})
    return content.getvalue()


def draw(axes: Axes, chart: Chart, title: str = "") -> None:
    """One chart, its legend above it where no curve can be, its title above that."""
    if chart.field is not None:
        _draw_field(axes, chart)
    for curve in chart.curves:
        _draw_curve(axes, curve, chart)
    axes.set_xlabel(chart.x_title)
    axes.set_ylabel(chart.y_title)
    _scale(axes, chart)
    axes.set_title("\n".join(textwrap.wrap(title, LETTERS)), pad=8.0 + _legend(axes, chart), parse_math=False)
    if chart.second is not None:
        second = chart.second
        right = axes.secondary_yaxis(
            "right", functions=(lambda y: second.offset + second.factor * y, lambda y: (y - second.offset) / second.factor)
        )
        right.set_ylabel(second.title)
    if chart.flags:
        _draw_flags(axes, chart)


def _draw_curve(axes: Axes, curve: Curve, chart: Chart) -> None:
    label = curve.name if curve.listed else None
    x, y = np.asarray(curve.x), np.asarray(curve.y, dtype=float)
    if curve.mode == BAND:
        axes.fill_between(x, *y, color=curve.colour, alpha=0.25, linewidth=0.0, label=label)
        for edge in y:
            axes.plot(x, edge, color=curve.colour, linewidth=curve.width)
        return
    if curve.mode == BARS:
        axes.bar(x, y, curve.width, color=curve.colour, label=label)
        return
    if chart.x_range is not None and not chart.equal:
        near = (x >= chart.x_range[0] - 1e-9) & (x <= chart.x_range[1] + 1e-9)
        x, y = x[near], y[near]
    places = thinned(y, len(y) if chart.equal else STILL_POINTS)
    marker = "o" if curve.mode in (MARKERS, MARKED_LINES) else ""
    style = DASHES[curve.dash] if curve.mode in (LINES, MARKED_LINES) else ""
    axes.plot(
        x[places], y[places], color=curve.colour, linestyle=style, marker=marker, markersize=5.0, linewidth=1.1 * curve.width, label=label,
        **({"markerfacecolor": "white"} if curve.words else {}),
    )  # fmt: skip
    if curve.fill:
        axes.fill(x, y, color=curve.fill, zorder=0.9)
    for words, place, height in zip(curve.words, x, y):
        up, right = 1 if "top" in curve.beside else -1, 1 if "right" in curve.beside else -1
        axes.annotate(
            words, (place, height), xytext=(6 * right, 6 * up), textcoords="offset points", fontsize=10.5,
            ha="left" if right > 0 else "right", va="bottom" if up > 0 else "top",
        )  # fmt: skip


def _draw_field(axes: Axes, chart: Chart) -> None:
    field = chart.field
    colours = LinearSegmentedColormap.from_list("field", list(field.colours))
    beyond = np.nanmax(field.values, initial=0.0) > field.limit * (1 + 1e-9)
    lowest = min(0.0, float(np.nanmin(field.values, initial=0.0)))
    drawn = axes.pcolormesh(field.x, field.y, np.ma.masked_invalid(field.values), cmap=colours, vmin=lowest, vmax=field.limit, rasterized=True)
    bar = axes.figure.colorbar(drawn, ax=axes, extend="max" if beyond else "neither", pad=0.02, fraction=0.05)
    bar.set_label(field.title)
    bar.outline.set_visible(False)


def _scale(axes: Axes, chart: Chart) -> None:
    """Ranges, divisions and tick labels of both axes."""
    for name, axis in (("x", axes.xaxis), ("y", axes.yaxis)):
        if name in chart.logarithmic:
            getattr(axes, f"set_{name}scale")("log")
            axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    if not chart.logarithmic and not chart.equal and all(np.asarray(curve.x).dtype.kind in "fiu" for curve in chart.curves):
        axes.xaxis.set_major_locator(MaxNLocator(nbins=10, steps=[1, 2, 2.5, 5, 10]))
    if chart.equal:
        axes.set_aspect("equal", adjustable="datalim")
    if chart.x_range is not None:
        axes.set_xlim(*chart.x_range)
    if chart.limits is not None:
        axes.set_ylim(*chart.limits)


def _legend(axes: Axes, chart: Chart) -> float:
    """The legend's height, points."""
    if not chart.has_legend:
        return 0.0
    names = [curve.name for curve in chart.curves if curve.listed]
    entries, room = [LEGEND_HANDLE + LEGEND_LETTER * len(name) for name in names], 0.82 * axes.figure.get_figwidth() * 72.0
    columns = len(names) if sum(entries) <= room else max(1, int(room / max(entries)))
    axes.legend(
        loc="lower left", bbox_to_anchor=(0.0, 1.0), ncol=columns, borderaxespad=0.1, handlelength=1.6, columnspacing=1.4, labelspacing=0.25
    )
    return LEGEND_ROW * -(-len(names) // columns)


def _draw_flags(axes: Axes, chart: Chart) -> None:
    """Words above all curves, each right of the line that leads down to its place."""
    rows = chart.flag_rows
    height = axes.figure.get_figheight() * 72.0 * 0.6
    low, high = axes.get_ylim()
    room = 1.0 - FLAG_ROW * (max(rows) + 1) / height
    stretched = "y" in chart.logarithmic
    axes.set_ylim(low, low * (high / low) ** (1.0 / room) if stretched else low + (high - low) / room)
    for flag, row in zip(chart.flags, rows):
        top = 1.0 - FLAG_ROW * (max(rows) - row + 1) / height
        start = (flag.x, max(flag.y, axes.get_ylim()[0]))
        axes.annotate(
            "", start, xytext=(flag.x, top), textcoords=("data", "axes fraction"), arrowprops={"arrowstyle": "-", "color": flag.colour, "linewidth": 0.8},
        )  # fmt: skip
        axes.annotate(
            flag.words, (flag.x, top), xycoords=("data", "axes fraction"), xytext=(3, 0), textcoords="offset points", fontsize=11,
            color=flag.colour, va="bottom",
        )  # fmt: skip


def heading(subject: str, title: str, *more: str) -> str:
    """Subject and title in lines that fit a picture's width."""
    title = " ".join(title.split())
    first = textwrap.shorten(f"{subject}: {title}" if title else subject, LETTERS, placeholder=" …")
    return "\n".join([first, *(line for each in more for line in textwrap.wrap(each, LETTERS, break_long_words=False))])
