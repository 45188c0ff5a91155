"""The report of `gears accuracy` as tables, in words, and as CSV."""

from math import isnan
from pathlib import Path

from fenics_gears.measuring import OVER_FACE, STAGES, Times, judged, measures_of

from ..machine import write_lines
from .convergence import largest_part
from .refinement import CONDENSATION
from .report import AccuracyReport, RefinementResult, WholeResult

# Measures whose observed orders are shown.
ORDERED = ("T_E", "T_EPP", "root stress")
TARGETS = (0.01, 0.001)
# An order further than this from the expected one gets a remark; a setting whose errors are all below this, relative,
# has no influence.
ORDER_OFF = 0.5
NO_INFLUENCE = 1e-6


def headings(report: AccuracyReport) -> list[tuple[str, ...]]:
    names = measures_of(report.uncertainty)
    words = ("setting", "value", *names, "time", "order T_E", *ORDERED[1:], "expected")
    return [words, ("", "", *["%"] * len(names), "s", *[""] * len(ORDERED), "")]


def whole_headings(report: AccuracyReport) -> list[tuple[str, ...]]:
    names = measures_of(report.uncertainty)
    stages = "meshing", "condensing", "time stepping", "time"
    words = ("settings", "total error", *names, *stages, "what limits it")
    return [words, ("", "%", *["%"] * len(names), *["s"] * len(stages), "")]


def judged_by(report: AccuracyReport) -> str:
    return "T_E, T_EPP and line loads" if any(name in OVER_FACE for name in report.uncertainty) else "T_E and T_EPP"


def table_rows(report: AccuracyReport) -> list[tuple[str, ...]]:
    """A row for each level; a setting's name and orders are in its first."""
    rows = []
    for result in report.refinements:
        for place, each in enumerate(result.levels):
            orders = _orders(result) if place == 0 else ("",) * (len(ORDERED) + 1)
            label = each.level.label + (f" ({each.level.own})" if each.level.own else "")
            rows.append((
                result.refinement.name if place == 0 else "", label,
                *(percent(each.errors[name]) for name in measures_of(report.uncertainty)), seconds(each.times.total),
                *orders,
            ))  # fmt: skip
    return rows


def whole_rows(report: AccuracyReport) -> list[tuple[str, ...]]:
    """A row for each combination of settings and each cheaper model; rows of the Pareto front are marked."""
    front = report.front
    rows = []
    for each in (*report.settings, *report.targets, *report.models):
        name = each.name + (" *" if each in front else "")
        times = (seconds(each.times.median(stage)) for stage in STAGES)
        rows.append((
            name, percent(each.total_error),
            *(percent(each.errors[measure]) for measure in measures_of(report.uncertainty)), *times,
            seconds(each.times.total), limits_it(each),
        ))  # fmt: skip
    return rows


def _orders(result: RefinementResult) -> tuple[str, ...]:
    if result.refinement.expected is None:
        return ("",) * (len(ORDERED) + 1)
    return *(_order(result.order(name)) for name in ORDERED), f"{result.refinement.expected:g}"


def _order(order: float | None) -> str:
    return "none" if order is None else f"{order:.2f}"


def percent(error: float) -> str:
    """A relative error in percent; round-off is zero."""
    if isnan(error):
        return "-"
    return "0" if error < 1e-9 else f"{100 * error:.0f}" if error > 0.995 else f"{100 * error:.2g}"


def seconds(time: float) -> str:
    return f"{time:.2g}" if time < 100 else f"{time:.0f}"


def limits_it(each: WholeResult) -> str:
    """The setting with the largest error; nothing of a target's settings, whose parts are not known."""
    return largest_part(each.parts) if each.parts else "" if each.target else "the model"


def in_one_sentence(report: AccuracyReport) -> str:
    """What an error of 1 % and of 0.1 % costs, and what limits the scene's own setting."""
    costs = ". ".join(_cost(report, target) for target in TARGETS if target >= report.floor)
    missed = [f"{100 * target:g} %" for target in TARGETS if target < report.floor]
    if missed:
        unknown = (
            f"{' and '.join(missed)} cannot be assessed, since the reference is uncertain by {percent(report.floor)} %"
        )
        costs = ". ".join(filter(None, (costs, unknown, _best(report) if len(missed) == len(TARGETS) else "")))
    mine = report.own
    worst = largest_part(mine.parts)
    own = (
        f"The scene's own settings have an error of {percent(mine.total_error)} %, of which"
        f" {percent(mine.parts[worst])} % is due to the {worst}"
    )
    plain = report.defaults
    default = (
        f". The default settings have an error of {percent(plain.total_error)} % and cost"
        f" {seconds(plain.times.total)} s"
        if plain
        else ""
    )
    return f"{costs}. {own}{default}."


