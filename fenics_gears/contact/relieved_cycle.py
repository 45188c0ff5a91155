"""A mesh cycle of modified flanks on the operators of another one: material removed from flanks opens gaps and changes
nothing else."""

from __future__ import annotations

from dataclasses import replace
from weakref import WeakKeyDictionary

import numpy as np

from fenics_gears.contact.deviating_cycle import DeviatingCycle
from fenics_gears.contact.interpolation import INTERPOLATIONS, Averages, Points
from fenics_gears.contact.mesh_cycle import Cycle, MeshCycle, Position
from fenics_gears.contact.tooth_pair import PairNodes, Removal, facing_points, seen_gap

# A tooth pair, and at the points that its nodes see the roll angles (rad) of pinion and wheel and the gap (mm) of true
# involutes.
Facing = tuple[PairNodes, tuple[np.ndarray, np.ndarray], np.ndarray]
# Cycles with different reliefs on the same operators, such as those of a study, have these in common.
_FACING: WeakKeyDictionary[Cycle, dict[int, list[Facing]]] = WeakKeyDictionary()


class RelievedCycle(DeviatingCycle):
    """The positions of a `cycle` along the line of action with the gaps of flanks from which `removal` is taken, in
    place of its own removal.

    What it gives is, to the last digit, what a MeshCycle of these flanks gives.
    """

    def __init__(self, cycle: MeshCycle, removal: tuple[Removal | None, Removal | None]):
        super().__init__(cycle, ())
        self._flanks, self._facing = replace(cycle.flanks, removal=removal), _FACING.setdefault(cycle, {})
        self._view: Averages | Points = INTERPOLATIONS[self.grid.interpolation]

    def position(self, step: int) -> Position:
        """The contact equations at `step`; every mesh cycle has the same gaps."""
        index = step % self.steps
        found = self._positions.get(index)
        if found is None:
            found = super().position(index)
            # What the cycle does not keep for want of memory is not kept here.
            if self.cycle.keeps(index):
                self._positions[index] = found
        return found

    def _deviating(self, step: float, position: Position) -> Position:
        gaps = [self._gap(*each) for each in self._facing_points(step, position)]
        return position.with_gap(np.concatenate(gaps) if gaps else np.empty(0))

    def _facing_points(self, step: float, position: Position) -> list[Facing]:
        if step in self._facing:
            return self._facing[step]
        found = []
        for pair in position.operator.pairs:
            rolls, _, gap = facing_points(self.pair, (None, None), pair.place, self._view.places(pair.offsets))
            found.append((pair, rolls, gap))
        if step == int(step) and self.cycle.keeps(int(step)):
            self._facing[int(step)] = found
        return found

    def _gap(self, pair: PairNodes, rolls: tuple[np.ndarray, np.ndarray], gap: np.ndarray) -> np.ndarray:
        for removed, roll in zip(self._flanks.removal_at(pair.place), rolls):
            if removed is not None:
                gap = gap + removed(roll)
        return seen_gap(self._view, pair.offsets, gap)
