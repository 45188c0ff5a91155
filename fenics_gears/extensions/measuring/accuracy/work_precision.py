"""The picture of `gears accuracy`: error against time of whole settings, cheaper models and every setting alone."""

import textwrap
from collections.abc import Iterable

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator

from fenics_gears.charts import DARK, GREY, PALETTE, styled
from fenics_gears.measuring import FACE_LOAD, MEAN, SPAN, judged

from ..effect_costs.picture import measured_heading
from ..machine import in_words
from .refinement import CONDENSATION, plan_of
from .report import DEFAULTS, OWN, AccuracyReport, WholeResult
from .table import in_one_sentence, judged_by, limits_it

# Measures of single numbers over the face.
NUMBERS = {SPAN: "peak-to-peak transmission error", MEAN: "mean transmission error", FACE_LOAD: "face load factor"}
TARGETS = PALETTE[5]
MARKS = ("o", "s", "^", "D", "v", "P", "X", "*", "h", "<")
LEAST_SHOWN = 1e-6


@styled
def work_precision(report: AccuracyReport) -> Figure:
    """Left: whole settings with the front labelled, the scene's own settings, settings of targets, cheaper models.
    Right: each setting alone, the others fine. Over the face, in the middle, also single numbers of the whole
    settings."""
    over_face = report.scene.three_dimensional
    figure = Figure(figsize=(20.5 if over_face else 15.0, 9.2), layout="constrained")
    figure.get_layout_engine().set(w_pad=0.12, h_pad=0.1, rect=(0, 0.09, 1, 0.91))
    widths = (1.35, 1.0, 1.0) if over_face else (1.35, 1.0)
    whole, *numbers, alone = figure.subplots(1, len(widths), gridspec_kw={"width_ratios": widths})
    _whole(whole, report)
    for axes in numbers:
        _numbers(axes, report)
    _alone(alone, report)
    _words(figure, report)
    return figure


def _whole(axes: Axes, report: AccuracyReport) -> None:
    front = report.front

    def draw(results, style: str, colour: str, label: str, size: float = 6.0) -> None:
        points = [(each.times.total, each.total_error) for each in results]
        if points:
            axes.plot(*zip(*points), style, color=colour, markersize=size, label=label)

    others = [each for each in report.settings if each.name not in (OWN, DEFAULTS) and each not in front]
    draw(others, "o", GREY, "other settings: another is quicker and more accurate", 5.0)
    draw(front, "-o", PALETTE[0], "Pareto front: none is quicker and as accurate")
    draw([report.own], "*", PALETTE[1], "the scene's own settings", 16.0)
    draw([report.defaults] if report.defaults else [], "P", PALETTE[3], "the default settings", 11.0)
    for place, each in enumerate(report.targets):
        label = "settings that a target chooses; the dash is what it promises"
        draw([each], "D", TARGETS, "" if place else label, 7.0)
        time = each.times.total
        axes.plot([time, time], [each.target, each.total_error], "_:", color=TARGETS, markersize=14.0)
        axes.annotate(each.name, (time, each.target), xytext=(0, 5), textcoords="offset points", ha="center",
                      fontsize=9.5, color=TARGETS)  # fmt: skip
    for mark, each in zip(MARKS[1:], report.models):
        draw([each], mark, PALETTE[2], f"model: {each.name}", 8.0)
    unsure = "less than the reference's own uncertainty"
    axes.axhspan(LEAST_SHOWN, max(report.floor, LEAST_SHOWN), color=GREY, alpha=0.15, linewidth=0, label=unsure)
    _logarithmic(axes, [*report.settings, *report.targets, *report.models], report.floor)
    axes.set_ylabel(_of_all_judged(report))
    _labels(axes, front)
    axes.set_title("Total error (sum of the errors of all settings, or difference from the reference)")
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.1), ncol=_columns(report), fontsize=10.5)


def _labels(axes: Axes, front: tuple[WholeResult, ...]) -> None:
    lines = []
    look = {"xytext": (6, 5), "textcoords": "offset points", "fontsize": 11, "color": PALETTE[0]}
    for number, each in enumerate(front, 1):
        axes.annotate(str(number), (each.times.total, each.total_error), **look)
        lines.append(f"{number}  {each.setting.words if each.setting else each.name}; limited by {limits_it(each)}")
    axes.text(
        0.985, 0.985, "\n".join(lines), transform=axes.transAxes, ha="right", va="top", fontsize=8.0, color=DARK,
        linespacing=1.5,
        bbox={"facecolor": "white", "edgecolor": "#E3E3E3", "alpha": 0.9, "pad": 5.0},
    )  # fmt: skip


