"""The mesh as springs along the line of action: stiffness tables, stiffness by a standard.

A mesh spring that stiffens with its load, piecewise linear, is a row of linear springs side by side, each with a gap of
its own:
``F(u) = sum k_i (u - g_i)_+``. Each is a contact node, so that the march through time needs nothing new, and the energy
is exactly ``sum p_i^2/(2 k_i)``. The springs of a tooth pair stand where its flanks meet on the line of action, with
the lever arms that friction has there; across that line they yield as much as along it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from fenics_gears.contact.mesh_cycle import Cycle, CycleTraits, Position
from fenics_gears.contact.operator import operator_on_lines, over_nodes
from fenics_gears.contact.tooth_pair import DRIVE, PairNodes, Place, coast_place, drive_place
from fenics_gears.contact.window import ContactGrid
from fenics_gears.geometry.pair import GearPair

# The springs of a pair stand at one point; this distance (mm) between them tells them apart from step to step.
APART = 1e-9


@dataclass(frozen=True)
class PairSprings:
    """Springs of a tooth pair: its `index`, `flank` DRIVE or COAST, `level` (m,) numbers, `gap` (m,), mm, `stiffness`
    (m,), N/mm."""

    index: int
    flank: int
    level: np.ndarray
    gap: np.ndarray
    stiffness: np.ndarray


# The springs at a phase (0 <= phase < 1).
Springs = Callable[[float], list[PairSprings]]


@dataclass(frozen=True)
class SpringNodes(PairNodes):
    """Contact nodes (m,) that are springs of `stiffness` (m,), N/mm."""

    stiffness: np.ndarray


class SpringCycle(Cycle):
    """A mesh of springs. `levels`: at most so many of a pair; `coordinates`: which centre coordinates are unknowns;
    `tangential`: friction."""

    traits = CycleTraits(divisible=True, nodes_on_flanks=False, has_pressure=False)

    def __init__(
        self,
        pair: GearPair,
        springs: Springs,
        levels: int,
        steps: int,
        coordinates: list[int],
        tangential: bool,
        coast_flanks: bool,
    ):
        super().__init__(pair, ContactGrid(APART * max(levels - 1, 1), max(levels, 2)), steps, coast_flanks)
        self._springs, self._coordinates, self._tangential = springs, coordinates, tangential

    def _pairs_of(self, index: float) -> tuple[SpringNodes, ...]:
        return tuple(self._nodes(springs, index / self.steps) for springs in self._springs(index / self.steps))

    def _nodes(self, springs: PairSprings, phase: float) -> SpringNodes:
        pair, count = self.pair, len(springs.gap)
        xi = pair.path_start + (phase + springs.index) * pair.base_pitch
        place: Place = (drive_place if springs.flank == DRIVE else coast_place)(pair, springs.index, xi)
        arm = place.contact_rolls[0] * pair.pinion.base_radius
        roll = float(np.clip(place.contact_rolls[0], pair.pinion.form_roll_angle, pair.pinion.tip_roll_angle))
        return SpringNodes(
            place=place,
            offsets=APART * springs.level,
            lengths=np.ones(count),
            gap=springs.gap,
            pinion_lever_arm=np.full(count, arm),
            wheel_lever_arm=np.full(count, pair.line_of_action_length - arm),
            pinion_roll=np.full(count, roll),
            stiffness=springs.stiffness,
        )

    def _position(self, index: float, pairs, previous, advance: float, carried: np.ndarray) -> Position:
        compliance = np.diag(np.tile(1.0 / over_nodes(pairs, "stiffness"), 2 if self._tangential else 1))
        before = _carried_softness(previous, carried) if self._tangential else None
        return Position(operator_on_lines(self.pair, pairs, self._coordinates, compliance, before, advance), carried)


def _carried_softness(previous, carried: np.ndarray) -> np.ndarray:
    """Tangential displacement (n, 2 m) that springs (n,) had a step before per force on the springs (m,) of then."""
    softness = 1.0 / over_nodes(previous, "stiffness")
    count, known = len(softness), np.flatnonzero(carried >= 0)
    result = np.zeros((len(carried), 2 * count))
    result[known, count + carried[known]] = softness[carried[known]]
    return result
