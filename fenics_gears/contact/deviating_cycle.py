"""A mesh cycle whose gaps differ from cycle to cycle: errors of single teeth, run-out."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from fenics_gears.contact.mesh_cycle import Cycle, Position
from fenics_gears.contact.step_solver import StepProblem, StepSolution
from fenics_gears.contact.tooth_pair import PairNodes

Deviation = Callable[[float, Position], np.ndarray]


class DeviatingCycle(Cycle):
    """The positions of a `cycle`, whose operators it shares, with gaps of their own at every step.

    `deviations`: functions of the step, counted from the start of the run, and its position, giving what opens the
        contact nodes
    further (n,), mm, negative where material is in excess.
    """

    def __init__(self, cycle: Cycle, deviations: Sequence[Deviation]):
        super().__init__(cycle.pair, cycle.grid, cycle.steps, cycle.coast_flanks, cycle.corner)
        self.cycle, self.deviations, self.traits = cycle, tuple(deviations), cycle.traits
        self.kept, self.face = cycle.kept, cycle.face

    @property
    def base(self) -> Cycle:
        """The cycle whose contact nodes this one has."""
        return self.cycle.base

    @property
    def bodies(self) -> tuple:
        """Flank compliance of pinion and wheel; empty where they have none."""
        return self.cycle.bodies

    def pairs_at(self, index: int) -> tuple[PairNodes, ...]:
        """The tooth pairs that can touch at position `index` (0 to steps - 1)."""
        return self.cycle.pairs_at(index)

    def solve(
        self, position: Position, problem: StepProblem, status: np.ndarray, last: StepSolution | None
    ) -> StepSolution:
        """Solve a step at a position, as the cycle does. Raises ContactNotConverged."""
        return self.cycle.solve(position, problem, status, last)

    def position(self, step: int) -> Position:
        """The contact equations at `step`."""
        return self._deviating(step, self.cycle.position(step))

    def between(self, step: float, before: float) -> Position:
        """The contact equations at a step that may lie between whole ones."""
        return self._deviating(step, self.cycle.between(step, before))

    def _deviating(self, step: float, position: Position) -> Position:
        gap, share = position.operator.gap, 1.0 if self.face is None else self.face.cosine
        for deviation in self.deviations:
            # Deviations are measured along the line of action, gaps along the normal.
            gap = gap + share * deviation(step, position)
        return position.with_gap(gap)
