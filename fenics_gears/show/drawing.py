"""Draws charts by matplotlib: below each other as the picture of a run, or alone as a still image in a page.

Panels, ticks and labels are placed here, by numbers in inches: matplotlib's own layouts take most of a picture's time.
"""

import io
import textwrap
from collections.abc import Sequence

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator

from .chart import (
    APART_LEVEL,
    APART_UPRIGHT,
    BAND,
    BAR,
    BAR_GAP,
    BAR_NAME,
    BARS,
    FLAG_ROW,
    GAP,
    HALF_LABEL,
    HEADING_LINE,
    LEGEND_ROW,
    LETTERS,
    LINES,
    MARKED_LINES,
    MARKERS,
    TICK,
    TICK_ROW,
    TITLE,
    WIDTH,
    Chart,
    Curve,
    Panel,
    Scale,
)
from .panels import DARK, GRID, legend, styled, thinned, tick_labels, ticks

DASHES = {"solid": "-", "dash": (0, (5, 2.5)), "dot": (0, (1, 1.6))}
STILL_POINTS = 1000  # of a curve; a still image is 900 points wide


@styled
def picture(heading: str, charts: Sequence[Chart], colour: str = DARK) -> Figure:
    """Charts below each other under a heading; neighbours of the same first axis have its name once."""
    axes = [(chart.x_title, chart.x_range) for chart in charts]
    panels = [
        Panel(chart, "\n".join(textwrap.wrap(chart.caption, LETTERS)), own != below)
        for chart, own, below in zip(charts, axes, [*axes[1:], None])
    ]
    figure = _figure(panels, HEADING_LINE * (heading.count("\n") + 1) + GAP)
    # A title may hold dollar signs that are no formula.
    at_corner = {"x": 0.012, "y": 1.0 - GAP / figure.get_figheight(), "ha": "left", "va": "top"}
    figure.suptitle(heading, fontsize=14, color=colour, parse_math=False, **at_corner)
    return figure


@styled
def still(chart: Chart) -> bytes:
    """A chart alone as SVG, without its caption and note."""
    from matplotlib.backends.backend_svg import FigureCanvasSVG

    content = io.BytesIO()
    settings = {"svg.fonttype": "none", "svg.hashsalt": "fenics_gears", "path.simplify_threshold": 0.3}
    with matplotlib.rc_context(settings):
        FigureCanvasSVG(_figure([Panel(chart)])).print_svg(content, metadata={"Date": None, "Creator": None})
    return content.getvalue()


def _figure(panels: Sequence[Panel], heading: float = 0.0) -> Figure:
    height = heading + sum(panel.height for panel in panels)
    figure = Figure(figsize=(WIDTH, height))
    bottom = height - heading
    every = []
    with matplotlib.rc_context({"axes.grid": False}):
        for panel in panels:
            foot = bottom - panel.above - panel.inside
            every.append(figure.add_axes((0.1, foot / height, 0.8, panel.inside / height)))
            bottom -= panel.height
        scales = [_draw(axes, panel) for axes, panel in zip(every, panels)]
    left = GAP + max(own.width for own, *_ in scales)
    widths = [GAP + sum(scale.width for scale in others) for _, *others in scales if others]
    right = WIDTH - max(HALF_LABEL, *(panel.overhang for panel in panels), *widths)
    for axes, panel, (own, *beside) in zip(every, panels, scales):
        _, bottom, _, high = axes.get_position().bounds
        axes.set_position((left / WIDTH, bottom, (right - left) / WIDTH, high))
        axes.apply_aspect()
        _draw_level(axes, panel, right - left)
        _draw_upright(own, -1, left - GAP)
        if panel.has_grid:
            _draw_lines(axes, [((0.0, place), (1.0, place)) for place in own.places], axes.get_yaxis_transform(), GRID)
        edge = right
        for scale in beside:
            if scale.axes is not axes:
                scale.axes.set_position(((edge + BAR_GAP) / WIDTH, bottom, BAR / WIDTH, high))
            _draw_upright(scale, 1, scale.label_width + TITLE)
            edge += scale.width
    return figure


