"""Results over a study's parameters: lines over the field with most values; a map for many."""

from itertools import product
from typing import Any

import numpy as np

from .cases import OF_MESH, Cases, SweptField
from .chart import LINES, MARKED_LINES, Chart, Curve, Field
from .panels import LOW_TO_HIGH, PALETTE
from .quantile_charts import has_samples, quantile_chart

# What one plot's legend holds; dashes tell apart what has the same colour.
MOST_LINES = 2 * len(PALETTE)
DASHES = ("solid", "dash")
MARKED_POINTS = 200
LOGARITHMIC_SPAN = 8.0
HEIGHT = 340


def result_charts(cases: Cases) -> dict[str, Chart]:
    """A chart for each of the numbers that cases are compared by, by the number's name."""
    return {
        key: _result_chart(cases, values, unit, name)
        for key, (values, unit, name) in cases.measures.items()
        if np.isfinite(values).any()
    }


def _result_chart(cases: Cases, values: np.ndarray, unit: str, name: str) -> Chart:
    far_off = cases.far_off(values)
    drawn = quantile_chart if has_samples(cases) else over_parameter
    return drawn(cases, np.where(far_off, np.nan, values), unit, name, cases.far_off_in_words(far_off))


def effort_charts(cases: Cases) -> list[Chart]:
    """Wall time and Newton iterations of the cases."""
    of = {"wall_time": ("s", "Wall time of a case"), "newton_iterations": ("", "Newton iterations of a case")}
    return [
        over_parameter(cases, cases.numbers(name), unit, words)
        for name, (unit, words) in of.items()
        if np.isfinite(cases.numbers(name)).any()
    ]


def over_parameter(cases: Cases, values: np.ndarray, unit: str, name: str, note: str = "") -> Chart:
    """Values (n,) of all cases over the study's parameters; a note of the caller comes before the plot's own."""
    axis = main_field(cases)
    others = [field for field in cases.fields if field is not axis and not _zipped(cases)]
    lines = _lines(cases, axis, others)
    # The heading has the mesh.
    short = name.partition(OF_MESH)[0]
    y_title = f"{short} ({unit})" if unit else short
    if len(lines) > MOST_LINES:
        two = len(others) == 1 and axis.numeric and others[0].numeric
        if two and np.isfinite(others[0].values).all():
            return _map(axis, others[0], values, y_title, name, note)
        kept = np.unique(np.linspace(0, len(lines) - 1, MOST_LINES).round().astype(int))
        note = f"{note} {len(kept)} of {len(lines)} combinations are drawn; the table of cases has all.".strip()
        lines = [lines[place] for place in kept]
    if axis.numeric and not np.isfinite(axis.values).all():
        note = f"{note} Cases without {axis.called} have no place on this axis; the table has them.".strip()
    if _zipped(cases) and len(cases.fields) > 1:
        together = ", ".join(field.called for field in cases.fields if field is not axis)
        note = f"{note} {together} changes along with it.".strip()
    mode = MARKED_LINES if max(map(len, (places for _, places in lines)), default=0) <= MARKED_POINTS else LINES
    looks = product(DASHES, PALETTE)
    curves = [
        Curve(words, axis.values[places], values[places], colour, dash, mode=mode)
        for (words, places), (dash, colour) in zip(lines, looks)
    ]
    divided = "x" if logarithmic(axis) else ""
    return Chart(f"{name}{_against(name, axis)}", curves, axis.title, y_title, note, HEIGHT, logarithmic=divided)


def _against(name: str, axis: SweptField) -> str:
    """ "Mean over mesh frequency" would read as an average over it."""
    return f"{',' if ',' in name else ''} against {axis.called}"


def main_field(cases: Cases) -> SweptField:
    """The swept field with most different numbers, or words where none has numbers."""
    numeric = [field for field in cases.fields if field.numeric]

    def different(field: SweptField) -> int:
        return len({value for value in field.values.tolist() if value == value})

    return max(numeric or cases.fields, key=different)


def logarithmic(field: SweptField) -> bool:
    """Whether the field's values are spaced by a factor rather than by a step."""
    if not field.numeric:
        return False
    values = np.unique(field.values[np.isfinite(field.values)])
    if len(values) < 3 or values[0] <= 0.0 or values[-1] / values[0] < LOGARITHMIC_SPAN:
        return False
    steps = np.diff(values)
    factors = np.diff(np.log(values))
    return np.ptp(factors) / factors.mean() < np.ptp(steps) / steps.mean()


def _zipped(cases: Cases) -> bool:
    return cases.dataset["failed"].dims == ("case",)


def _lines(cases: Cases, axis: SweptField, others: list[SweptField]) -> list[tuple[str, np.ndarray]]:
    groups: dict[str, list[int]] = {}
    for case in range(cases.count):
        if not axis.numeric or np.isfinite(axis.values[case]):
            groups.setdefault(", ".join(field.setting(case) for field in others), []).append(case)
    lines = []
    for words, cases_of_line in groups.items():
        places = np.array(cases_of_line)
        if axis.numeric:
            places = places[np.argsort(axis.values[places], kind="stable")]
        lines.append((words or "cases", places))
    return lines


def _map(axis: SweptField, other: SweptField, values: np.ndarray, title: str, name: str, note: str) -> Chart:
    (x, column), (y, row) = (np.unique(field.values, return_inverse=True) for field in (axis, other))
    grid = np.full((len(y), len(x)), np.nan)
    grid[row, column] = values
    edges = []
    divided = ""
    for letter, field, places in (("x", axis, x), ("y", other, y)):
        divided += letter if logarithmic(field) else ""
        edges.append(np.exp(_edges(np.log(places))) if logarithmic(field) else _edges(places))
    drawn = Field(edges[0], edges[1], grid, title, float(np.nanmax(values)), LOW_TO_HIGH)
    options: dict[str, Any] = {"logarithmic": divided, "field": drawn}
    for letter, each in zip("xy", edges):
        options[f"{letter}_range"] = (float(each[0]), float(each[-1]))
    words = f"{note} {'Blank where a case has no result.' if np.isnan(grid).any() else ''}".strip()
    caption = f"{name}{_against(name, axis)} and {other.called}"
    return Chart(caption, [], axis.title, other.title, words, 420, **options)


def _edges(places: np.ndarray) -> np.ndarray:
    """Half-way between places (n,), and as far beyond the first and the last."""
    if len(places) == 1:
        return places[0] + np.array([-0.5, 0.5])
    half = 0.5 * np.diff(places)
    return np.concatenate([[places[0] - half[0]], places[:-1] + half, [places[-1] + half[-1]]])
