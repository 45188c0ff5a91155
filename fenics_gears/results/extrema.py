"""Extrema of a run's curves, located between its steps.

Of a quasi-static run positions between the steps are solved where the largest value can lie: between two steps the
curve is taken to stay below the straight lines through the steps on either side, as it does at smooth crests and at
corners where a tooth pair enters or leaves contact. Lines through solved positions replace these, until no crossing
lies above the largest value found. With inertia curves are smooth: the extremum is that of the cubic through four
steps, which is of fourth order. The march's own velocities give no more: between two steps average acceleration means a
parabola. Where steps are too long for any vibration, the motion follows the static one: positions are solved as without
inertia.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from math import ceil, isfinite

import numpy as np
import xarray as xr

from fenics_gears.contact.errors import ContactNotConverged
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.dynamics.between_steps import BetweenSteps
from fenics_gears.dynamics.steps import Record
from fenics_gears.effects import common_period
from fenics_gears.model.model import Model
from fenics_gears.results.attributes import CUBICS, SOLVED, STEPS
from fenics_gears.results.key_numbers import largest_force_over_time
from fenics_gears.results.numbers import SAME

# Positions solved for an extremum at most, and up to which part of the curve's span it is sought.
MOST_SOLVED, SOUGHT = 20, 1e-4
# Over a face, whose positions cost a hundred times as much and whose slices leave a peak-to-peak value some 2 %
# uncertain.
SOUGHT_OVER_FACE = 3e-4
# A position solved again is that of the march if it is as near as this part of what is sought.
SAME_POSITION = 0.1
# How far down from the largest value a curve is followed, in parts of what is sought. What falls within less than this
# part of a step jumps.
NEAR, WIDTH_OF_JUMP = 50.0, 1e-3
# A curve has not jumped where it falls in the next step by at least this part of the fall before. A crest is smooth
# where the lower of the parabolas from either side is above the steps by at least this part of the higher one.
LIKE = 0.5
# A position is sought no nearer to a step than this part of the distance to the next.
NEAREST = 0.02


@dataclass(frozen=True)
class Extremum:
    """A largest value, and where it is in mesh cycles since the start."""

    value: float
    mesh_phase: float


class Extrema:
    """Locates the largest values of curves over the settled steps of a run.

    `mesh_phase`, `transmission_error` (s,), rad: of consecutive steps; the latter tells whether a position solved again
    is that of the march.
    `found_by`: how the last one was located.
    """

    def __init__(self, model: Model, cycle: Cycle, mesh_phase: np.ndarray, transmission_error: np.ndarray):
        self._model, self._cycle = model, cycle
        self._steps = np.rint(mesh_phase * cycle.steps).astype(int)
        self._period = common_period(model.scene) * cycle.steps
        whole = isfinite(self._period) and len(self._steps) > self._period
        # Solved in the first period, so that the same cycles give the same bits however many are run.
        self._first, self._whole = (
            int((self._steps[-1] - self._period) // self._period * self._period) if whole else 0,
            whole,
        )
        self._quasi_static = model.drivetrain.mass is None
        follows_statics = self._quasi_static or not model.time_scales.averages_acceleration
        self._sought = SOUGHT if cycle.face is None else SOUGHT_OVER_FACE
        self.found_by = CUBICS if not follows_statics else SOLVED if cycle.traits.divisible else STEPS
        if self.found_by == SOLVED:
            # Not a method of this object: with a circle of references all operators would stay until Python looks for
            # garbage.
            same = SAME_POSITION * SOUGHT * float(np.ptp(transmission_error))
            marched = partial(
                _is_marched, model, transmission_error, self._place(0), same if self._quasi_static else np.inf
            )
            self._between = BetweenSteps(cycle, model.equations_of_motion, marched)

    def largest(self, curve: np.ndarray, of: Callable[[Record], float]) -> Extremum:
        """The largest value of a curve (s,); `of`: its value at a position."""
        value, round_off = float(curve.max()), SAME * float(np.abs(curve).max())
        # The first of all that differ by round-off: cycles repeat.
        step = float(self._steps[np.argmax(curve >= value - round_off)])
        found = step, value
        if self.found_by == SOLVED:
            sought = self._sought * float(np.ptp(curve)) + round_off
            step_in_period, highest_value = highest(
                *self._last_period(curve), lambda step: self._at(step, curve, of), sought
            )
            found = self._first + step_in_period, highest_value
        elif self.found_by == CUBICS:
            found = largest_of_cubics(self._steps, curve)
        step, value = found if found[1] > value + round_off else (step, value)
        return Extremum(value, step / self._cycle.steps)

    def transmission_error(self, record: Record) -> float:
        """The transmission error, rad, at a position."""
        return float(self._model.transmission_error(record.state.position))

    def _place(self, step: float) -> int:
        """Place of a step of the period among all steps."""
        return int(step) + self._first - int(self._steps[0])

    def _at(self, step: float, curve: np.ndarray, of: Callable[[Record], float]) -> float:
        """Value of a curve (s,) at a place between two steps; not a number where it cannot be solved.

        With inertia it is the static value and, straight between the steps, by what the curve differs from static
        values there.
        """
        ends = (ceil(step) - 1, ceil(step))
        try:
            records = [self._between.at(each) for each in (step, *(() if self._quasi_static else ends))]
        except ContactNotConverged:
            records = [None]
        if None in records:
            self.found_by = STEPS
            return np.nan
        value, *static = map(of, records)
        return (
            value + float(np.interp(step, ends, [curve[self._place(end)] - each for end, each in zip(ends, static)]))
            if static
            else value
        )

    def _last_period(self, curve: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Steps from the first of a period and values of the last one, with a step before and after it as it repeats;
        of all steps where none is whole."""
        if not self._whole:
            return self._steps.astype(float), curve
        steps, values = self._steps[-self._period - 1 :] - self._first, curve[-self._period - 1 :]
        return np.concatenate(([steps[0] - 1.0], steps, [steps[-1] + 1.0])), np.concatenate(
            (values[-2:-1], values, values[1:2])
        )


