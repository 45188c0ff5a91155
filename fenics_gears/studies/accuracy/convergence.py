"""Orders of convergence, limits and errors from runs with falling sizes, for `gears accuracy` and for `[accuracy] target`.

Roache, Verification and Validation in Computational Science and Engineering, 1998, chapter 5: the error of the finest run is the last change
over r^p - 1, with r the ratio of sizes and p the order, times a safety factor of 1.25. Without an observed order it is three times the last
change: 1.25 times the 2.4 that h^0.5 leaves where sizes halve.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from fenics_gears.studies.accuracy.measures import CURVE, JUDGED, SPAN, Answer, comparable

SAFETY = 1.25
LEFT_WITHOUT_ORDER = 2.4
NO_ORDER = float(np.log2(1.0 + 1.0 / LEFT_WITHOUT_ORDER))
LEAST_ORDER, MOST_ORDER = 0.1, 10.0
# An order is used to extrapolate only above this, for else the limit lies far off, and not further above the expected order than this.
LEAST_TRUSTED, MOST_ABOVE_EXPECTED = 0.5, 1.0
# An observed order is taken as the expected one up to this far below it.
LIKE_EXPECTED = 0.5
# A limit and its order are found from so many of the finest terms.
LAST_TERMS = 3
ROUND_OFF = 1e-10
# Cosine of the angle between the last two changes: above the first the limit is extrapolated; kinks that move between steps give changes in
# any direction whose length still falls with an order; below the second, where changes turn back, there is no order.
LEAST_COSINE, TURNED_BACK = 0.5, -0.5
# Where the order is trusted, errors are extrapolated to sizes up to this factor finer.
EXTRAPOLATED = 2.0
# Smallest error, so that logarithms stay finite.
NO_ERROR = 1e-9


@dataclass(frozen=True)
class Limit:
    """The limit of a sequence: `value`, shaped as its terms; observed `order`, None without one; `uncertainty`, L2 norm of its error.

    `least_error`: error of the last term where that is taken as the limit: by its order, or the last difference without one.
    """

    value: np.ndarray
    order: float | None
    uncertainty: float
    least_error: float = 0.0


def observed_order(values: Sequence[np.ndarray], sizes: Sequence[float]) -> float | None:
    """Order p of u(h) = u(0) + C h^p through the last three terms of a sequence, by their distances in L2; None where no p fits.

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
    """Cosine of the angle between two arrays; 0 where one of them is zero."""
    length = float(np.linalg.norm(one) * np.linalg.norm(other))
    return float(np.vdot(one, other)) / length if length else 0.0


def part_left(sizes: Sequence[float], order: float) -> float:
    """Error of the finest size in parts of the last change: 1/(r^p - 1)."""
    return 1.0 / ((sizes[-2] / sizes[-1]) ** order - 1.0)


def richardson(values: Sequence[np.ndarray], sizes: Sequence[float], expected: float) -> Limit:
    """The limit of a sequence as its sizes go to zero; its last term where it cannot be extrapolated."""
    order, last = observed_order(values, sizes), values[-1]
    difference = last - values[-2]
    away = float(np.linalg.norm(difference))
    if order is None or not LEAST_TRUSTED <= order <= expected + MOST_ABOVE_EXPECTED:
        return Limit(last, order, SAFETY * LEFT_WITHOUT_ORDER * away, away)
    left = part_left(sizes, order)
    if cosine(values[-2] - values[-3], difference) < LEAST_COSINE:
        return Limit(last, order, SAFETY * LEFT_WITHOUT_ORDER * left * away, left * away)
    return Limit(last + left * difference, order, SAFETY * left * away)


def last_of(values: Sequence[np.ndarray]) -> Limit:
    """The limit of a sequence without a power law: its last term."""
    away = float(np.linalg.norm(values[-2] - values[-1])) if len(values) > 1 else 0.0
    return Limit(values[-1], None, away, away)


def together(base: np.ndarray, changes: Sequence[tuple[Limit, np.ndarray]], name: str) -> Limit:
    """All settings at their limits at once: `base`, a measure of a whole setting, and the change from a setting's own base to its limit, for each.

    Uncertainties, relative to their limits, add, for their signs are unknown.
    """
    value, uncertainty = base, 0.0
    for limit, own_base in changes:
        value, end, start = comparable((value, limit.value, own_base), name)
        value = value + end - start
        uncertainty += limit.uncertainty / (float(np.linalg.norm(limit.value)) or 1.0)
    return Limit(value, None, uncertainty * float(np.linalg.norm(value)))


def largest_part(parts: Mapping[str, float]) -> str:
    """The setting with the largest error."""
    return max(parts, key=parts.__getitem__)


