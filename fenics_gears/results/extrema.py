"""Extrema of a run's curves, located between its steps: of a quasi-static run at positions that are solved where
`results.crests` asks for them.

With inertia curves are smooth, and the extremum is that of cubics. Where steps are too long for any vibration, the
motion follows the static one: positions are solved as without inertia.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from math import ceil, isfinite, log2

import numpy as np

from fenics_gears.contact.mesh_cycle import COMMON_PLACES, Cycle
from fenics_gears.dynamics.batch import Batch
from fenics_gears.dynamics.march import thread_pools
from fenics_gears.dynamics.marched import BetweenSteps, March, Place
from fenics_gears.dynamics.steps import Record
from fenics_gears.effects import common_period
from fenics_gears.model.model import Model

from .crests import Searches
from .key_numbers import largest_force_over_time
from .numbers import CUBICS, SAME, SOLVED, STEPS, largest_of_cubics

# Up to which part of the curve's span an extremum is sought.
SOUGHT = 1e-4
# Places between steps divide a step by eight at least and a mesh cycle by so many: friction turns, and pairs enter
# contact, within less.
LARGEST_PART = 0.125
PLACES = 800
# Over a face positions cost a hundred times as much, and slices leave a peak-to-peak value some 2 % uncertain.
SOUGHT_OVER_FACE = 2e-3
# Nor is less sought than this part of the largest value. A helical pair's error may vary by 3 nm of 25 um; its
# peak-to-peak value is promised to 0.2 % of the mean, ten times this (docs/third_dimension.md).
LEAST_SOUGHT_OVER_FACE = 2e-4
# Longer periods are not held in memory.
MOST_RECORDS = 2000
# A position solved again is that of the march if it is as near as this part of what is sought.
SAME_POSITION = 0.1


@dataclass(frozen=True)
class Quantity:
    """A `curve` (s,) over the settled steps of a run, and its value `of` a position that is solved; the `run`, of
    several that are marched together."""

    curve: np.ndarray
    of: Callable[[Record], float]
    run: int = 0


@dataclass(frozen=True)
class Extremum:
    """A largest value, where it is in mesh cycles since the start, and how it was located."""

    value: float
    mesh_phase: float
    found_by: str


class Extrema:
    """Locates the largest values of curves over the settled steps of a run, or of runs that are marched together.

    `mesh_phase`, `transmission_error` (s,), rad: of consecutive steps; the latter tells whether a position solved again
    is that of the march. `marches` by run: hold solutions with friction, from which positions are solved. `batch`: of
    the runs, where there are several. `first`: the step from which on these are counted.
    """

    def __init__(
        self,
        model: Model,
        cycle: Cycle,
        mesh_phase: np.ndarray,
        transmission_error: np.ndarray,
        marches: Sequence[March] = (),
        batch: Batch | None = None,
    ):
        self._model = model
        self._cycle = cycle
        self._steps = np.rint((mesh_phase - cycle.mesh.ahead) * cycle.steps).astype(int)
        self._period = common_period(model.scene) * cycle.steps
        whole = isfinite(self._period) and len(self._steps) > self._period
        # Solved in the first period, so that the same cycles give the same bits however many are run.
        self.first = int((self._steps[-1] - self._period) // self._period * self._period) if whole else 0
        self._whole = whole
        self._quasi_static = model.drivetrain.mass is None
        follows_statics = self._quasi_static or not model.time_scales.averages_acceleration
        self._sought = SOUGHT_OVER_FACE
        self._finest = LARGEST_PART
        self._corners = cycle.face.slices == 1
        if self._corners:
            wanted = 2.0 ** -ceil(log2(PLACES / cycle.steps))
            self._sought = SOUGHT
            self._finest = min(max(wanted, 1.0 / COMMON_PLACES), LARGEST_PART)
        self._way = CUBICS if not follows_statics else SOLVED if cycle.traits.divisible else STEPS
        if self._way == SOLVED:
            # Not methods: a circle of references would keep all operators until Python looks for garbage.
            same = SAME_POSITION * SOUGHT * float(np.ptp(transmission_error)) if self._quasi_static else np.inf
            marched = partial(_is_marched, model, transmission_error, self._place(0), same)
            held = partial(_held, marches, self.first)
            self._between = BetweenSteps(batch or Batch(cycle, [model.equations_of_motion]), marched, held)

    def largest(self, quantities: Sequence[Quantity]) -> list[Extremum]:
        """The largest value of each quantity; what they ask for between steps is solved together."""
        curves = np.array([quantity.curve for quantity in quantities])
        tops = curves.max(axis=1)
        round_off = _round_off(curves)
        if self._way == SOLVED:
            located = self._solved(quantities, curves, round_off)
        else:
            cubics = self._way == CUBICS
            located = [
                (*(largest_of_cubics(self._steps, each) if cubics else (0.0, -np.inf)), self._way) for each in curves
            ]
        # The first of all that differ by round-off: cycles repeat.
        firsts = self._steps[np.argmax(curves >= (tops - round_off)[:, None], axis=1)]
        extrema = []
        for (step, value, way), top, least, first in zip(located, tops.tolist(), round_off.tolist(), firsts.tolist()):
            if value <= top + least:
                step = float(first)
                value = top
            extrema.append(Extremum(value, step / self._cycle.steps + self._cycle.mesh.ahead, way))
        return extrema

    def _solved(
        self, quantities: Sequence[Quantity], curves: np.ndarray, round_off: np.ndarray
    ) -> list[tuple[float, float, str]]:
        """Step, largest value, and the way, of each quantity by positions that are solved."""
        sought = self._sought * np.ptp(curves, axis=1) + round_off
        if not self._corners:
            sought = np.maximum(sought, LEAST_SOUGHT_OVER_FACE * np.abs(curves).max(axis=1))
        ways = [SOLVED] * len(quantities)
        search = Searches(*self._last_period(curves), sought, self._finest, self._corners)
        with thread_pools().limit(limits=1):
            while len(asking := np.flatnonzero(~np.isnan(search.asked)).tolist()):
                values = np.full(len(quantities), np.nan)
                values[asking] = self._values([(quantities[each], float(search.asked[each])) for each in asking])
                for each in asking:
                    ways[each] = STEPS if np.isnan(values[each]) else SOLVED
                search.take(values)
        return [(self.first + step, top, way) for (step, top), way in zip(search.tops.tolist(), ways)]

    def _values(self, asked: Sequence[tuple[Quantity, float]]) -> list[float]:
        """Values of quantities at places between steps; not a number where one cannot be solved."""
        # With inertia also the steps on either side.
        sides = () if self._quasi_static else (-1, 0)
        places = [(of.run, each) for of, step in asked for each in (step, *(ceil(step) + at for at in sides))]
        records = self._between.at(places)
        return [self._at(step, quantity, records) for quantity, step in asked]

    def transmission_error(self, record: Record) -> float:
        return float(self._model.transmission_error(record.state.position))

    def _place(self, step: float) -> int:
        """Place of a step of the period among all steps."""
        return int(step) + self.first - int(self._steps[0])

    def _at(self, step: float, quantity: Quantity, records: Mapping[Place, Record | None]) -> float:
        """Value of a quantity at a place between two steps; not a number where it cannot be solved. With inertia it is
        the static value and, straight between the steps, by what the curve differs from static values there."""
        record = records[quantity.run, step]
        if record is None or self._quasi_static:
            return np.nan if record is None else quantity.of(record)
        ends = (ceil(step) - 1, ceil(step))
        apart = []
        for end in ends:
            static = records[quantity.run, end]
            if static is None:
                return np.nan
            apart.append(quantity.curve[self._place(end)] - quantity.of(static))
        return quantity.of(record) + float(np.interp(step, ends, apart))

    def _last_period(self, curves: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Steps from the first of a period, and values (c, ...) of the last period with a step before and after it, as
        it repeats. Of all steps where no period is whole."""
        if not self._whole:
            return self._steps.astype(float), curves
        steps = self._steps[-self._period - 1 :] - self.first
        values = curves[:, -self._period - 1 :]
        return np.concatenate(([steps[0] - 1.0], steps, [steps[-1] + 1.0])), np.concatenate(
            (values[:, -2:-1], values, values[:, 1:2]), axis=1
        )


