"""A report as a table for people, in words, and as CSV."""

from __future__ import annotations

import csv
from math import isnan
from pathlib import Path

from fenics_gears.studies.accuracy.measured import KnobResult, Report, WholeResult
from fenics_gears.studies.accuracy.measures import MEASURES, judged
from fenics_gears.studies.accuracy.timing import STAGES, Times
from fenics_gears.studies.accuracy.whole import dominant

# Measures whose orders are told.
ORDERED = ("T_E", "T_EPP", "root stress")
HEADINGS = ("knob", "setting", *MEASURES, "time", "order T_E", *ORDERED[1:], "expected")
UNITS = ("", "", *["%"] * len(MEASURES), "s", *[""] * len(ORDERED), "")
WHOLE_HEADINGS = ("whole setting", "charged", *MEASURES, "mesh", "condense", "march", "time", "what limits it")
WHOLE_UNITS = ("", "%", *["%"] * len(MEASURES), "s", "s", "s", "s", "")
TARGETS = (0.01, 0.001)
# An order this far from the expected one is said.
ORDER_OFF = 0.5


def table_rows(report: Report) -> list[tuple[str, ...]]:
    """A row for each rung; a knob's name and orders stand in its first."""
    rows = []
    for result in report.knobs:
        for place, rung in enumerate(result.rungs):
            orders = _orders(result) if place == 0 else ("",) * (len(ORDERED) + 1)
            label = rung.rung.label + (" (scene)" if rung.rung.own else "")
            rows.append((
                result.knob.name if place == 0 else "", label, *(percent(rung.errors[name]) for name in MEASURES), seconds(rung.times.total), *orders,
            ))  # fmt: skip
    return rows


def whole_rows(report: Report) -> list[tuple[str, ...]]:
    """A row for each whole setting and cheaper model; those that pay are marked."""
    front = report.front
    rows = []
    for each in (*report.settings, *report.models):
        name = each.name + (" *" if each in front else "")
        times = (seconds(each.times.median(stage)) for stage in STAGES)
        rows.append((
            name, percent(each.counted), *(percent(each.errors[measure]) for measure in MEASURES), *times, seconds(each.times.total), limits_it(each),
        ))  # fmt: skip
    return rows


def _orders(result: KnobResult) -> tuple[str, ...]:
    if result.knob.expected is None:
        return ("",) * (len(ORDERED) + 1)
    return *(_order(result.order(name)) for name in ORDERED), f"{result.knob.expected:g}"


def _order(order: float | None) -> str:
    return "none" if order is None else f"{order:.2f}"


def percent(error: float) -> str:
    """A relative error in percent; round-off is zero."""
    if isnan(error):
        return "-"
    return "0" if error < 1e-9 else f"{100 * error:.0f}" if error > 0.995 else f"{100 * error:.2g}"


def seconds(time: float) -> str:
    """A time as people read it."""
    return f"{time:.2g}" if time < 100 else f"{time:.0f}"


def limits_it(each: WholeResult) -> str:
    """The knob with the largest error; nothing for a cheaper model."""
    return dominant(each.parts) if each.parts else "the model"


def in_one_sentence(report: Report) -> str:
    """What the user wants to know: what an error costs, and what limits her own setting."""
    costs = "; ".join(_cost(report, target) for target in TARGETS if target >= report.floor)
    missed = [f"{100 * target:g} %" for target in TARGETS if target < report.floor]
    if missed:
        told = f"{' and '.join(missed)} cannot be told, for the reference itself is uncertain by {percent(report.floor)} %"
        costs = "; ".join(filter(None, (costs, told, _best(report) if len(missed) == len(TARGETS) else "")))
    mine = report.own
    worst = dominant(mine.parts)
    return f"{costs}; what limits you is the {worst} ({percent(mine.parts[worst])} of your {percent(mine.counted)} %)."


def _cost(report: Report, target: float) -> str:
    words = f"{100 * target:g} % in T_E and T_EPP"
    reached = [each for each in report.front if each.counted <= target]
    if reached:
        return f"{words} costs {seconds(reached[0].times.total)} s ({reached[0].name})"
    return f"{words} is out of reach of these rungs, {_best(report)}"


def _best(report: Report) -> str:
    best = report.front[-1]
    return f"the best of them, {percent(max(best.counted, report.floor))} %, costs {seconds(best.times.total)} s"


