"""The cheapest sizes whose errors together stay below an allowance: a search over a grid of all knobs' sizes."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from fenics_gears.studies.target.cost import Cost
from fenics_gears.studies.target.error_curve import ErrorCurve, total_error

# Sizes stand this factor apart: coarse enough that a disturbed time hardly moves the choice, fine enough to cost no more than a tenth.
RATIO = 2.0**0.25

Sizes = dict[str, float]
Allowed = Callable[[Mapping[str, np.ndarray]], np.ndarray]


def cheapest(curves: Sequence[ErrorCurve], cost: Cost, allowance: float, allowed: Allowed) -> Sizes | None:
    """Sizes by knob; None where nothing that is `allowed` and between the curves' ends stays within `allowance`.

    `allowed` takes arrays of sizes by knob, as np.meshgrid makes them sparse, and says which may be run.
    """
    axes = np.meshgrid(*[_grid(curve) for curve in curves], indexing="ij", sparse=True)
    sizes = {curve.name: axis for curve, axis in zip(curves, axes)}
    within = (total_error(curves, axes) <= allowance) & allowed(sizes)
    seconds = np.where(within, cost.at(sizes), np.inf)
    best = np.unravel_index(np.argmin(seconds), seconds.shape)
    if not np.isfinite(seconds[best]):
        return None
    return {curve.name: float(axis.ravel()[place]) for curve, axis, place in zip(curves, axes, best)}


def errors_at(curves: Sequence[ErrorCurve], sizes: Mapping[str, float]) -> dict[str, float]:
    """Every knob's error, the larger of the judged measures."""
    return {curve.name: curve.largest(sizes[curve.name]) for curve in curves}


def error_together(curves: Sequence[ErrorCurve], sizes: Mapping[str, float]) -> float:
    """The error of all knobs together."""
    return float(total_error(curves, [sizes[curve.name] for curve in curves]))


def _grid(curve: ErrorCurve) -> np.ndarray:
    """Sizes from the coarsest rung down to the finest promised, that one included."""
    steps = int(np.floor(np.log(curve.sizes[0] / curve.finest) / np.log(RATIO) + 1e-9))
    sizes = curve.sizes[0] / RATIO ** np.arange(steps + 1)
    return sizes if sizes[-1] <= curve.finest * (1 + 1e-9) else np.append(sizes, curve.finest)