def _round_off(curves: np.ndarray) -> np.ndarray:
    return SAME * np.abs(curves).max(axis=1)


def _is_marched(model: Model, transmission_error: np.ndarray, first: int, same: float, record: Record) -> bool:
    """Whether a position has the transmission error (s,) of the march at its step, of which step 0 has the place
    `first`; any has where `same` is infinite."""
    if same == np.inf:
        return True
    error = float(model.transmission_error(record.state.position))
    return abs(error - transmission_error[int(record.step) + first]) <= same


def _held(marches: Sequence[March], first: int, run: int, step: int) -> Record | None:
    """A step of the period that begins at the step `first` of a march, where one holds it."""
    return marches[run].held(step + first) if marches else None


def repeating_steps(model: Model) -> int:
    """Steps of a march after which they repeat, where the solutions of so many are needed to locate extrema; else 0."""
    period = common_period(model.scene) * model.resolution.steps_per_mesh_cycle
    needed = model.scene.friction is not None and model.drivetrain.mass is None
    return int(period) if needed and period <= min(model.steps, MOST_RECORDS) else 0


Numbers = dict[str, float | str]


def extremes(
    extrema: Extrema, runs: Sequence[tuple[int, Mapping[str, np.ndarray], bool]]
) -> list[tuple[Numbers, Numbers]]:
    """The extremes of each run, given by its number and curves: of the transmission error and, where asked for, of the
    largest normal force of a tooth pair."""
    of = extrema.transmission_error
    quantities = []
    for run, curves, force in runs:
        error = curves["transmission_error"]
        quantities += [Quantity(error, of, run), Quantity(-error, lambda record: -of(record), run)]
        quantities += [pair_force(curves, run)] if force else []
    largest = iter(extrema.largest(quantities))
    return [(_of_error(next(largest), next(largest)), _of_force(next(largest)) if force else {}) for *_, force in runs]


