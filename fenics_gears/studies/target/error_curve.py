"""The error of one knob against its size, fitted to the runs of its rungs: C h^p for each measure.

Every choice is on the safe side: between rungs the errors measured are used, beyond the finest rung the order, the lower of observed and
expected one; where no order shows, half an order, and nothing finer than the finest rung is promised. The height of a curve (T_EPP) that
shows no order of its own is taken to have the curve's.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fenics_gears.studies.accuracy.measures import CURVE, JUDGED, SPAN, Answer
from fenics_gears.studies.accuracy.reference import LEAST_COSINE, cosine, observed_order

# Of three rungs with an order: Roache's factor of safety (1998, chapter 5).
SAFETY = 1.25
# Without an order errors are taken to fall as h^0.5, so that what is left is 2.4 times the last change, 3 times with the factor of safety.
NO_ORDER = 0.5
# How far an observed order may lie from the expected one and still be the expected one.
LIKE_EXPECTED = 0.5
# Rungs' errors are extrapolated to sizes finer by this factor at most, where the order is trusted.
EXTRAPOLATED = 2.0
# Below this an error is none; keeps logarithms finite.
NO_ERROR = 1e-9


@dataclass(frozen=True)
class MeasureFit:
    """Errors of one measure at the rungs' sizes, relative; `order` observed (None for none), `used`: the one extrapolated with.

    `direction`: what the finest rung still changed, as the measure's array, of length 1 (or 0 where it changed nothing).
    """

    errors: np.ndarray
    order: float | None
    used: float
    trusted: bool
    direction: np.ndarray


@dataclass(frozen=True)
class ErrorCurve:
    """A knob's errors at any size up to its coarsest rung; `sizes` fall; `factor`: what a check found them to be wrong by."""

    name: str
    sizes: np.ndarray
    fits: dict[str, MeasureFit]
    expected: float
    factor: float = 1.0

    @property
    def leading(self) -> MeasureFit:
        """The measure with the largest error at the finest rung."""
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
        """Relative error of a measure at sizes between `finest` and the coarsest rung."""
        return self.factor * _at(self.sizes, self.fits[measure], np.asarray(size, dtype=float))

    def largest(self, size: float) -> float:
        """The larger error of the judged measures."""
        return max(float(self.error(size, measure)) for measure in self.fits)


def error_curve(name: str, sizes: Sequence[float], answers: Sequence[Answer], expected: float) -> ErrorCurve:
    """The curve through a knob's rungs, three or more, from coarse to fine."""
    curve = _fit([each[CURVE] for each in answers], sizes, expected)
    height = _fit([each[SPAN] for each in answers], sizes, expected, instead=curve.used)
    fits = {CURVE: curve, SPAN: height}
    return ErrorCurve(name, np.asarray(sizes, dtype=float), fits, expected)


def total_error(curves: Sequence[ErrorCurve], sizes: Sequence[float | np.ndarray]) -> np.ndarray:
    """Error of all knobs together, the larger of the judged measures; sizes, one a knob, are broadcast.

    Errors are added as the curves that they are: by the angle between them, but where they point against each other they are taken to be
    at right angles, for another load or speed undoes what cancels here. Where a knob shows no order, its direction tells nothing and it
    is taken to point along with all others.
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
    """Distances from the finest rung and what that rung itself still lacks; errors never fall towards coarser rungs.

    `instead`: the order used where none shows, or a lower one.
    """
    scale = float(np.linalg.norm(values[-1])) or 1.0
    order = observed_order(values, sizes)
    trusted = order is not None and order >= expected - LIKE_EXPECTED
    used = max(min(order, expected), instead) if order is not None else instead
    last = values[-2] - values[-1]
    left = float(np.linalg.norm(last)) / ((sizes[-2] / sizes[-1]) ** used - 1.0)
    errors = np.maximum.accumulate([_beyond(values[-1] - value, -last, left) for value in values][::-1])[::-1]
    length = float(np.linalg.norm(last))
    return MeasureFit(np.maximum(SAFETY * errors / scale, NO_ERROR), order, used, trusted, last / length if length else last)


def _beyond(way: np.ndarray, last: np.ndarray, left: float) -> float:
    """Length of the way to the finest rung and from there on: straight on where the last change went the same way, else across."""
    length = float(np.linalg.norm(way))
    return length + left if cosine(way, last) >= LEAST_COSINE else float(np.hypot(length, left))


def _at(sizes: np.ndarray, fit: MeasureFit, size: np.ndarray) -> np.ndarray:
    """Straight lines between rungs in logarithms; the order used beyond the finest."""
    within = np.exp(np.interp(np.log(size), np.log(sizes[::-1]), np.log(fit.errors[::-1])))
    return np.where(size < sizes[-1], fit.errors[-1] * (size / sizes[-1]) ** fit.used, within)
