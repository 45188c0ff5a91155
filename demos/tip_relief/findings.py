"""What is measured of reliefs: a map over depth and length, the best of each shape, and what it does at other loads."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize_scalar

from demos.tip_relief.design import LINEAR, LONG, SHAPES, SHORT, Bench, Design
from demos.tip_relief.optimum import Optimum, optimum

# Of the map: closer where the valley is.
DEPTHS = np.array([0.0, 5.0, 10.0, 15.0, 20.0, 22.5, 25.0, 27.5, 30.0, 32.5, 35.0, 40.0, 45.0, 50.0, 55.0, 60.0])  # um
LENGTHS = np.array([0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.85, 0.9, 0.95, 1.0, 1.05, 1.1, 1.2, 1.3, 1.4, 1.5, 1.6])
LOADS = np.concatenate(([0.02, 0.1], np.arange(0.2, 2.01, 0.1)))
HARRIS_LOADS = (0.02, 0.25, 0.5, 0.75, 1.0, 1.5, 2.0)
DRAWN = ("μ = 0", "μ = 0.1")
STIFF = "μ = 0.1, stiff shafts and bearings"

Optima = Mapping[tuple[str, str], Optimum]


@dataclass(frozen=True)
class Map:
    """Peak-to-peak transmission error (depths, lengths), um, of linear reliefs."""

    depths: np.ndarray
    lengths: np.ndarray
    left: np.ndarray


def relief_map(bench: Bench, depths: np.ndarray = DEPTHS, lengths: np.ndarray = LENGTHS) -> Map:
    """The transmission error of every linear relief of a grid; without depth all lengths are the same."""
    none = bench.peak_to_peak(None)
    rows = [
        [bench.peak_to_peak(Design(depth, length)) if depth > 0.0 else none for length in lengths] for depth in depths
    ]
    return Map(depths, lengths, np.array(rows))


def optima(benches: Mapping[str, Bench]) -> Optima:
    """The best linear relief under every condition, and the best parabolic one under those that are drawn."""
    shapes = {name: SHAPES if name in DRAWN else (LINEAR,) for name in benches}
    return {(name, shape): optimum(benches[name], shape) for name in benches for shape in shapes[name]}


def compared(best: Design) -> dict[str, Design | None]:
    """What the best relief is compared with: none, and a short one of the same depth."""
    return {"true involutes": None, "short relief": Design(best.depth, SHORT), "best relief": best}


def over_load(
    bench: Bench, designs: Mapping[str, Design | None], loads: Sequence[float] = LOADS
) -> dict[str, np.ndarray]:
    """Peak-to-peak transmission error (loads,), um, of each design over the load."""
    return {name: np.array([bench.peak_to_peak(design, load) for load in loads]) for name, design in designs.items()}


def single_pair_deflection(bench: Bench) -> tuple[float, float]:
    """Least and largest approach (um) of the true flanks of frictionless gears on stiff shafts while one tooth pair
    carries the load."""
    phase, error = bench.error(None)
    # A cycle begins where a new pair enters; the pair before it leaves when the contact ratio is used up.
    single = (phase > bench.pair.contact_ratio - 1.0 + 0.1) & (phase < 0.9)
    return float(error[single].min()), float(error[single].max())


def best_depth(bench: Bench, load: float, length: float = LONG, tolerance: float = 0.1) -> float:
    """The depth (um) of the best linear relief of a length at a load, within a tolerance (um)."""

    def left(depth: float) -> float:
        return bench.peak_to_peak(Design(depth, length, LINEAR), load)

    return float(minimize_scalar(left, bounds=(0.5, 80.0), method="bounded", options={"xatol": tolerance}).x)
