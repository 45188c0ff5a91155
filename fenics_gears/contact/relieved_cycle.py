"""A mesh cycle of modified flanks on the operators of another one: material removed from flanks opens gaps and changes nothing else."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fenics_gears.contact.deviating_cycle import DeviatingCycle
from fenics_gears.contact.interpolation import INTERPOLATIONS
from fenics_gears.contact.mesh_cycle import MeshCycle, Position
from fenics_gears.contact.tooth_pair import PairNodes, Removal, facing_points


class RelievedCycle(DeviatingCycle):
    """The positions of a `cycle` along the line of action with the gaps of flanks from which `removal` is taken, in place of its own removal.

    What it gives is, to the last digit, what a MeshCycle of these flanks gives.
    """

    def __init__(self, cycle: MeshCycle, removal: tuple[Removal | None, Removal | None]):
        super().__init__(cycle, ())
        self._flanks = replace(cycle.flanks, removal=removal)

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
        gaps = [self._gap(pair) for pair in position.operator.pairs]
        return position.with_gap(np.concatenate(gaps) if gaps else np.empty(0))

    def _gap(self, pair: PairNodes) -> np.ndarray:
        view, offsets = INTERPOLATIONS[self.grid.interpolation], pair.offsets
        return view.seen(offsets, facing_points(self.pair, self._flanks.removal_at(pair.place), pair.place, view.places(offsets))[2])
