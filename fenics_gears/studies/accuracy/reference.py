"""Observed orders and limits by Richardson's extrapolation, each with its own uncertainty, and the reference that they make together.

Roache, Verification and Validation in Computational Science and Engineering, 1998, chapter 5: the uncertainty is 1.25 times what was
extrapolated where an order was found from three grids, 3 times the last difference where not.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

LEAST_ORDER, MOST_ORDER = 0.1, 10.0
# An order is only extrapolated with where it is neither so low that the limit lies far off nor above what is expected by more than this.
LEAST_TRUSTED, MOST_ABOVE_EXPECTED = 0.5, 1.0
WITH_ORDER, WITHOUT_ORDER = 1.25, 3.0
ROUND_OFF = 1e-10
# Differences of curves that point the same way are extrapolated with; kinks between steps move, so that their differences fall with
# an order though they point anywhere. Those that turn back have none.
LEAST_COSINE, TURNED_BACK = 0.5, -0.5


@dataclass(frozen=True)
class Limit:
    """Where a sequence goes: `value` as its terms; `order` observed, None where there is none; `uncertainty` in L2 of the value.

    `least_error`: where the limit is the last term, which then seems free of error, what its error is by its order, or the last
    difference without one.
    """

    value: np.ndarray
    order: float | None
    uncertainty: float
    least_error: float = 0.0


def observed_order(values: Sequence[np.ndarray], sizes: Sequence[float]) -> float | None:
    """Order p of u(h) = u(0) + C h^p through the three last of a sequence, by their distances in L2; None where no p fits.

    `sizes` fall and need not halve. None where differences are round-off, do not fall, or turn back.
    """
    if len(values) < 3:
        return None
    first, second = values[-3] - values[-2], values[-2] - values[-1]
    before, after = float(np.linalg.norm(first)), float(np.linalg.norm(second))
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
    """Of the angle between two arrays; 0 where one of them is zero."""
    length = float(np.linalg.norm(one) * np.linalg.norm(other))
    return float(np.vdot(one, other)) / length if length else 0.0


def richardson(values: Sequence[np.ndarray], sizes: Sequence[float], expected: float) -> Limit:
    """The limit of a sequence as its sizes go to zero; its last term where it cannot be extrapolated."""
    order, last = observed_order(values, sizes), values[-1]
    difference = last - values[-2]
    away = float(np.linalg.norm(difference))
    if order is None or not LEAST_TRUSTED <= order <= expected + MOST_ABOVE_EXPECTED:
        return Limit(last, order, WITHOUT_ORDER * away, away)
    left = sizes[-1] ** order / (sizes[-2] ** order - sizes[-1] ** order)
    if cosine(values[-2] - values[-3], difference) < LEAST_COSINE:
        return Limit(last, order, WITHOUT_ORDER * left * away, left * away)
    return Limit(last + left * difference, order, WITH_ORDER * left * away)


def last_of(values: Sequence[np.ndarray]) -> Limit:
    """The limit of a sequence without a power law: its last term."""
    away = float(np.linalg.norm(values[-2] - values[-1])) if len(values) > 1 else 0.0
    return Limit(values[-1], None, away, away)


def together(base: np.ndarray, limits: Sequence[Limit]) -> Limit:
    """All knobs at their limits at once: what each gains over `base`, added; their uncertainties add too, for none knows the others' signs."""
    value = base + sum((limit.value - base for limit in limits), np.zeros_like(base))
    return Limit(value, None, sum(limit.uncertainty for limit in limits))
