"""Orders of convergence, limits and errors from three and more runs whose sizes fall.

Roache, Verification and Validation in Computational Science and Engineering, 1998, chapter 5: the error of the finest
run is the last change over r^p - 1, with r the ratio of sizes and p the observed order, times a safety factor of 1.25.
Without an observed order the error is three times the last change: 1.25 times the 2.4 that h^0.5 leaves where sizes
halve.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from fenics_gears.measuring import DEFECT, Answer, comparable, distance, part_left

SAFETY = 1.25
LEFT_WITHOUT_ORDER = 2.4
LEAST_ORDER = 0.1
MOST_ORDER = 10.0
# An order is used to extrapolate only above this, for else the limit lies far off, and not further above the expected
# order than this.
LEAST_TRUSTED = 0.5
MOST_ABOVE_EXPECTED = 1.0
ROUND_OFF = 1e-10
# Cosine of the angle between the last two changes. Above the first the limit is extrapolated. Between them changes have
# any direction, as by kinks that move between steps, but their length still falls with an order. Below the second
# changes turn back, and there is no order.
LEAST_COSINE = 0.5
TURNED_BACK = -0.5


@dataclass(frozen=True)
class Limit:
    """The limit of a sequence: `value`, shaped as its terms; observed `order`, None without one; `uncertainty`, L2 norm
    of its error. `least_error`: error of the last term where that is taken as the limit, by its order or, without one,
    the last difference."""

    value: np.ndarray
    order: float | None
    uncertainty: float
    least_error: float = 0.0


def observed_order(values: Sequence[np.ndarray], sizes: Sequence[float]) -> float | None:
    """Order p of u(h) = u(0) + C h^p through the last three terms of a sequence, by their distances in L2. None where
    no p fits, or differences are round-off, do not fall, or turn back. `sizes` fall and need not halve."""
    if len(values) < 3:
        return None
    first = values[-3] - values[-2]
    second = values[-2] - values[-1]
    before = float(np.linalg.norm(first))
    after = float(np.linalg.norm(second))
    scale = ROUND_OFF * float(np.linalg.norm(values[-1]))
    if after <= scale or before <= scale or cosine(first, second) < TURNED_BACK:
        return None
    coarse, middle, last = sizes[-3:]

    def off(order: float) -> float:
        return (coarse**order - middle**order) / (middle**order - last**order) - before / after

    if off(LEAST_ORDER) * off(MOST_ORDER) > 0.0:
        return None
    return float(brentq(off, LEAST_ORDER, MOST_ORDER))


def cosine(one: np.ndarray, other: np.ndarray) -> float:
    length = float(np.linalg.norm(one) * np.linalg.norm(other))
    return float(np.vdot(one, other)) / length if length else 0.0


def richardson(values: Sequence[np.ndarray], sizes: Sequence[float], expected: float) -> Limit:
    """The limit of a sequence as its sizes go to zero; its last term where it cannot be extrapolated."""
    order = observed_order(values, sizes)
    last = values[-1]
    difference = last - values[-2]
    away = float(np.linalg.norm(difference))
    if order is None or not LEAST_TRUSTED <= order <= expected + MOST_ABOVE_EXPECTED:
        return Limit(last, order, SAFETY * LEFT_WITHOUT_ORDER * away, away)
    left = part_left(sizes, order)
    if cosine(values[-2] - values[-3], difference) < LEAST_COSINE:
        return Limit(last, order, SAFETY * LEFT_WITHOUT_ORDER * left * away, left * away)
    return Limit(last + left * difference, order, SAFETY * left * away)


def last_of(values: Sequence[np.ndarray]) -> Limit:
    """The limit where no order is known: the last value, uncertain by the last change."""
    away = float(np.linalg.norm(values[-2] - values[-1])) if len(values) > 1 else 0.0
    return Limit(values[-1], None, away, away)


def error_from(limits: Mapping[str, Limit], answer: Answer, name: str) -> float:
    """Relative distance of a measure from its limit; at least `least_error`."""
    if name not in limits or name not in answer:
        return float("nan")
    limit = limits[name]
    scale = float(np.linalg.norm(limit.value))
    least = limit.least_error / scale if scale and name != DEFECT else 0.0
    return max(distance(answer, {name: limit.value}, name), least)


def together(base: np.ndarray, changes: Sequence[tuple[Limit, np.ndarray]], name: str) -> Limit:
    """All settings at their limits at once: `base`, a measure of a whole setting, and the change from a setting's own
    base to its limit, for each. Uncertainties, relative to their limits, add, for their signs are unknown."""
    value = base
    uncertainty = 0.0
    for limit, own_base in changes:
        value, end, start = comparable((value, limit.value, own_base), name)
        value = value + end - start
        uncertainty += limit.uncertainty / (float(np.linalg.norm(limit.value)) or 1.0)
    return Limit(value, None, uncertainty * float(np.linalg.norm(value)))


def largest_part(parts: Mapping[str, float]) -> str:
    """The name of the largest part."""
    return max(parts, key=parts.__getitem__)