def _draw(axes: Axes, panel: Panel) -> list[Scale]:
    """A chart, its legend and title above it; the upright scales, the chart's own first."""
    chart = panel.chart
    bars = [_draw_field(axes, panel)] if chart.field is not None else []
    for curve in chart.curves:
        _draw_curve(axes, curve, chart)
    _set_ends(axes, chart)
    axes.set_xlabel(chart.x_title if panel.named else "")
    # A title whose height is given is not moved out of the way of others, which takes long to find out.
    axes.set_title(panel.title, y=1.0, pad=72.0 * (0.6 * GAP + LEGEND_ROW * panel.legend_rows), parse_math=False)
    if chart.has_legend:
        legend(axes, panel.legend_columns, "lower left", labelspacing=0.25)
    if chart.flags:
        _draw_flags(axes, panel)
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(NullLocator())
        axis.set_minor_locator(NullLocator())
    ends = np.array(axes.get_ylim())
    logarithmic = "y" in chart.logarithmic
    places = ticks(ends, panel.inside / APART_UPRIGHT, logarithmic)
    own = Scale(axes, places, tick_labels(places, logarithmic), chart.y_title)
    if chart.second is None:
        return [own, *bars]
    factor = chart.second.factor
    offset = chart.second.offset
    places = ticks(offset + factor * ends, panel.inside / APART_UPRIGHT)
    return [own, Scale(axes, (places - offset) / factor, tick_labels(places), chart.second.title), *bars]


def _set_ends(axes: Axes, chart: Chart) -> None:
    for name in chart.logarithmic:
        getattr(axes, f"set_{name}scale")("log")
    if chart.equal:
        axes.set_aspect("equal", adjustable="datalim")
    # Equal scales need one of the two ranges wider: newer matplotlib warns where both are fixed.
    fixed = None if chart.equal else False
    if chart.x_range is not None:
        axes.set_xlim(*chart.x_range, auto=fixed)
    if chart.limits is not None:
        axes.set_ylim(*chart.limits, auto=fixed)


def _draw_level(axes: Axes, panel: Panel, width: float) -> None:
    chart = panel.chart
    in_words = [curve.x for curve in chart.curves if np.asarray(curve.x).dtype.kind not in "fiu"]
    labels = list(dict.fromkeys(str(each) for places in in_words for each in places))
    logarithmic = "x" in chart.logarithmic
    places = np.arange(len(labels)) if labels else ticks(axes.get_xlim(), width / APART_LEVEL, logarithmic)
    across = axes.get_xaxis_transform()
    if panel.has_grid:
        _draw_lines(axes, [((place, 0.0), (place, 1.0)) for place in places], across, GRID)
    _draw_lines(axes, [((place, 0.0), (place, -TICK / panel.inside)) for place in places], across)
    for place, label in zip(places, labels or tick_labels(places, logarithmic)) if panel.named else ():
        axes.text(place, -2.0 * TICK / panel.inside, label, transform=across, ha="center", va="top", parse_math=False)
    axes.xaxis.set_label_coords(0.5, -TICK_ROW / panel.inside)


def _draw_upright(scale: Scale, side: int, room: float) -> None:
    """Ticks of an upright axis, labels on its left (-1) or right (1) side, its title at the end of the room."""
    axes = scale.axes
    end = 0.5 + 0.5 * side
    inch = side / (axes.get_position().width * WIDTH)
    across = axes.get_yaxis_transform()
    _draw_lines(axes, [((end, place), (end + TICK * inch, place)) for place in scale.places], across)
    away, back = ("left", "right") if side > 0 else ("right", "left")
    for place, label in zip(scale.places, scale.labels):
        axes.text(end + 2.0 * TICK * inch, place, label, transform=across, ha=away, va="center_baseline")
    upright = {"transform": axes.transAxes, "rotation": "vertical", "va": "center"}
    axes.text(end + room * inch, 0.5, scale.title, ha=back, **upright)


def _draw_lines(axes: Axes, ends: list, transform, colour: str = DARK) -> None:
    """Lines of a grid or ticks, below the curves."""
    lines = LineCollection(ends, colors=colour, linewidths=0.8, transform=transform, clip_on=False, zorder=0.5)
    axes.add_collection(lines, autolim=False)


