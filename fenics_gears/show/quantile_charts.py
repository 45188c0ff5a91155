"""Results of a study with random fields: quantiles of all samples over a field that is not random, or the share of
samples below a value."""

import numpy as np

from fenics_gears.studies.axis import SAMPLE
from fenics_gears.studies.quantiles import QUANTILES, sorted_quantiles

from .cases import Cases, SweptField
from .chart import LINES, MARKED_LINES, Chart, Curve
from .panels import PALETTE

HEIGHT = 340
DASHES = ("solid", "dash", "dot")
# Of the first so many combinations of further fields quantiles are drawn.
MOST_SETTINGS = 3


def has_samples(cases: Cases) -> bool:
    """Whether some fields of a study are random."""
    return SAMPLE in cases.dataset["failed"].dims


def quantile_chart(cases: Cases, values: np.ndarray, unit: str, name: str, note: str = "") -> Chart:
    """Values (n,) of all cases as quantiles over their samples; a note of the caller comes before the chart's own."""
    samples = cases.dataset.sizes[SAMPLE]
    grouped = values.reshape(-1, samples)
    firsts = np.arange(len(grouped)) * samples
    fields = [field for field in cases.fields if not _is_random(cases, field)]
    axis = max((field for field in fields if field.numeric), key=lambda field: len(set(field.values)), default=None)
    random = _in_words([field for field in cases.fields if _is_random(cases, field)])
    said = f"{note} {samples} samples of {random}.".strip()
    title = f"{name} ({unit})" if unit else name
    if axis is None or len(grouped) == 1:
        return _shares(cases, fields, grouped, firsts, (name, title, said))
    lines: dict[str, list[int]] = {}
    for group, first in enumerate(firsts):
        words = ", ".join(field.setting(first) for field in fields if field is not axis)
        lines.setdefault(words, []).append(group)
    quantiles = np.array([sorted_quantiles(each) for each in grouped])
    curves = []
    for (words, groups), dash in zip(lines.items(), DASHES):
        places = sorted(groups, key=lambda group: axis.values[firsts[group]])
        x = axis.values[firsts[places]]
        for number, part in enumerate(QUANTILES):
            label = ", ".join(filter(None, (f"{100.0 * part:.0f} %", words)))
            curves.append(Curve(label, x, quantiles[places, number], PALETTE[number], dash, mode=MARKED_LINES))
    if len(lines) > MOST_SETTINGS:
        said += f" {MOST_SETTINGS} of {len(lines)} combinations are drawn."
    return Chart(f"{name}, quantiles against {axis.called}", curves, axis.title, title, said, HEIGHT)


def _shares(
    cases: Cases, fields: list[SweptField], grouped: np.ndarray, firsts: np.ndarray, words: tuple[str, str, str]
) -> Chart:
    """The share of samples (g, s) below each value, a line for each setting of the other fields."""
    name, title, note = words
    curves = []
    for values, first, colour in zip(grouped, firsts, PALETTE):
        known = np.sort(values[np.isfinite(values)])
        share = (np.arange(len(known)) + 0.5) / max(len(known), 1)
        label = ", ".join(field.setting(first) for field in fields) or "samples"
        curves.append(Curve(label, known, share, colour, "solid", mode=LINES))
    if len(grouped) > len(curves):
        note += f" {len(curves)} of {len(grouped)} combinations are drawn."
    return Chart(f"{name}, distribution", curves, title, "share of samples below", note, HEIGHT)


def _in_words(fields: list[SweptField]) -> str:
    """Fields with their units, without the name of the stage where all are of one."""
    parts = [field.path.split(".") for field in fields]
    stages = {each[1] if each[0] == "stages" else "" for each in parts}
    one = f"{stages.pop()} " if len(stages) == 1 else ""
    return ", ".join(field.title.removeprefix(one) for field in fields)


def _is_random(cases: Cases, field: SweptField) -> bool:
    return SAMPLE in cases.dataset[field.name].dims
