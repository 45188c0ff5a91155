"""A run as the page shows it: numbers in words, charts and a tooth in space for plotly, all gears as outlines."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np
import xarray as xr

from fenics_gears import HARMONIC_NAMES, GearPair
from fenics_gears.charts import (
    BARS,
    Chart,
    Curve,
    gear_outline,
    gears_of_train,
    plotly_figure,
    run_charts,
    train_charts,
)  # fmt: skip
from fenics_gears.many_runs import result_rows, train_rows

from .tooth import pinion_in_space

# A hundredth of a micrometre.
DIGITS = 5
# What a designer looks at first; all else follows.
FIRST = (
    "Transmission error", "Line load along the face", "Contact pattern", "Load sharing between tooth pairs",
    "Harmonics",
)  # fmt: skip


def shown(result: xr.Dataset, pair: GearPair) -> dict[str, Any]:
    """What the page needs of a result."""
    subjects = [*run_charts(result), *_harmonics(result)]
    subjects.sort(key=lambda each: FIRST.index(each[0]) if each[0] in FIRST else len(FIRST))
    return {
        "charts": _figures(subjects),
        "numbers": [[label, value] for label, value, _ in result_rows(result)],
        "warnings": str(result.attrs.get("warnings", "")).splitlines(),
        "drawing": _drawing(pair),
        "tooth": pinion_in_space(result, pair, dict(subjects)),
    }


def shown_train(result: xr.Dataset, scene: Any) -> dict[str, Any]:
    """What the page needs of a train's result: its numbers and those of each mesh."""
    numbers = [[label, f"{value} {unit}".strip()] for label, value, unit in train_rows(result)]
    return {
        "charts": _figures(train_charts(result, scene)),
        "numbers": numbers,
        "warnings": str(result.attrs.get("warnings", "")).splitlines(),
        "drawing": _drawing_of_train(_Gears(scene)),
        "tooth": None,
    }


def _figures(subjects: list[tuple[str, list[Chart]]]) -> list[dict[str, Any]]:
    return [_chart(subject, number, chart) for subject, own in subjects for number, chart in enumerate(own)]


def _chart(subject: str, number: int, chart: Chart) -> dict[str, Any]:
    figure = plotly_figure(chart)
    name = f"{subject} {number + 1}" if number else subject
    return {"name": name, "caption": chart.caption, "note": chart.note, "height": chart.height, "figure": figure}


def _harmonics(result: xr.Dataset) -> list[tuple[str, list[Chart]]]:
    """Amplitudes of the transmission error over mesh orders."""
    amplitudes = [result.attrs[name] for name in HARMONIC_NAMES if name in result.attrs]
    if not amplitudes:
        return []
    orders = np.arange(1.0, len(amplitudes) + 1.0)
    bars = Curve("amplitude", orders, np.array(amplitudes), mode=BARS, width=0.6)
    chart = Chart("Harmonics of the transmission error", [bars], "Mesh order", "Amplitude (µm)", height=280)
    return [("Harmonics", [chart])]


@lru_cache(maxsize=2)
def _drawing(pair: GearPair) -> dict[str, Any]:
    """Outlines of both gears at the start of a mesh cycle, the pinion's centre at the origin, and how each turns."""
    wheel = [0.0, -pair.centre_distance]
    gears = ((pair.pinion, [0.0, 0.0]), (pair.wheel, wheel))
    parts = []
    for number, (gear, centre) in enumerate(gears):
        outline = gear_outline(pair, number, 0.0)
        moved = gear_outline(pair, number, 0.01) - outline
        arm = outline - centre
        turn = np.sign(np.sum(arm[:, 0] * moved[:, 1] - arm[:, 1] * moved[:, 0]))
        parts.append(
            {
                "outline": np.round(outline, DIGITS).tolist(),
                "centre": centre,
                "bore": abs(gear.bore_radius),
                "turn": float(turn) * 2.0 * np.pi / gear.teeth,
            }
        )
    radii = [max(gear.tip_radius, abs(gear.bore_radius)) for gear, _ in gears]
    centres = [[0.0, 0.0], wheel]
    return {"gears": parts, "ends": _ends(centres, radii), "turn": 0.0}


class _Gears:
    """A train, alike where its gears and where they stand are."""

    def __init__(self, scene: Any):
        self.scene = scene
        self._key = tuple((each.pair, each.direction, each.gears, each.shafts) for each in scene.meshes)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Gears) and self._key == other._key

    def __hash__(self) -> int:
        return hash(self._key)


@lru_cache(maxsize=2)
def _drawing_of_train(of: _Gears) -> dict[str, Any]:
    """The same of a train as its run begins: of a cycle of its first mesh; `turn`: of the carrier of a planetary set,
    in which its gears are described."""
    gears, turn = gears_of_train(of.scene)
    parts = [
        {
            "outline": np.round(each.outline, DIGITS).tolist(), "centre": list(each.centre), "bore": each.around,
            "turn": each.turn,
        }
        for each in gears
    ]  # fmt: skip
    return {
        "gears": parts,
        "ends": _ends([each.centre for each in gears], [each.radius for each in gears]),
        "turn": turn,
    }


def _ends(centres: Any, radii: Any) -> list[float]:
    """Left, right, lower and upper end (mm) of a drawing."""
    x, y = np.transpose(centres)
    size = np.array(radii)
    return [float(end) for end in (np.min(x - size), np.max(x + size), np.min(y - size), np.max(y + size))]
