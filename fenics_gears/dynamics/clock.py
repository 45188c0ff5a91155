"""Times of the steps: steps stand at equal phases of the mesh, and a clock gives the time of each."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol


class Clock(Protocol):
    """Times of steps, which may lie between whole ones; step 0 is at time 0."""

    def time(self, step: float) -> float:
        """Time of a step, s."""

    def duration(self, first: float, last: float) -> float:
        """Time from one step to another, s, without the round-off of a difference of times."""


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