def _is_marched(model: Model, transmission_error: np.ndarray, first: int, same: float, record: Record) -> bool:
    """Whether a position has the transmission error (s,) of the march at its step, of which step 0 has the place
    `first`; any has where `same` is infinite."""
    return (
        same == np.inf
        or abs(float(model.transmission_error(record.state.position)) - transmission_error[int(record.step) + first])
        <= same
    )


def peak_to_peak(extrema: Extrema, error: np.ndarray) -> dict[str, float | str]:
    """T_EPP, rad, of the transmission error (s,), rad, where its extremes are, and how they were found."""
    largest = extrema.largest(error, extrema.transmission_error)
    least = extrema.largest(-error, lambda record: -extrema.transmission_error(record))
    return {
        "peak_to_peak_transmission_error": largest.value + least.value,
        "peak_to_peak_transmission_error_from": extrema.found_by,
        "largest_transmission_error_mesh_phase": largest.mesh_phase,
        "least_transmission_error_mesh_phase": least.mesh_phase,
    }


def largest_pair_force(extrema: Extrema, curves: xr.Dataset | Mapping[str, np.ndarray]) -> dict[str, float | str]:
    """The largest normal force of a tooth pair, N, by its curves over the steps, where it is, and how it was found."""
    found = extrema.largest(largest_force_over_time(curves), _largest_force_of_a_pair)
    return {
        "largest_pair_force": found.value,
        "largest_pair_force_mesh_phase": found.mesh_phase,
        "largest_pair_force_from": extrema.found_by,
    }


def _largest_force_of_a_pair(record: Record) -> float:
    """Largest normal force, N, of a pair of flanks at a position."""
    operator = record.position.operator
    pair_of_node = operator.node_pair
    if operator.face is not None:
        # There a tooth pair has nodes in many slices.
        numbers = {
            key: number
            for number, key in enumerate(dict.fromkeys((pair.place.flank, pair.place.index) for pair in operator.pairs))
        }
        pair_of_node = np.array([numbers[pair.place.flank, pair.place.index] for pair in operator.pairs], dtype=int)[
            pair_of_node
        ]
    return float(np.bincount(pair_of_node, record.solution.forces[: operator.nodes], minlength=1).max())


