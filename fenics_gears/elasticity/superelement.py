"""Sectors of a gear joined one after the other: superelements over two cuts, the chosen flank nodes and the centre.

All dofs of a superelement are in one frame about the gear's centre, so that cuts which coincide are simply added.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fenics_gears.elasticity.condensation import CondensedBody
from fenics_gears.elasticity.cut_chain import eliminated
from fenics_gears.elasticity.ring import centre_motion, rotation
from fenics_gears.errors import ComputationError

CENTRE = 3


@dataclass(frozen=True)
class Superelement:
    """Stiffness of a run of sectors, Young's modulus 1 MPa, unit thickness, the hub carried rigidly by the centre.

    stiffness: over lower cut (`cut` dofs, clockwise side), upper cut (`cut`), flank nodes, centre (dx, dy, phi); nodes are
    interleaved x, y.
    """

    stiffness: np.ndarray
    cut: int

    @property
    def flank(self) -> int:
        """Number of dofs of flank nodes."""
        return len(self.stiffness) - 2 * self.cut - CENTRE

    def turned(self, angle: float) -> Superelement:
        """The same sectors turned counter-clockwise about the gear's centre by an angle (rad)."""
        turn = np.eye(len(self.stiffness))
        turn[:-1, :-1] = np.kron(np.eye(len(turn) // 2), rotation(angle))
        return Superelement(turn @ self.stiffness @ turn.T, self.cut)


def of_sector(sector: CondensedBody) -> Superelement:
    """One condensed sector in its own frame, its hub nodes tied to the centre."""
    groups = [sector.dofs(name) for name in ("lower", "upper", "flank")]
    free = np.concatenate(groups)
    reduced = np.zeros((len(sector.stiffness), len(free) + CENTRE))
    reduced[free, np.arange(len(free))] = 1.0
    reduced[sector.dofs("hub"), len(free):] = centre_motion(sector.points["hub"])
    return Superelement(reduced.T @ sector.stiffness @ reduced, len(groups[0]))


def joined(first: Superelement, second: Superelement) -> Superelement:
    """Two runs, the second on the counter-clockwise side of the first, their common cut eliminated.

    Raises ComputationError when the cuts do not have the same number of nodes.
    """
    if first.cut != second.cut:
        raise ComputationError(f"joining sectors: their cuts have {first.cut // 2} and {second.cut // 2} nodes, must be the same ones")
    lower, shared, upper, flank_1, flank_2, centre = _ranges([first.cut] * 3 + [first.flank, second.flank, CENTRE])
    total = np.zeros((centre[-1] + 1,) * 2)
    for part, places in ((first, (lower, shared, flank_1, centre)), (second, (shared, upper, flank_2, centre))):
        rows = np.concatenate(places)
        total[np.ix_(rows, rows)] += part.stiffness
    kept = np.concatenate([lower, upper, flank_1, flank_2, centre])
    return Superelement(eliminated(total, kept, shared), first.cut)


def closed(whole: Superelement) -> np.ndarray:
    """Stiffness over flank nodes and centre of a run that goes once around the gear, so that its ends meet."""
    cut, size = whole.cut, len(whole.stiffness)
    meet = np.zeros((size, size - cut))
    meet[:cut, :cut] = meet[cut:2 * cut, :cut] = np.eye(cut)
    meet[2 * cut:, cut:] = np.eye(size - 2 * cut)
    total = meet.T @ whole.stiffness @ meet
    return eliminated(total, np.arange(cut, len(total)), np.arange(cut))


def run_of(sector: Superelement, count: int, pitch: float) -> Superelement:
    """`count` (at least one) equal sectors one after the other, the first in the frame of `sector`; by doubling."""
    if count == 1:
        return sector
    half = run_of(sector, count // 2, pitch)
    twice = joined(half, half.turned(count // 2 * pitch))
    return twice if count % 2 == 0 else joined(twice, sector.turned((count - 1) * pitch))


def _ranges(counts: list[int]) -> list[np.ndarray]:
    ends = np.cumsum([0, *counts])
    return [np.arange(start, end) for start, end in zip(ends[:-1], ends[1:])]
