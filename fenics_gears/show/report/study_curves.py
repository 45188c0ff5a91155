"""Results over a study's parameters: lines over the field with most values, one for each combination of the others; a map for many."""

from __future__ import annotations

import numpy as np

from fenics_gears.show.panels import PALETTE
from fenics_gears.show.report.cases import Cases, Field
from fenics_gears.show.report.page import Plot
from fenics_gears.show.report.plotting import Curve, escaped, layout, numbers, plot

# What one plot's legend holds; dashes tell apart what has the same colour.
MOST_LINES = 2 * len(PALETTE)
DASHES = ("solid", "dash")
MARKED_POINTS = 200
LOGARITHMIC_SPAN = 8.0
# Pixels; a legend of long names takes more rows than the one that a plot has room for.
HEIGHT, LEGEND_ROW, LETTERS_A_ROW = 340, 19, 120


def result_plots(cases: Cases) -> list[Plot]:
    """A plot for each of the numbers that cases are compared by."""
    return [_result_plot(cases, values, unit, name) for values, unit, name in cases.measures.values() if np.isfinite(values).any()]


def _result_plot(cases: Cases, values: np.ndarray, unit: str, name: str) -> Plot:
    """A plot without the cases beside which all others would be flat."""
    far_off = cases.far_off(values)
    return over_parameter(cases, np.where(far_off, np.nan, values), unit, name, cases.far_off_in_words(far_off))


def effort_plots(cases: Cases) -> list[Plot]:
    """What the cases took."""
    of = {"wall_time": ("s", "Wall time of a case"), "newton_iterations": ("", "Newton iterations of a case")}
    return [
        over_parameter(cases, cases.numbers(name), unit, words)
        for name, (unit, words) in of.items()
        if np.isfinite(cases.numbers(name)).any()
    ]


def over_parameter(cases: Cases, values: np.ndarray, unit: str, name: str, note: str = "") -> Plot:
    """Values (n,) of all cases over the study's parameters; a note of the caller stands before the plot's own."""
    axis = main_field(cases)
    others = [field for field in cases.fields if field is not axis and not _zipped(cases)]
    lines = _lines(cases, axis, others)
    y_title = f"{name} ({unit})" if unit else name
    if len(lines) > MOST_LINES and len(others) == 1 and axis.numeric and others[0].numeric and np.isfinite(others[0].values).all():
        return _map(axis, others[0], values, y_title, name, note)
    if len(lines) > MOST_LINES:
        kept = np.unique(np.linspace(0, len(lines) - 1, MOST_LINES).round().astype(int))
        note = f"{note} {len(kept)} of {len(lines)} combinations are drawn; the table of cases has all.".strip()
        lines = [lines[place] for place in kept]
    if axis.numeric and not np.isfinite(axis.values).all():
        note = f"{note} Cases without {axis.name.replace('_', ' ')} have no place on this axis; the table has them.".strip()
    if _zipped(cases) and len(cases.fields) > 1:
        together = ", ".join(field.path for field in cases.fields if field is not axis)
        note = f"{note} {together} varies along with it.".strip()
    mode = "lines+markers" if max(map(len, (places for _, places in lines)), default=0) <= MARKED_POINTS else "lines"
    curves = [
        Curve(words, axis.values[places], values[places], PALETTE[turn % len(PALETTE)], DASHES[turn // len(PALETTE)], mode=mode)
        for turn, (words, places) in enumerate(lines)
    ]
    drawn = plot(
        f"{name} over {axis.path}",
        curves,
        axis.title,
        y_title,
        note=note,
        height=HEIGHT + LEGEND_ROW * _further_rows([words for words, _ in lines]),
    )
    if logarithmic(axis):
        drawn.figure.update_xaxes(type="log")
    return drawn


def main_field(cases: Cases) -> Field:
    """The swept field with most different numbers; with most different words where none has numbers."""
    numeric = [field for field in cases.fields if field.numeric]
    return max(numeric or cases.fields, key=lambda field: len({value for value in field.values.tolist() if value == value}))


def logarithmic(field: Field) -> bool:
    """Whether the field's values are spaced by a factor rather than by a step."""
    if not field.numeric:
        return False
    values = np.unique(field.values[np.isfinite(field.values)])
    if len(values) < 3 or values[0] <= 0.0 or values[-1] / values[0] < LOGARITHMIC_SPAN:
        return False
    steps, factors = np.diff(values), np.diff(np.log(values))
    return np.ptp(factors) / factors.mean() < np.ptp(steps) / steps.mean()


def _further_rows(names: list[str]) -> int:
    """Rows of a legend beyond its first; plotly sets names in columns as wide as the longest."""
    if len(names) < 2:
        return 0
    columns = max(1, LETTERS_A_ROW // (max(map(len, names)) + 8))
    return -(-len(names) // columns) - 1


def _zipped(cases: Cases) -> bool:
    return cases.dataset["failed"].dims == ("case",)


def _lines(cases: Cases, axis: Field, others: list[Field]) -> list[tuple[str, np.ndarray]]:
    """The places of the cases that lie on one line, with the words for it; along the axis in order."""
    groups: dict[str, list[int]] = {}
    for case in range(cases.count):
        if not axis.numeric or np.isfinite(axis.values[case]):
            groups.setdefault(", ".join(field.setting(case) for field in others), []).append(case)
    in_order = [(words, np.array(places)) for words, places in groups.items()]
    return [
        (words or "cases", places[np.argsort(axis.values[places], kind="stable")] if axis.numeric else places) for words, places in in_order
    ]


def _map(axis: Field, other: Field, values: np.ndarray, title: str, name: str, note: str) -> Plot:
    """The values in colour over two fields."""
    import plotly.graph_objects as go

    x, column = np.unique(axis.values, return_inverse=True)
    y, row = np.unique(other.values, return_inverse=True)
    grid = np.full((len(y), len(x)), np.nan)
    grid[row, column] = values
    colours = {"colorscale": "Viridis", "colorbar": {"title": {"text": escaped(title), "side": "right"}, "thickness": 14}}
    figure = go.Figure(
        go.Heatmap(x=numbers(x), y=numbers(y), z=[numbers(each) for each in grid], hoverongaps=False, **colours),
        layout(axis.title, other.title, legend=False),
    )
    figure.update_layout(hovermode="closest")
    for field, update in ((axis, figure.update_xaxes), (other, figure.update_yaxes)):
        update(showgrid=False, type="log" if logarithmic(field) else "linear")
    return Plot(f"{name} over {axis.path} and {other.path}", figure, f"{note} Blank where a case has no result.".strip(), 420)
