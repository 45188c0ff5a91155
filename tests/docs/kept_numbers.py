"""Tables of docs/evidence made of the numbers kept in docs/pictures, which were measured once; `python -m
tests.docs.write` writes them."""

import csv
from importlib import import_module
from statistics import median
from unittest.mock import patch

from matplotlib.figure import Figure
from tests.benchmarks.third_dimension.__main__ import NAMES
from tests.docs.blocks import ROOT
from tests.docs.markdown import table

EVIDENCE, PICTURES = ROOT / "docs" / "evidence", ROOT / "docs" / "pictures"
SCENES = {
    "quasi_static_friction": "quasi-static, with friction",
    "quasi_static_frictionless": "quasi-static, without friction",
    "200_hz_friction": "200 Hz, with friction",
    "200_hz_frictionless": "200 Hz, without friction",
}
SETTINGS = (
    "flank elements and contact nodes",
    "flank element size",
    "contact node spacing",
    "body element size",
    "steps per mesh cycle",
)
STAGES = {
    "mesh": "meshing",
    "assemble": "assembling",
    "schur": "Schur complement",
    "ring": "joining the ring of sectors",
    "fourier": "the same by Fourier transform",
    "clock": "condensing",
    "condense": "condensing",
    "factor": "MUMPS's factor",
    "operators": "contact operators",
    "solving": "solving the steps",
    "friction": "solving the steps with friction",
}
# The most that settings for a target should cost, in the cheapest that reach it.
TWICE = 2.0
MEASURES = {"": "time", "arrays": "memory", "peak": "most memory of the process", "operations": "operations"}
Rows = list[dict[str, str]]


def rows(name: str) -> Rows:
    with open(PICTURES / f"{name}.csv", encoding="utf-8", newline="") as opened:
        return list(csv.DictReader(opened))


def percent(part: str) -> str:
    """A part of 1 in per cent, two digits."""
    return f"{100.0 * float(part):.2g} %"


def cheapest(lines: Rows, target: float) -> str:
    """The quickest settings on the Pareto front with at most this error, with their time."""
    reaching = [line for line in lines if line["on_front"] == "1" and float(line["total_error"]) <= target]
    best = min(reaching, key=lambda line: float(line["time_s"]))
    return f"{float(best['time_s']):.2g} s ({best['setting']})"


def accuracy() -> str:
    """What 1 % and 0.1 % cost for each of the paper's scenes, and the error of the default settings."""
    lines = []
    for name, title in SCENES.items():
        own = rows(f"accuracy_{name}")
        default = next(line for line in own if line["name"] == "the program's defaults")
        cells = (cheapest(own, 0.01), cheapest(own, 0.001), percent(default["total_error"]), default["limited_by"])
        lines.append([title, *cells, percent(own[-1]["judged_error"])])
    headings = ["scene", "1 % costs", "0.1 % costs", "defaults err by", "its largest part", "reference uncertain by"]
    return "\n".join(table(headings, lines))


def orders() -> str:
    """The order of T_E as each setting is refined, and its error at the finest value."""
    lines = []
    for setting in SETTINGS:
        finest = [[line for line in rows(f"accuracy_{name}") if line["name"] == setting][-1] for name in SCENES]
        cells = (
            f"{float(line['order_T_E']):.1f}; {percent(line['error_T_E'])}" if line["order_T_E"] else "no error"
            for line in finest
        )
        lines.append([setting, "2", *cells])
    return "\n".join(table(["setting", "expected", *SCENES.values()], lines))


def target() -> str:
    """What targets in the plane are worth: how many were reached, how near errors came, what settings cost."""
    found, lines = rows("target_of_pairs"), []
    for target in sorted({line["target, %"] for line in found}, key=float, reverse=True):
        own = [line for line in found if line["target, %"] == target]
        parts = [float(line["true, %"]) / float(target) for line in own]
        choosing, ratios = (
            [float(line[name]) for line in own if line[name]] for name in ("choosing, in runs", "ratio")
        )
        lines.append(
            [
                f"{target} %",
                f"{sum(part <= 1.0 for part in parts)} of {len(own)}",
                f"{median(parts):.2f}, {max(parts):.2f}",
                f"{median(ratios):.1f}, {max(ratios):.1f}",
                f"{sum(ratio > TWICE for ratio in ratios)} of {len(ratios)}",
                f"{median(choosing):.1f}",
            ]
        )
    names = ["target", "reached", "true / target, median and most", "cost / cheapest, median and most"]
    return "\n".join(table([*names, "above twice the cheapest", "choosing, in runs, median"], lines))


def target_over_face() -> str:
    """Of each pair over the face the true error and the cost beside the cheapest."""
    lines = []
    for line in rows("target_over_face"):
        worst = max(float(value) for name, value in line.items() if name.startswith("error_"))
        numbers = (f"{float(line[name]):.1f}" for name in ("true_over_target", "cost_over_cheapest"))
        chosen, target = line["chosen"].removeprefix("P2 "), f"{100.0 * float(line['target']):g}"
        lines.append([line["pair"], target, chosen, f"{100.0 * worst:.2g}", *numbers])
    names = ["pair", "target, %", "chosen", "worst true error, %", "true / target", "cost / cheapest"]
    return "\n".join(table(names, lines))


def growth(name: str) -> str:
    """Exponents over the upper decade beside theory, of all that grows."""
    lines = []
    for line in rows(name):
        if not line["exponent"] or max(float(line["theory"]), float(line["exponent"])) < 0.25:
            continue
        stage, _, measure = line["quantity"].partition(" ")
        numbers = (f"{float(line[key]):.1f}" for key in ("exponent", "theory"))
        lines.append([line["axis"], f"{STAGES[stage]}, {MEASURES[measure]}", *numbers, line["why"]])
    return "\n".join(table(["what grows", "of", "exponent", "theory", "why"], lines))


def third_dimension(name: str) -> str:
    with patch.object(Figure, "savefig"):
        return import_module(f"tests.benchmarks.third_dimension.{name}").section()


# Page and name of each section, with what it is made by.
SECTIONS = {
    ("accuracy.md", "accuracy"): accuracy,
    ("accuracy.md", "orders"): orders,
    ("accuracy.md", "target"): target,
    ("accuracy.md", "target_face"): target_over_face,
    ("growth.md", "growth"): lambda: growth("growth"),
    ("growth.md", "growth_face"): lambda: growth("growth_face"),
    **{("third_dimension.md", name): lambda name=name: third_dimension(name) for name in NAMES},
}