def highest(
    steps: np.ndarray, values: np.ndarray, value: Callable[[float], float], sought: float
) -> tuple[float, float]:
    """Place and largest value of a curve given at `steps` (s,) by `values` (s,), and anywhere between them by `value`,
    which may be not a number.

    Between the first two and the last two steps nothing is sought. Ends where no crossing of lines is higher by
    `sought` and on either side of the largest value the curve falls by NEAR times that in small parts, so that lines
    are those beside the crest; or after MOST_SOLVED.
    """
    for _ in range(MOST_SOLVED):
        bounds, places = _bounds(steps, values)
        interval = int(bounds.argmax()) + 1 if len(bounds) else 0
        if not len(bounds) or bounds[interval - 1] <= values.max() + sought:
            interval = _steep_neighbour(steps, values, NEAR * sought)
            if not interval:
                break
            place = 0.5 * (steps[interval] + steps[interval + 1])
        else:
            place = places[interval - 1]
        found = value(place)
        if np.isnan(found):
            break
        steps, values = np.insert(steps, interval + 1, place), np.insert(values, interval + 1, found)
    return float(steps[values.argmax()]), float(values.max())


def _steep_neighbour(steps: np.ndarray, values: np.ndarray, near: float) -> int:
    """The steeper of the intervals in which a curve falls below the largest value by more than `near` on either side
    within a step of it; 0 where
    neither falls by so much in itself, over more than a jump's width, or both are at an end."""
    top, found = int(values.argmax()), {}
    for side in (-1, 1):
        end = top
        while (
            0 < end + side < len(values) - 1
            and values[end + side] >= values[top] - near
            and abs(steps[end + side] - steps[top]) < 1.0
        ):
            end += side
        interval = min(end, end + side)
        if 0 < interval < len(values) - 2 and steps[interval + 1] - steps[interval] > WIDTH_OF_JUMP:
            found[interval] = float(values[end] - values[end + side])
    interval = max(found, key=found.__getitem__, default=0)
    return interval if interval and found[interval] > near else 0


def _bounds(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """How high a curve may be (s - 3,) between points x, y (s,), each interval but the outer ones; and the place that
    is to be solved there.

    That is the crossing of the lines from either side. Where one rises into the interval and the other lies far below
    its end, the curve may
    have jumped down anywhere: then half-way.
    """
    slope, h = np.diff(y) / np.diff(x), np.diff(x)[1:-1]
    left, right, a, b = slope[:-2], slope[2:], y[1:-2], y[2:-1]
    with np.errstate(divide="ignore", invalid="ignore"):
        crossing = np.clip((b - right * h - a) / (left - right) / h, NEAREST, 1.0 - NEAREST)
    meets = (left > right) & (b - right * h > a) & (a + left * h > b)
    height = np.where(meets, a + left * crossing * h, np.maximum(a, b))
    fell = (a >= b) & (left > 0.0) & (b - right * h < a - LIKE * (a - b))
    rose = (b > a) & (right < 0.0) & (a + left * h < b - LIKE * (b - a))
    height = np.where(fell, a + left * h, np.where(rose, b - right * h, height))
    return height, x[1:-2] + np.where(fell | rose, 0.5, np.where(meets, crossing, 0.5)) * h


def largest_of_cubics(steps: np.ndarray, values: np.ndarray) -> tuple[float, float]:
    """Place and largest value of the cubics through each four consecutive `values` (s,) at equal distances, between the
    middle two.

    Only where the parabolas through three of them, either way, have crests alike: where the curve has a corner it is
    not a cubic.
    """
    if len(values) < 4:
        return float(steps[values.argmax()]), float(values.max())
    y0, y1, y2, y3 = values[:-3], values[1:-2], values[2:-1], values[3:]
    top = np.maximum(y1, y2)
    first, second, third = 0.5 * (y2 - y0), y0 - 2.0 * y1 + y2, y3 - 3.0 * (y2 - y1) - y0
    other = second + third
    with np.errstate(divide="ignore", invalid="ignore"):
        # Crests of both parabolas above the middle two values; their curvatures are `second` and `other`.
        crests = [y1 - first**2 / (2.0 * second), y2 - (0.5 * (y3 - y1)) ** 2 / (2.0 * other)]
        slope = first - third / 6.0
        # Stationary point of y1 + slope t + second t^2/2 + third t^3/6, in the form without cancellation.
        t = -2.0 * slope / (second - np.sqrt(second**2 - 2.0 * slope * third))
        cubic = y1 + t * (slope + t * (0.5 * second + t * third / 6.0))
    low, high = np.minimum(*crests) - top, np.maximum(*crests) - top
    smooth = (second < 0.0) & (other < 0.0) & (t > 0.0) & (t < 1.0) & (low >= LIKE * high)
    cubic = np.where(smooth, cubic, top)
    place = int(cubic.argmax())
    at = float(t[place]) if smooth[place] else float(y2[place] > y1[place])
    return float(steps[1 + place]) + at, float(cubic[place])
