"""Gaps of modified flanks on the contact operators of others: material removed from flanks opens gaps and changes
nothing else."""

from __future__ import annotations

import numpy as np

from fenics_gears.contact.interpolation import INTERPOLATIONS, Averages, Points
from fenics_gears.contact.mesh_cycle import Cycle, Gaps, PerPosition, Position
from fenics_gears.contact.tooth_pair import DRIVE, PairNodes, Removal, facing_points, seen_gap

# A tooth pair, and at the points that its nodes average over the roll angles (rad) of pinion and wheel and the gap (mm)
# of true involutes.
Facing = tuple[PairNodes, tuple[np.ndarray, np.ndarray], np.ndarray]


class FacingPoints:
    """The facing points of the positions of a cycle, which all reliefs on its operators have in common."""

    def __init__(self):
        self.known: dict[float, list[Facing]] = {}


def relieved(cycle: Cycle, removal: tuple[Removal | None, Removal | None]) -> Cycle:
    """The operators of a `cycle` of flanks along the line of action with the gaps of flanks from which `removal` is
    taken, in place of its own.

    What it gives is, to the last digit, what a cycle of these flanks gives.
    """
    view: Averages | Points = INTERPOLATIONS[cycle.grid.interpolation]
    facing = PerPosition(
        lambda position: [
            (pair, *facing_points(cycle.pair, (None, None), pair.place, view.places(pair.offsets))[::2])
            for pair in position.operator.pairs
        ],
        cycle.beside(FacingPoints).known,
    )

    def profile(position: Position) -> np.ndarray:
        gaps = []
        for pair, rolls, gap in facing(position):
            for removed, roll in zip(removal if pair.place.flank == DRIVE else (None, None), rolls):
                if removed is not None:
                    gap = gap + removed(roll)
            gaps.append(seen_gap(view, pair.offsets, gap))
        return np.concatenate(gaps) if gaps else np.empty(0)

    return cycle.with_gaps(Gaps(profile=profile))