def _numbers(axes: Axes, report: AccuracyReport) -> None:
    front = report.front
    for place, name in enumerate(name for name in NUMBERS if name in report.uncertainty):
        look = {"color": PALETTE[place], "markersize": 5.5}
        axes.plot(*_over_time(front, name), "-", marker=MARKS[place], label=NUMBERS[name], **look)
        axes.plot(*_over_time([report.own], name), "*", color=PALETTE[place], markersize=15.0)
        axes.plot(*_over_time(report.targets, name), "D", color=PALETTE[place], markersize=8.0, fillstyle="none")
    axes.plot([], [], "*", color=GREY, markersize=13.0, label="the scene's own settings")
    axes.plot([], [], "D", color=GREY, fillstyle="none", label="settings that a target chooses")
    axes.set_xscale("log")
    axes.set_yscale("log")
    _percent_over_seconds(axes)
    axes.set_ylabel("Relative error (%), difference from the reference")
    axes.set_title("Single numbers, settings of the Pareto front")
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.1), ncol=1, fontsize=10.5)


def _over_time(results: Iterable[WholeResult], name: str) -> tuple[list[float], list[float]]:
    return [each.times.total for each in results], [max(each.errors[name], LEAST_SHOWN) for each in results]


def _logarithmic(axes: Axes, results, floor: float) -> None:
    errors = np.array([each.total_error for each in results])
    axes.set_xscale("log")
    axes.set_yscale("log")
    # Room above for the list of settings.
    low = min(errors.min(), max(floor, LEAST_SHOWN))
    high = errors.max()
    axes.set_ylim(0.5 * low, high * (high / low) ** 0.55)
    _percent_over_seconds(axes)


def _alone(axes: Axes, report: AccuracyReport) -> None:
    for place, result in enumerate(report.refinements):
        points = [(each.times.total, judged(each.errors)) for each in result.levels]
        points = [(seconds, error) for seconds, error in points if error > LEAST_SHOWN]
        if not points:
            continue
        order = result.order("T_E")
        expected = result.refinement.expected
        look = {"marker": MARKS[place], "color": PALETTE[place % len(PALETTE)], "markersize": 5.5, "linewidth": 1.3}
        style = ":"
        note = f" ({result.refinement.why})" if result.refinement.name == CONDENSATION else ""
        if expected is not None:
            style = "-"
            note = f" (order {'none' if order is None else f'{order:.1f}'}, expected {expected:g})"
        axes.plot(*zip(*points), style, label=result.refinement.name + note, **look)
    axes.set_xscale("log")
    axes.set_yscale("log")
    _percent_over_seconds(axes)
    axes.set_ylabel(_of_all_judged(report))
    axes.set_title("Each setting alone, all others fine")
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.1), ncol=_columns(report), fontsize=9.5, columnspacing=1.0)


def _columns(report: AccuracyReport) -> int:
    return plan_of(report.scene).columns


def _of_all_judged(report: AccuracyReport) -> str:
    words = judged_by(report).replace("T_EPP", "T$_{EPP}$").replace("T_E", "T$_E$")
    return f"Relative error (%), the largest of those of {words}"


def _percent_over_seconds(axes: Axes) -> None:
    axes.set_xlabel("Time of a run (s, median; meshing, condensing, time stepping)")
    plain = FuncFormatter(lambda value, _: f"{value:g}")
    axes.xaxis.set_major_formatter(plain)
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{100 * value:g}"))
    narrow = np.ptp(np.log10(axes.get_xlim())) < 1.0
    axes.xaxis.set_minor_locator(LogLocator(subs=range(2, 10) if narrow else (2, 5)))
    axes.xaxis.set_minor_formatter(plain)
    axes.tick_params(axis="x", which="minor", labelsize=9)


def _words(figure: Figure, report: AccuracyReport) -> None:
    measured_heading(figure, "What accuracy costs in time", report.scene)
    sentence = "\n".join(textwrap.wrap(in_one_sentence(report), 165))
    measured = f"{in_words(report.machine)}; timed runs: {report.own.times.rounds}"
    figure.text(0.008, 0.012, f"{sentence}\n{measured}", fontsize=10, color=DARK, parse_math=False)
