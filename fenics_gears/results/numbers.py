"""The numbers that a pair is judged by, as plain functions of curves; `results.key_numbers` applies them to a result.

Curves (steps,) are of whole settled mesh cycles, one value a step, without the end that begins the next cycle.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby
from math import inf, sqrt

import numpy as np
from numba import njit

from fenics_gears.dynamics.clock import Clock

# Names of attributes begin with these: one for each method of the solver, one for each setting whose error was
# estimated.
RUNG = "steps_by_rung: "
ESTIMATED = "estimated_error: "
# How extrema were found.
SOLVED = "positions solved between steps"
CUBICS = "cubics through four steps where the curve is smooth"
STEPS = "steps"
HARMONICS = 5
ROUNDING = 1e-9  # mesh cycles
# Of the largest of some values: what differs by less is the same.
SAME = 1e-9
# A curve has not jumped where it falls in the next step by at least this part of the fall before. A crest is smooth
# where the lower of the parabolas from either side is above the steps by at least this part of the higher one. Between
# steps it is smooth where the lower of their curvatures is at least this part of the other.
LIKE = 0.5


def harmonics(curve: np.ndarray, cycles: int, count: int = HARMONICS) -> np.ndarray:
    """Amplitudes (count,) of the first harmonics of the mesh frequency in a curve over `cycles` whole mesh cycles, in
    the curve's unit. Not a number above half of the steps a cycle, which steps do not sample.

    The curve is mean + sum over n of amplitude_n cos(2 pi n phase + shift_n) and what lies between the harmonics.
    """
    steps = len(curve) // cycles
    spectrum = np.abs(np.fft.rfft(curve)) * (2.0 / len(curve))
    order = np.arange(1, count + 1)
    return np.array([spectrum[n * cycles] if 2 * n < steps else np.nan for n in order])


def shares_at(positions, phase: np.ndarray, numbers: np.ndarray, forces: np.ndarray) -> np.ndarray:
    """Share (len(positions),) of the mesh's force that a pair carries at positions on its path, in mesh cycles since
    the start of contact. It is the mean over the pairs that pass, straight between steps; not a number where none
    passes.

    `phase` (steps,): mesh cycles; `numbers`, `forces` (steps, pairs): the pairs' numbers and their forces, N; a pair
    with number n is at position `phase - n`.
    """
    positions = np.asarray(positions, dtype=float)
    total = np.nansum(forces, axis=1, keepdims=True)
    share = np.divide(forces, total, out=np.full(forces.shape, np.nan), where=total > 0.0)
    known = np.isfinite(share)
    number = np.broadcast_to(numbers, forces.shape)[known]
    share = share[known]
    passed = (phase[:, None] - numbers)[known]
    if not len(share):
        return np.full(len(positions), np.nan)
    order = np.lexsort((passed, number))
    passed = passed[order]
    share = share[order]
    _, first, of_pair = np.unique(number[order], return_index=True, return_inverse=True)
    lowest = passed[first]
    highest = passed[np.append(first[1:], len(passed)) - 1]
    # One pair after the other on a single axis, so that all are interpolated at once.
    apart = np.ptp(passed) + 1.0
    inside = (positions >= lowest[:, None] - ROUNDING) & (positions <= highest[:, None] + ROUNDING)
    shares = np.interp(positions + apart * np.arange(len(first))[:, None], passed + apart * of_pair, share)
    total = np.where(inside, shares, 0.0).sum(axis=0)
    count = inside.sum(axis=0)
    return np.divide(total, count, out=np.full(len(positions), np.nan), where=count > 0)


def mean_where_positive(values: np.ndarray) -> float:
    """Mean of the values of steps at which something touches; not a number where nothing ever does."""
    touching = values > 0.0
    return float(values[touching].mean()) if touching.any() else np.nan


def largest_of_one_pair(stiffness: np.ndarray, pairs: np.ndarray) -> float:
    """Largest stiffness (steps,) at steps with one pair (steps,) in mesh and a stiffness; not a number where there are
    none."""
    alone = (pairs == 1) & np.isfinite(stiffness)
    return float(stiffness[alone].max()) if alone.any() else np.nan


def first_largest(values: np.ndarray) -> int:
    """Place of the first value that is the largest but for round-off, which must not say which of equal cycles is
    named."""
    return int(np.argmax(values >= np.nanmax(values) * (1.0 - SAME)))


@njit(cache=True)
def differences(x, y):
    """Divided differences of four points x, y (4,): the middle first one, both second ones, the third one."""
    before = (y[1] - y[0]) / (x[1] - x[0])
    middle = (y[2] - y[1]) / (x[2] - x[1])
    after = (y[3] - y[2]) / (x[3] - x[2])
    one = (middle - before) / (x[2] - x[0])
    other = (after - middle) / (x[3] - x[1])
    return middle, (one, other), (other - one) / (x[3] - x[0])


@njit(cache=True)
def is_smooth(x, y):
    """Whether a curve bends alike through the first and the last three of four points x, y (4,), and down."""
    one, other = differences(x, y)[1]
    return max(one, other) < 0.0 and min(one / other, other / one) >= LIKE


@njit(cache=True)
def crest_of_cubic(x, y):
    """Place and value of the crest of the cubic through four points x, y (4,) between the middle two; no value where it
    has none there."""
    slope, (one, _), third = differences(x, y)
    # It is y[1] + u (a + u (b + u third)), u from x[1] on.
    curvature = one + third * (x[1] - x[0])
    h = x[2] - x[1]
    a = slope - h * curvature
    b = curvature - h * third
    inside = b * b - 3.0 * a * third
    fall = sqrt(inside) - b if inside >= 0.0 else 0.0
    u = a / fall if fall > 0.0 else h
    if not 0.0 < u < h:
        return x[1], -inf
    return x[1] + u, y[1] + u * (a + u * (b + u * third))


def largest_of_cubics(steps: np.ndarray, values: np.ndarray) -> tuple[float, float]:
    """Place and largest value of the cubics through each four consecutive `values` (s,) at whole `steps`, between the
    middle two. Cubics count only where the parabolas through three of them, either way, have crests alike: at a corner
    the curve is no cubic."""
    return _largest_of_cubics(*(np.asarray(each, dtype=float) for each in (steps, values)))


@njit(cache=True)
def _largest_of_cubics(x, y):
    top = y.argmax()
    place = x[top]
    largest = y[top]
    crest = 0.0
    height = -inf
    for i in range(1, len(x) - 2):
        four = x[i - 1 : i + 3]
        own = y[i - 1 : i + 3]
        one, other = differences(four, own)[1]
        if not (one < 0.0 and other < 0.0):
            continue
        # Crests of both parabolas above the middle two values.
        above = own[1] - (0.5 * (own[2] - own[0])) ** 2 / (4.0 * one)
        beyond = own[2] - (0.5 * (own[3] - own[1])) ** 2 / (4.0 * other)
        between = max(own[1], own[2])
        if min(above, beyond) - between >= LIKE * (max(above, beyond) - between):
            at, value = crest_of_cubic(four, own)
            if value > height:
                crest = at
                height = value
    return (crest, height) if height > largest else (place, largest)


@dataclass(frozen=True)
class ContactLoss:
    """One loss: the steps without contact from `first` to `last`, and the widest `opening` (mm) between the drive
    flanks."""

    first: int
    last: int
    opening: float

    @property
    def steps(self) -> int:
        """Steps without contact; from the last step before to the first after it is one more."""
        return self.last - self.first + 1

    def duration(self, clock: Clock) -> float:
        return clock.duration(self.first - 1, self.last)


def contact_losses(separations: Sequence[tuple[int, float]]) -> list[ContactLoss]:
    """The losses among (step, smallest opening in mm) of all steps without contact."""
    losses = []
    for _, run in groupby(enumerate(separations), lambda each: each[1][0] - each[0]):
        steps = [separation for _, separation in run]
        losses.append(ContactLoss(steps[0][0], steps[-1][0], max(opening for _, opening in steps)))
    return losses


def loss_attributes(separations: Sequence[tuple[int, float]], first: int, last: int, clock: Clock) -> dict[str, float]:
    """Attributes of a result on contact that is lost: how often between two steps. Where it was lost also the time of
    the first and the length of the longest loss (s), the share of the time and the widest opening (mm)."""
    losses = contact_losses(separations)
    if not losses:
        return {"contact_loss_count": 0}
    durations = [loss.duration(clock) for loss in losses]
    return {
        "contact_loss_count": len(losses),
        "contact_loss_first": clock.time(losses[0].first),
        "contact_loss_longest": max(durations),
        "contact_loss_share": sum(durations) / clock.duration(first, last),
        "contact_loss_opening": max(loss.opening for loss in losses),
    }