@dataclass(frozen=True)
class MeasureFit:
    """Relative errors of one measure at the sizes that ran; `order`: observed, None without one; `used`: the order of the extrapolation.

    `direction`: the last change, an array of the measure scaled to length 1 (zero without a change).
    """

    errors: np.ndarray
    order: float | None
    used: float
    trusted: bool
    direction: np.ndarray


@dataclass(frozen=True)
class ErrorCurve:
    """Error of a setting at any size up to the coarsest that ran, on the safe side; `sizes` fall; `factor`: correction found by a check.

    Errors are interpolated between the sizes that ran. Beyond the finest they fall with the lower of observed and expected order; without
    an observed order with half an order, and no size finer than the finest is used.
    """

    name: str
    sizes: np.ndarray
    fits: dict[str, MeasureFit]
    expected: float
    factor: float = 1.0

    @property
    def leading(self) -> MeasureFit:
        """The measure with the largest error at the finest size."""
        return max(self.fits.values(), key=lambda fit: fit.errors[-1])

    @property
    def trusted(self) -> bool:
        """Whether that measure shows its expected order."""
        return self.leading.trusted

    @property
    def finest(self) -> float:
        """The smallest size for which an error is promised."""
        return float(self.sizes[-1] / (EXTRAPOLATED if self.trusted else 1.0))

    def error(self, size: float | np.ndarray, measure: str) -> np.ndarray:
        """Relative error of a measure at sizes between `finest` and the coarsest: straight lines in logarithms, the order beyond."""
        size, fit = np.asarray(size, dtype=float), self.fits[measure]
        within = np.exp(np.interp(np.log(size), np.log(self.sizes[::-1]), np.log(fit.errors[::-1])))
        return self.factor * np.where(size < self.sizes[-1], fit.errors[-1] * (size / self.sizes[-1]) ** fit.used, within)

    def largest(self, size: float) -> float:
        """The larger error of the judged measures."""
        return max(float(self.error(size, measure)) for measure in self.fits)


def error_curve(name: str, sizes: Sequence[float], answers: Sequence[Answer], expected: float) -> ErrorCurve:
    """The errors of three runs or more, from coarse to fine. T_EPP without an order of its own is given that of the T_E curve."""
    curve = _fit(comparable([each[CURVE] for each in answers], CURVE), sizes, expected)
    height = _fit([each[SPAN] for each in answers], sizes, expected, instead=curve.used)
    return ErrorCurve(name, np.asarray(sizes, dtype=float), {CURVE: curve, SPAN: height}, expected)


def total_error(curves: Sequence[ErrorCurve], sizes: Sequence[float | np.ndarray]) -> np.ndarray:
    """Error of all settings together, the larger of the judged measures; sizes, one for each curve, are broadcast.

    Errors add as vectors, by the angle between their curves. Opposite errors are taken to be at right angles, for at another load or speed
    they need not cancel. The direction of an error without an order is unknown: it is taken to point along with all others.
    """
    return np.max([_together(curves, sizes, measure) for measure in JUDGED], axis=0)


def _together(curves: Sequence[ErrorCurve], sizes, measure: str) -> np.ndarray:
    errors = [curve.error(size, measure) for curve, size in zip(curves, sizes)]
    fits = [curve.fits[measure] for curve in curves]
    square = sum(error**2 for error in errors)
    for i in range(len(errors)):
        for j in range(i):
            along = max(0.0, cosine(fits[i].direction, fits[j].direction)) if fits[i].trusted and fits[j].trusted else 1.0
            square = square + 2.0 * along * errors[i] * errors[j]
    return np.sqrt(square)


def _fit(values: list[np.ndarray], sizes: Sequence[float], expected: float, instead: float = NO_ORDER) -> MeasureFit:
    """Errors: distance from the finest run together with that run's own error; they never fall towards coarser sizes.

    `instead`: the order used where none is observed, or a lower one.
    """
    scale = float(np.linalg.norm(values[-1])) or 1.0
    order = observed_order(values, sizes)
    trusted = order is not None and order >= expected - LIKE_EXPECTED
    used = max(min(order, expected), instead) if order is not None else instead
    last = values[-1] - values[-2]
    length = float(np.linalg.norm(last))
    left = part_left(sizes, used) * length
    errors = np.maximum.accumulate([_beyond(values[-1] - value, last, left) for value in values][::-1])[::-1]
    return MeasureFit(np.maximum(SAFETY * errors / scale, NO_ERROR), order, used, trusted, last / length if length else last)


def _beyond(way: np.ndarray, last: np.ndarray, left: float) -> float:
    """Distance to the finest run and on to the limit: straight on where the last change points the same way, else at a right angle."""
    length = float(np.linalg.norm(way))
    return length + left if cosine(way, last) >= LEAST_COSINE else float(np.hypot(length, left))