def _of_error(largest: Extremum, least: Extremum) -> Numbers:
    return {
        "peak_to_peak_transmission_error": largest.value + least.value,
        "peak_to_peak_transmission_error_from": least.found_by if largest.found_by == SOLVED else largest.found_by,
        "largest_transmission_error_mesh_phase": largest.mesh_phase,
        "least_transmission_error_mesh_phase": least.mesh_phase,
    }


def _of_force(largest: Extremum) -> Numbers:
    return {
        "largest_pair_force": largest.value,
        "largest_pair_force_mesh_phase": largest.mesh_phase,
        "largest_pair_force_from": largest.found_by,
    }


def pair_force(curves: Mapping[str, np.ndarray], run: int = 0) -> Quantity:
    return Quantity(largest_force_over_time(curves), _largest_force_of_a_pair, run)


def _largest_force_of_a_pair(record: Record) -> float:
    operator = record.position.operator
    pair_of_node = operator.node_pair
    if operator.face.slices > 1:
        # There a tooth pair has nodes in many slices.
        keys = [(pair.place.flank, pair.place.index) for pair in operator.pairs]
        numbers = {key: number for number, key in enumerate(dict.fromkeys(keys))}
        pair_of_node = np.array([numbers[key] for key in keys], dtype=int)[pair_of_node]
    return float(np.bincount(pair_of_node, record.solution.forces[: operator.nodes], minlength=1).max())
