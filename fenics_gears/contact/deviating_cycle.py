"""A mesh cycle whose gaps are not the same in every cycle: errors of single teeth, run-out."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from fenics_gears.contact.mesh_cycle import Cycle, Position

Deviation = Callable[[float, Position], np.ndarray]


class DeviatingCycle:
    """The positions of a `cycle`, whose operators it shares, with gaps of their own at every step.

    `deviations`: functions of the step, counted from the start of the run, and its position, giving what opens the contact nodes
    further (n,), mm, negative where material is in excess. All else is the cycle's.
    """

    def __init__(self, cycle: Cycle, deviations: Sequence[Deviation]):
        self.cycle, self.deviations = cycle, tuple(deviations)

    def __getattr__(self, name: str):
        return getattr(self.cycle, name)

    def position(self, step: int) -> Position:
        """The contact equations at `step`."""
        return self._deviating(step, self.cycle.position(step))

    def between(self, step: float, before: float) -> Position:
        """The contact equations at a step that may lie between whole ones."""
        return self._deviating(step, self.cycle.between(step, before))

    def _deviating(self, step: float, position: Position) -> Position:
        gap = position.operator.gap
        for deviation in self.deviations:
            gap = gap + deviation(step, position)
        return replace(position, operator=replace(position.operator, gap=gap))
