"""Times of the steps: steps stand at equal phases of the mesh, and a clock gives the time of each."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np


class Clock(Protocol):
    """Times of steps, which may lie between whole ones; step 0 is at time 0."""

    def time(self, step: float) -> float:
        """Time of a step, s."""

    def duration(self, first: float, last: float) -> float:
        """Time from one step to another, s, without the round-off of a difference of times."""

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

    def times(self, steps: np.ndarray) -> np.ndarray:
        """Times (s,) of many steps, s."""
        return steps * self.time_step

    def durations(self, steps: np.ndarray) -> np.ndarray:
        """Times from each of s + 1 steps to the next, (s,), s."""
        return np.diff(steps) * self.time_step