def _cost(report: AccuracyReport, target: float) -> str:
    words = f"{100 * target:g} % in {judged_by(report)}"
    reached = [each for each in report.front if each.total_error <= target]
    if reached:
        return f"{words} costs {seconds(reached[0].times.total)} s ({reached[0].name})"
    return f"{words} was not reached. {_best(report)}"


def _best(report: AccuracyReport) -> str:
    best = report.front[-1]
    return (
        f"The best settings that were run have an error of {percent(max(best.total_error, report.floor))} % and cost"
        f" {seconds(best.times.total)} s"
    )


def remarks(report: AccuracyReport) -> list[str]:
    sentences = [
        (
            f"the reference (Richardson's limits of all settings together) is uncertain by {percent(report.floor)} % in"
            f" {judged_by(report)}; smaller errors cannot be assessed"
        ),
        (
            "the error of a single setting is measured with all others fine; the total error is the sum of these"
            " errors, or the difference from the reference where that is larger"
        ),
    ]
    for result in report.refinements:
        order = result.order("T_E")
        if result.refinement.expected is None:
            continue
        if max(each.errors["T_E"] for each in result.levels) < NO_INFLUENCE:
            sentences.append(
                f"{result.refinement.name}: T_E at the steps does not depend on it ({result.refinement.why}); T_EPP is"
                " located between the steps"
            )
        elif order is None:
            sentences.append(
                f"{result.refinement.name}: no order in T_E, expected {result.refinement.expected:g}"
                f" ({result.refinement.why}); the error of its finest value is taken to be its last change"
            )
        elif abs(order - result.refinement.expected) > ORDER_OFF:
            sentences.append(
                f"{result.refinement.name}: order {order:.2f} in T_E, expected {result.refinement.expected:g}"
                f" ({result.refinement.why})"
            )
    if any(result.refinement.name == CONDENSATION for result in report.refinements):
        sentences.append(
            'condensation "every step" is another model, not a finer one: normal forces have the lever arms of their'
            " nodes in place of the base radius. Its difference does not vanish with refinement"
        )
    peak = report.uncertainty["peak pressure"]
    if peak > 0.1:
        sentences.append(
            f"the peak pressure does not converge in these runs (it is uncertain by {percent(peak)} %); contact at a"
            " sharp tip edge is a usual cause"
        )
    return sentences


def timed(report: AccuracyReport) -> str:
    return (
        f"Times of combinations of settings are medians of {report.rounds} rounds, in turns. Single settings were timed"
        " once."
    )


def write_csv(report: AccuracyReport, file: Path) -> None:
    uncertain = {"kind": "reference", "name": "uncertainty", **_errors(report.uncertainty)}
    failed = [{"kind": "failed", "name": name, "setting": reason} for name, reason in report.failures]
    write_lines(file, [*_level_lines(report), *_whole_lines(report), uncertain, *failed], report.machine)


def _level_lines(report: AccuracyReport):
    for result in report.refinements:
        orders = {f"order_{name.replace(' ', '_')}": result.order(name) for name in ORDERED} | {
            "order_expected": result.refinement.expected
        }
        for each in result.levels:
            yield {
                "kind": "single setting", "name": result.refinement.name, "setting": each.level.label,
                "size": each.level.size, "own": each.level.own,
                **_errors(each.errors), **_times(each.times), **orders,
            }  # fmt: skip


def _whole_lines(report: AccuracyReport):
    for each in (*report.settings, *report.targets, *report.models):
        words = each.setting.words if each.setting else ""
        kind = "setting" if each.setting else "model"
        yield {
            "kind": kind, "name": each.name, "setting": words, **_errors(each.errors), "total_error": each.total_error,
            **_times(each.times),
            "on_front": int(each in report.front), "limited_by": limits_it(each),
        }  # fmt: skip


def _errors(errors: dict[str, float]) -> dict[str, float]:
    return {f"error_{name.replace(' ', '_')}": errors[name] for name in measures_of(errors)} | {
        "judged_error": judged(errors)
    }


def _times(times: Times) -> dict[str, float]:
    return {f"time_{stage}_s": times.median(stage) for stage in STAGES} | {
        "time_s": times.total,
        "timed_runs": times.rounds,
    }