def remarks(report: Report) -> list[str]:
    """What the reader must know beside the numbers."""
    found = [
        f"the reference, Richardson's limits of all knobs together, is uncertain by {percent(report.floor)} % in T_E and T_EPP: less cannot be told",
        "a knob's error is measured with all others fine; a whole setting is charged their sum, or its own distance from the reference if that is more",
    ]
    for result in report.knobs:
        order = result.order("T_E")
        if result.knob.expected is None:
            continue
        if order is None:
            found.append(f"{result.knob.name}: no order in T_E, expected {result.knob.expected:g} ({result.knob.why}); its finest rung is charged its last change")
        elif abs(order - result.knob.expected) > ORDER_OFF:
            found.append(f"{result.knob.name}: order {order:.2f} in T_E, expected {result.knob.expected:g} ({result.knob.why})")
    if any(result.knob.base for result in report.knobs):
        found.append(
            'condensation "every step" is another model, no finer one: forces have the arms of their nodes, where the other route has the '
            "involute's; the difference, in one setting less fine than the others', does not go away with refinement"
        )
    peak = report.uncertainty["peak pressure"]
    if peak > 0.1:
        found.append(f"the peak pressure has no limit that these rungs show ({percent(peak)} % uncertain): as where a tip's edge presses")
    return found


def timed(report: Report) -> str:
    """How often things were timed."""
    rungs = [each.times.rounds for result in report.knobs for each in result.rungs]
    again = sum(rounds >= report.rounds for rounds in rungs)
    words = f"Whole settings timed {report.rounds} times in turns, medians; "
    if again == len(rungs):
        return words + "settings of single knobs as often."
    return words + (
        f"{again} of {len(rungs)} settings of single knobs as often, the others, which take longest, once: "
        f"all rounds of all of them would have taken more than the {report.seconds_on_rungs:g} s that were given."
    )


CSV_COLUMNS = (
    "kind", "name", "setting", "size", "own", *(f"error_{name.replace(' ', '_')}" for name in MEASURES), "judged_error", "charged_error",
    "time_mesh_s", "time_condense_s", "time_march_s", "time_s", "timed_runs", *(f"order_{name.replace(' ', '_')}" for name in ORDERED),
    "order_expected", "on_front",
    "limited_by", "processor", "load", "threads", "versions",
)  # fmt: skip


def write_csv(report: Report, file: Path) -> None:
    """All numbers: a line for each rung, whole setting, cheaper model, the reference's uncertainty, and what did not run."""
    with open(file, "w", encoding="utf-8", newline="") as opened:
        writer = csv.DictWriter(opened, CSV_COLUMNS, restval="")
        writer.writeheader()
        for line in (*_rung_lines(report), *_whole_lines(report)):
            writer.writerow({**line, **report.machine})
        uncertain = _errors(report.uncertainty)
        writer.writerow({"kind": "reference", "name": "uncertainty", **uncertain, **report.machine})
        for name, reason in report.failures:
            writer.writerow({"kind": "failed", "name": name, "setting": reason, **report.machine})


def _rung_lines(report: Report):
    for result in report.knobs:
        orders = {f"order_{name.replace(' ', '_')}": result.order(name) for name in ORDERED} | {"order_expected": result.knob.expected}
        for each in result.rungs:
            yield {
                "kind": "knob", "name": result.knob.name, "setting": each.rung.label, "size": each.rung.size, "own": int(each.rung.own),
                **_errors(each.errors), **_times(each.times), **orders,
            }  # fmt: skip


def _whole_lines(report: Report):
    for each in (*report.settings, *report.models):
        words = each.setting.words if each.setting else ""
        kind = "setting" if each.setting else "model"
        yield {
            "kind": kind, "name": each.name, "setting": words, **_errors(each.errors), "charged_error": each.counted, **_times(each.times),
            "on_front": int(each in report.front), "limited_by": limits_it(each),
        }  # fmt: skip


def _errors(errors: dict[str, float]) -> dict[str, float]:
    return {f"error_{name.replace(' ', '_')}": errors[name] for name in MEASURES} | {"judged_error": judged(errors)}


def _times(times: Times) -> dict[str, float]:
    return {f"time_{stage}_s": times.median(stage) for stage in STAGES} | {"time_s": times.total, "timed_runs": times.rounds}
