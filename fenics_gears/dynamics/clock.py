"""Times of the steps: steps stand at equal phases of the mesh, and a clock gives the time of each; and how mesh and
time step compare with the drivetrain's vibrations, which decides on the start of a march and its method in time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

import numpy as np
from numpy.typing import ArrayLike

if TYPE_CHECKING:
    from .frequencies import Vibration


class Clock(Protocol):
    """Times of steps, which may lie between whole ones; step 0 is at time 0."""

    def time(self, step: float) -> float:
        """Time of a step, s."""

    def duration(self, first: float, last: float) -> float:
        """Time from one step to another, s, without the round-off of a difference of times."""

    def speed(self, first: float, last: float) -> float:
        """Mean speed from one step to another, over that at the start."""

    def times(self, steps: np.ndarray) -> np.ndarray:
        """Times (s,) of many steps, s."""

    def durations(self, steps: np.ndarray) -> np.ndarray:
        """Times from each of s + 1 steps to the next, (s,), s."""


@dataclass(frozen=True)
class SteadyClock:
    """All steps of one length, `time_step`, s."""

    time_step: float

    def time(self, step: float) -> float:
        """Time of a step, s."""
        return step * self.time_step

    def duration(self, first: float, last: float) -> float:
        """Time from one step to another, s."""
        return (last - first) * self.time_step

    def speed(self, first: float, last: float) -> float:
        """The same at all steps."""
        return 1.0

    def times(self, steps: np.ndarray) -> np.ndarray:
        """Times (s,) of many steps, s."""
        return steps * self.time_step

    def durations(self, steps: np.ndarray) -> np.ndarray:
        """Times from each of s + 1 steps to the next, (s,), s."""
        return np.diff(steps) * self.time_step


@dataclass(frozen=True)
class TimeScales:
    """Mesh and time step compared with vibrations.

    `samples_vibration`: a period of the slowest vibration has two steps or more, the least that can represent it.
    `follows_statics`: the mesh is slower than the slowest vibration. `outruns_vibration`: it is faster than the
    fastest.
    `impulsive`: flanks are rigid and forces jump; with average acceleration they would change sign at every step from
    then on.
    """

    samples_vibration: bool = True
    follows_statics: bool = True
    outruns_vibration: bool = False
    impulsive: bool = False

    @property
    def averages_acceleration(self) -> bool:
        """Whether average acceleration is the method in time, else backward Euler."""
        return self.samples_vibration and not self.impulsive


FOLLOWING = TimeScales()


def time_scales(elastic: Sequence[Vibration], mesh_frequencies: ArrayLike, time_step: float) -> TimeScales:
    """The time scales of mesh frequencies (Hz) and a step (s) among a drivetrain's elastic modes by frequency."""
    if not elastic:
        return FOLLOWING
    return TimeScales(
        samples_vibration=2.0 * time_step * elastic[0].frequency <= 1.0,
        follows_statics=bool(np.max(mesh_frequencies) < elastic[0].frequency),
        outruns_vibration=bool(np.min(mesh_frequencies) > elastic[-1].frequency),
    )
