"""Exponents of growth: straight lines through logarithms."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

# What is fitted: values of x from this part of the largest on.
UPPER_DECADE = 0.1


@dataclass(frozen=True)
class Exponent:
    """p of y = C x^p over the upper decade of x; `error`: standard error of p; `points`: how many were fitted; `last`:
    between the last two."""

    value: float
    error: float
    points: int
    last: float


def exponent(x: Sequence[float], y: Sequence[float]) -> Exponent | None:
    """Least squares through the logarithms of the upper decade; None with fewer than three points there, or where y is
    not positive."""
    x, y = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    if not len(x):
        return None
    # A hair below: the decade's own first point belongs to it, whatever its rounding.
    chosen = x >= UPPER_DECADE * x.max() * (1.0 - 1e-2)
    if chosen.sum() < 3 or (y[chosen] <= 0.0).any():
        return None
    along, up = np.log(x[chosen]), np.log(y[chosen])
    away = along - along.mean()
    slope = float(away @ up / (away @ away))
    left = up - up.mean() - slope * away
    error = float(np.sqrt(left @ left / (len(left) - 2) / (away @ away)))
    return Exponent(slope, error, int(chosen.sum()), local_slopes(x, y)[-1])


def local_slopes(x: Sequence[float], y: Sequence[float]) -> list[float]:
    """Exponents between neighbours, one fewer than points."""
    return list(np.diff(np.log(np.asarray(y, dtype=float))) / np.diff(np.log(np.asarray(x, dtype=float))))
