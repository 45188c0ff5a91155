"""Pictures and the summary of an optimisation."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import xarray as xr

from fenics_gears import MICRORADIANS
from fenics_gears.charts import GREY, MARKED_LINES, MARKERS, PALETTE, Chart, Curve, draw_charts, harris_map, shades
from fenics_gears.scene_text import is_train, model_of_tree

from .design import QUANTILE, Goal, Variable
from .evaluations import Evaluation
from .optimize import SearchOutcome, score
from .result import harris_dataset

BEFORE = "before"
BEST = "chosen design"
MOST_TIMES = 3.0
"""Goals above this many times the larger of before and chosen are left out of pictures, which they would flatten."""


def called(name: str) -> str:
    return name.replace(".", " ").replace("_", " ")


def title(name: str, unit: str) -> str:
    """A variable or goal in words with its unit, for an axis."""
    words = sentence(called(name))
    unit = in_symbols(unit)
    return f"{words} ({unit})" if unit not in ("", "1") else words


def in_symbols(unit: str) -> str:
    """A unit as pages and pictures have it."""
    return unit.replace("um", "µm").replace("urad", "µrad")


def sentence(words: str) -> str:
    return words[:1].upper() + words[1:]


def goals_of(evaluations, goal: Goal) -> np.ndarray:
    """A goal of evaluations (n,), NaN where one failed."""
    return np.array([each.goals.get(goal.name, np.nan) for each in evaluations])


def _shown(outcome: SearchOutcome, goal: Goal, values: np.ndarray) -> np.ndarray:
    largest = np.nanmax([outcome.before.goals.get(goal.name, np.nan), outcome.chosen.goals[goal.name]])
    return np.where(values <= MOST_TIMES * largest, values, np.nan)


def search_chart(outcome: SearchOutcome, goal: Goal) -> Chart:
    """A goal of all designs in the order in which they were tried, the least so far, and what it is before."""
    every = goals_of(outcome.tried, goal)
    numbers = np.arange(1, len(outcome.tried) + 1)
    allowed = np.where([each.allowed for each in outcome.tried], every, np.nan)
    least = np.fmin.accumulate(np.where(np.isfinite(allowed), allowed, np.inf))
    curves = [
        Curve("designs", numbers, _shown(outcome, goal, every), GREY, mode=MARKERS),
        Curve("least so far", numbers, _shown(outcome, goal, least), PALETTE[0], width=2.2),
    ]
    if (before := outcome.before.goals.get(goal.name)) is not None:
        curves.append(Curve(BEFORE, numbers[[0, -1]].astype(float), np.full(2, before), PALETTE[1], "dash"))
    axes = "Design, in the order in which they were tried", title(goal.name, goal.unit)
    return Chart(f"{sentence(called(goal.name))} of the designs", curves, *axes, _note(outcome))


def _note(outcome: SearchOutcome) -> str:
    failed = sum(bool(each.failure) for each in outcome.tried)
    return f"{failed} of {len(outcome.tried)} designs failed and are not drawn." if failed else ""


def front_chart(outcome: SearchOutcome) -> Chart:
    """The first two goals of all designs against each other, and the Pareto front."""
    one, other = outcome.design.goals[:2]
    x, y = (_shown(outcome, goal, goals_of(outcome.tried, goal)) for goal in (one, other))
    order = np.array(sorted(outcome.front, key=lambda place: x[place]))
    curves = [
        Curve("designs", x, y, GREY, mode=MARKERS),
        Curve("Pareto front", x[order], y[order], PALETTE[0], mode=MARKED_LINES),
        _mark(BEST, x[outcome.best], y[outcome.best], PALETTE[2]),
    ]
    if before := outcome.before.goals:
        curves.append(_mark(BEFORE, before[one.name], before[other.name], PALETTE[1]))
    axes = title(one.name, one.unit), title(other.name, other.unit)
    return Chart("Goals against each other", curves, *axes, _note(outcome), 380)


def _mark(name: str, x, y: float, colour: str) -> Curve:
    return Curve(name, np.array([x]), np.array([y]), colour, mode=MARKERS)


def variable_chart(outcome: SearchOutcome, variable: Variable, goal: Goal) -> Chart:
    """A goal over a variable: of all designs, and of the chosen one with this variable alone changed."""
    places, evaluations = outcome.along[variable.name]
    x = np.array([each.values[variable.name] for each in outcome.tried])
    scatters = " without scatter" if outcome.design.tolerances.scatters else ""
    alone = f"{BEST}{scatters}, this variable alone changed"
    mode = MARKERS if variable.words else MARKED_LINES
    curves = [
        Curve("designs", x, _shown(outcome, goal, goals_of(outcome.tried, goal)), GREY, mode=MARKERS),
        Curve(alone, np.array(places), goals_of(evaluations, goal), PALETTE[0], mode=mode),
        _mark(BEST, outcome.chosen.values[variable.name], outcome.chosen.goals[goal.name], PALETTE[2]),
    ]
    axes = title(variable.name, variable.unit), title(goal.name, goal.unit)
    return Chart(f"{sentence(called(goal.name))} over {called(variable.name)}", curves, *axes)


def tolerance_rows(outcome: SearchOutcome, goal: Goal) -> list[tuple[str, str, str, str, str]]:
    """Of each scatter its limit, and the chosen design's goal at the lower limit, without scatter, at the upper limit;
    the largest change first."""
    rows = []
    for scatter in outcome.design.tolerances.scatters if outcome.limits else ():
        low, nominal, high = numbers = outcome.limits[scatter.name][goal.name]
        row = (
            called(scatter.name),
            f"± {scatter.limit:.4g} {scatter.unit}".strip(),
            *(f"{each:.4g}" for each in numbers),
        )
        rows.append((max(abs(low - nominal), abs(high - nominal)), row))
    return [row for _, row in sorted(rows, key=lambda each: -each[0])]


def harris_charts(outcome: SearchOutcome) -> list[Chart]:
    """The Harris maps before and after, to the same scale; none where a run failed."""
    maps = harris_dataset(outcome)
    if "transmission_error" not in maps:
        return []
    before = model_of_tree("", outcome.design.before, outcome.design.directory)
    maps.attrs["base_radius_wheel"] = abs(before.models[-1].pair.wheel.base_radius)
    draw = _lags if is_train(outcome.design.before) else harris_map
    charts = [
        draw(maps.sel(choice=choice).drop_vars("choice"), f"Harris map, {words}")
        for choice, words in (("before", BEFORE), ("best", BEST))
    ]
    every = np.concatenate([curve.y for chart in charts for curve in chart.curves])
    room = 0.04 * np.ptp(every)
    return [replace(chart, y_range=(float(every.min() - room), float(every.max() + room))) for chart in charts]


def _lags(maps: xr.Dataset, caption: str) -> Chart:
    """The overall transmission errors of a train over its torque. Its meshes have cycles of their own, so that it does
    not repeat after one of them."""
    cycles = maps["mesh_phase"].values
    colours = shades(maps.sizes["load"])
    curves = [
        Curve(f"{load:.4g} N m", cycles, MICRORADIANS * maps["transmission_error"].sel(load=load).values, colour)
        for load, colour in zip(maps["load"].values, colours)
    ]
    return Chart(caption, curves, "Time (cycles of the first mesh)", "Lag of the last shaft (µrad)", height=420)


def write_pictures(outcome: SearchOutcome) -> list[Path]:
    """Draw all charts as PNG, and return the files."""
    design = outcome.design
    first = outcome.design.goals[0]
    charts = {
        "search": [search_chart(outcome, goal) for goal in design.goals],
        "pareto_front": [front_chart(outcome)] if len(design.goals) > 1 else [],
        "variables": [variable_chart(outcome, variable, first) for variable in design.variables],
        "harris_map": harris_charts(outcome),
    }
    pictures = {f"{name}.png": ("Optimisation", drawn) for name, drawn in charts.items() if drawn}
    return draw_charts(pictures, outcome.directory, design.title)


def goal_words(outcome: SearchOutcome, goal: Goal, evaluation: Evaluation) -> str:
    """A goal of an evaluation in words, with mean and quantile where there are tolerances."""
    if evaluation.failure:
        return f"none: {evaluation.failure}"
    tolerances = outcome.design.tolerances
    if not tolerances.scatters:
        return f"{evaluation.goals[goal.name]:.4g}"
    values = evaluation.of_samples[goal.name]
    quantile = f"{100 * tolerances.quantile:g} % below {np.quantile(values, tolerances.quantile):.4g}"
    words = f"mean {np.mean(values):.4g}", quantile
    return ", ".join(words[::-1] if tolerances.judged == QUANTILE else words)


def no_gain(outcome: SearchOutcome) -> str:
    """A warning where the chosen design is not better than what is before; empty where it is."""
    before = outcome.before
    design = outcome.design
    if before.failure or score(design, before, outcome.chosen) < score(design, before, before):
        return ""
    return "The chosen design is not better than the scene before: try more designs, other variables or wider ranges."


def summary_rows(outcome: SearchOutcome) -> list[tuple[str, str, str]]:
    """Rows of label, value, unit: what was tried and computed, goals before and after, and the chosen values."""
    failed = sum(bool(each.failure) for each in outcome.tried)
    rows = [
        ("designs", f"{len(outcome.tried)}" + (f", {failed} failed" if failed else ""), ""),
        *outcome.spent.rows(outcome.kept),
    ]
    compared = {f", {BEFORE}": outcome.before, f", {BEST}": outcome.chosen}
    compared |= {f" under new samples{words}": each for words, each in zip(compared, outcome.fresh)}
    rows += [
        (f"{called(goal.name)}{words}", goal_words(outcome, goal, each), goal.unit.removeprefix("1"))
        for goal in outcome.design.goals
        for words, each in compared.items()
    ]
    for variable in outcome.design.variables:
        value = outcome.chosen.values[variable.name]
        rows.append((called(variable.name), value if variable.words else f"{value:.4g}", variable.unit))
    return [*rows, ("remark", no_gain(outcome), "")] if no_gain(outcome) else rows
