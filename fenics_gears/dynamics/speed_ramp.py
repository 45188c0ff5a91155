"""A mesh frequency that changes linearly in time: the time of each step, and the inertia forces of the nominal motion.

Steps stand at equal phases n = step / steps_per_mesh_cycle. With f' constant, n = (f^2 - f_0^2)/(2 f'): the square of
the frequency is linear in the phase, and the time from one phase to another is 2 (n_1 - n_0)/(f_0 + f_1).

The frame of the nominal motion turns with the gears. Where it accelerates, inertia forces -M X'' of the nominal motion
X act in it: on arcs rb phi, X'' = p_b f' for the pinion, -p_b f' for the wheel, which turns the other way, and nothing
for the twist of a shaft. Damping is that of the motion relative to the nominal one, as at a steady speed.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import sqrt

import numpy as np


@dataclass(frozen=True)
class RampClock:
    """Mesh frequency `start` (Hz) up to step `held`, then linear in time to `end` at step `last`; steady before and
    after."""

    start: float
    end: float
    held: int
    last: int
    steps_per_mesh_cycle: int

    @property
    def acceleration(self) -> float:
        """Change of the mesh frequency during the ramp, Hz/s."""
        cycles = (self.last - self.held) / self.steps_per_mesh_cycle
        return (self.end - self.start) * (self.end + self.start) / (2.0 * cycles)

    def mesh_frequency(self, step: float) -> float:
        """Mesh frequency at a step, Hz."""
        part = min(max((step - self.held) / (self.last - self.held), 0.0), 1.0)
        return sqrt((1.0 - part) * self.start**2 + part * self.end**2)

    def time(self, step: float) -> float:
        """Time of a step, s."""
        return self.duration(0, step) if step >= 0 else -self.duration(step, 0)

    def duration(self, first: float, last: float) -> float:
        """Time from one step to a later one, s."""
        ends = [first, *(end for end in (self.held, self.last) if first < end < last), last]
        passed = 0.0
        for begin, end in zip(ends[:-1], ends[1:]):
            passed += (
                2.0
                * (end - begin)
                / (self.steps_per_mesh_cycle * (self.mesh_frequency(begin) + self.mesh_frequency(end)))
            )
        return passed

    def speed(self, first: float, last: float) -> float:
        """Mean speed from one step to another, over that at the start."""
        return (last - first) / (self.steps_per_mesh_cycle * self.start * self.duration(first, last))

    def times(self, steps: np.ndarray) -> np.ndarray:
        """Times (s,) of many steps, s."""
        return np.array([self.time(step) for step in steps.tolist()])

    def durations(self, steps: np.ndarray) -> np.ndarray:
        """Times from each of s + 1 steps to the next, (s,), s."""
        return np.array([self.duration(*ends) for ends in zip(steps[:-1].tolist(), steps[1:].tolist())])

    def acceleration_at(self, step: float) -> float:
        """Change of the mesh frequency at a step, Hz/s; the mean of both sides where a ramp begins after steady cycles.

        A ramp that begins with the run is taken as having begun before it.
        """
        if step == self.held and self.held > 0:
            return 0.5 * self.acceleration
        ramping = (self.held == 0 or step > self.held) and step <= self.last
        return self.acceleration if ramping else 0.0


def inertia_forces(clock: RampClock, momentum: np.ndarray) -> Callable[[float], np.ndarray]:
    """Forces (k,), N, of the accelerating nominal motion at a step; `momentum` (k,), N s^2: of this motion per Hz of
    the clock's mesh frequency."""

    def load(step: float) -> np.ndarray:
        return -momentum * clock.acceleration_at(step)

    return load


def centrifugal_forces(clock: RampClock, at_start: np.ndarray) -> Callable[[float], np.ndarray]:
    """Forces (k,), N, at a step beyond those `at_start` (k,), by the square of the speed."""

    def load(step: float) -> np.ndarray:
        return ((clock.mesh_frequency(step) / clock.start) ** 2 - 1.0) * at_start

    return load