def _draw_curve(axes: Axes, curve: Curve, chart: Chart) -> None:
    label = curve.name if curve.listed else None
    x = np.asarray(curve.x)
    y = np.asarray(curve.y, dtype=float)
    if curve.mode == BAND:
        axes.fill_between(x, *y, color=curve.colour, alpha=0.25, linewidth=0.0, label=label)
        for edge in y:
            axes.plot(x, edge, color=curve.colour, linewidth=curve.width)
        return
    if curve.mode == BARS:
        # Thousands of bars in one artist.
        left = x - 0.5 * curve.width
        right = x + 0.5 * curve.width
        foot = np.zeros_like(y)
        corners = np.stack([left, foot, left, y, right, y, right, foot], axis=1).reshape(-1, 4, 2)
        axes.add_collection(PolyCollection(corners, facecolors=curve.colour, edgecolors="none", label=label))
        return
    if chart.x_range is not None and not chart.equal:
        near = chart.in_range(x)
        x = x[near]
        y = y[near]
    places = thinned(y, len(y) if chart.equal else STILL_POINTS)
    marker = "o" if curve.mode in (MARKERS, MARKED_LINES) else ""
    style = DASHES[curve.dash] if curve.mode in (LINES, MARKED_LINES) else ""
    axes.plot(
        x[places], y[places], color=curve.colour, linestyle=style, marker=marker, markersize=5.0,
        linewidth=1.1 * curve.width, label=label,
        **({"markerfacecolor": "white"} if curve.words else {}),
    )  # fmt: skip
    if curve.fill:
        axes.fill(x, y, color=curve.fill, zorder=0.9)
    up = ("top" in curve.beside) - ("bottom" in curve.beside)
    right = ("right" in curve.beside) - ("left" in curve.beside)
    for words, place, height in zip(curve.words, x, y):
        axes.annotate(
            words, (place, height), xytext=(6 * right, 6 * up), textcoords="offset points", fontsize=10.5,
            ha=("center", "left", "right")[right], va=("center", "bottom", "top")[up],
            bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 1.0},
        )  # fmt: skip


def _draw_field(axes: Axes, panel: Panel) -> Scale:
    field = panel.chart.field
    colours = LinearSegmentedColormap.from_list("field", list(field.colours))
    beyond = np.nanmax(field.values, initial=0.0) > field.limit * (1 + 1e-9)
    lowest = min(0.0, float(np.nanmin(field.values, initial=0.0)))
    look = {"cmap": colours, "vmin": lowest, "vmax": field.limit, "rasterized": True}
    drawn = axes.pcolormesh(field.x, field.y, np.ma.masked_invalid(field.values), **look)
    beside = axes.figure.add_axes((0.9, 0.1, 0.02, 0.8), label=BAR_NAME)
    bar = axes.figure.colorbar(drawn, cax=beside, extend="max" if beyond else "neither", ticks=NullLocator())
    bar.outline.set_visible(False)
    places = ticks((lowest, field.limit), panel.inside / APART_UPRIGHT)
    return Scale(beside, places, tick_labels(places), field.title)


def _draw_flags(axes: Axes, panel: Panel) -> None:
    chart = panel.chart
    rows = panel.chart.flag_rows
    low, high = axes.get_ylim()
    room = 1.0 - FLAG_ROW * (max(rows) + 1) / panel.inside
    stretched = "y" in chart.logarithmic
    axes.set_ylim(low, low * (high / low) ** (1.0 / room) if stretched else low + (high - low) / room)
    for flag, row in zip(chart.flags, rows):
        top = 1.0 - FLAG_ROW * (max(rows) - row + 1) / panel.inside
        line = {"arrowstyle": "-", "linewidth": 0.8, "relpos": (0.0, 0.0), "shrinkA": 0.0, "shrinkB": 0.0}
        at = {"xytext": (flag.x, top), "textcoords": ("data", "axes fraction"), "va": "bottom"}
        line["color"] = at["color"] = flag.colour
        axes.annotate(f" {flag.words}", (flag.x, max(flag.y, low)), fontsize=11, arrowprops=line, **at)
