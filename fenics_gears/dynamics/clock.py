"""When a step is: steps stand at equal phases of the mesh, and a clock says at what time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol


class Clock(Protocol):
    """Times of steps, which may lie between whole ones; step 0 is at time 0."""

    def time(self, step: float) -> float:
        """Time of a step, s."""

    def duration(self, first: float, last: float) -> float:
        """Time from one step to another, s, free of the round-off of a difference of times."""


@dataclass(frozen=True)
class SteadyClock:
    """All steps as long as the next: `time_step`, s."""

    time_step: float

    def time(self, step: float) -> float:
        """Time of a step, s."""
        return step * self.time_step

    def duration(self, first: float, last: float) -> float:
        """Time from one step to another, s."""
        return (last - first) * self.time_step
