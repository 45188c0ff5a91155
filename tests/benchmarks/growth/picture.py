"""The picture of growth: seconds of every stage and bytes over what grows, with the slopes over the upper decade."""

from __future__ import annotations

from collections.abc import Mapping
from math import nan

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter
from tests.benchmarks.growth.axes import those_of
from tests.benchmarks.growth.axis import Axis
from tests.benchmarks.growth.fit import local_slopes
from tests.benchmarks.growth.report import MEBI, WORDS, Points, column, exponents, known

from fenics_gears.show.panels import DARK, GREY, PALETTE, styled

COLUMNS = 3
COLOURS = dict(zip(("mesh", "assemble", "schur", "ring", "operators", "solving"), PALETTE))
COLOURS |= {"fourier": GREY, "clock": DARK}
MARKS = dict(zip(COLOURS, "os^Dvpxh"))
PLANE_PAIR = "the paper's pair, quasi-static with friction, one thing at a time made larger"
IDLE = "process, peak of all stages"


@styled
def growth_picture(found: Mapping[str, Points], machine: Mapping[str, str], what: str = PLANE_PAIR) -> Figure:
    """Two rows of panels for each three axes: times above, memory below; `what` grows, for the title."""
    axes_found = those_of(found)
    rows = -(-len(axes_found) // COLUMNS)
    figure = Figure(figsize=(15.0, 7.2 * rows + 0.9), layout="constrained")
    figure.get_layout_engine().set(w_pad=0.12, h_pad=0.1, rect=(0, 0.035, 1, 0.965))
    panels = figure.subplots(2 * rows, COLUMNS, squeeze=False, gridspec_kw={"height_ratios": (1.7, 1.0) * rows})
    for place in range(rows * COLUMNS):
        row, column_ = divmod(place, COLUMNS)
        times, memory = panels[2 * row][column_], panels[2 * row + 1][column_]
        if place < len(axes_found):
            _times(times, axes_found[place], found[axes_found[place].name])
            _memory(memory, axes_found[place], found[axes_found[place].name])
        else:
            times.set_axis_off()
            memory.set_axis_off()
    figure.suptitle(f"How time and memory grow: {what}", x=0.008, ha="left", fontsize=14, color=DARK)
    told = (
        "Numbers in the legends: exponents over the upper decade. Times: processor seconds on one thread, medians.\n"
        f"{machine['processor']}, load {machine['load']}; {machine['versions']}"
    )
    figure.text(0.008, 0.008, told, fontsize=10, color=DARK, parse_math=False)
    return figure


def _times(panel: Axes, axis: Axis, points: Points) -> None:
    fits = exponents(axis, points)
    for stage, colour in COLOURS.items():
        if stage not in axis.theory:
            continue
        fit, theory, line = fits[stage], axis.theory[stage].exponent, known(axis, points, column(stage))
        label = (
            f"{WORDS[stage]}: {_rounded(local_slopes(*line)[-1] if fit is None else fit.value)}, theory {theory:.2g}"
        )
        panel.plot(*line, "-" + MARKS[stage], color=colour, markersize=5, label=label)
    _logarithmic(panel)
    panel.set_title(axis.words if len(axis.words) < 52 else axis.words.replace(", ", ",\n", 1))
    panel.set_ylabel("Processor time (s)")
    panel.legend(fontsize=9, loc="upper left", borderaxespad=0.2).set_in_layout(False)
    low, high = panel.get_ylim()
    # Room for the legend.
    panel.set_ylim(low, high * (high / low) ** 0.55)


def _rounded(value: float) -> str:
    """With one digit, and no minus before a zero."""
    return f"{round(value, 1) + 0.0:.1f}"


def _memory(panel: Axes, axis: Axis, points: Points) -> None:
    peaks = [
        max((value for name, value in point.items() if name.endswith("_peak_bytes")), default=nan) for point in points
    ]
    panel.plot([point[axis.counted] for point in points], [each / MEBI for each in peaks], "-", color=GREY, label=IDLE)
    for stage, colour in (("condense", PALETTE[2]), ("operators", PALETTE[4]), ("solving", PALETTE[5])):
        at, held = known(axis, points, f"{stage}_array_bytes")
        if not at:
            continue
        panel.plot(
            at,
            [each / MEBI for each in held],
            "-" + {"condense": "^", "operators": "v", "solving": "p"}[stage],
            color=colour,
            markersize=4,
            label=f"arrays of {stage.replace('condense', 'condensing')}",
        )
    _logarithmic(panel)
    panel.set_ylabel("Memory (MiB)")
    panel.set_xlabel(axis.name[0].upper() + axis.name[1:])
    panel.legend(fontsize=8.5, loc="upper left", ncol=2, borderaxespad=0.2, columnspacing=1.0).set_in_layout(False)
    low, high = panel.get_ylim()
    panel.set_ylim(low, high * (high / low) ** 0.5)


def _logarithmic(panel: Axes) -> None:
    panel.set_xscale("log")
    panel.set_yscale("log")
    panel.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    if panel.get_xlim()[1] < 3.0:
        # Ranks: one and two, nothing between.
        panel.xaxis.set_minor_formatter(FuncFormatter(lambda value, _: "2" if abs(value - 2.0) < 1e-9 else ""))
