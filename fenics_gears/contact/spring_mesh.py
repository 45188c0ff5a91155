"""The mesh as springs along the line of action: stiffness tables, stiffness by a standard.

A mesh spring that stiffens with its load, piecewise linear, is a row of linear springs side by side, each with a gap of
its own:
``F(u) = sum k_i (u - g_i)_+``. Each is a contact node, so that the march through time needs nothing new, and the energy
is exactly ``sum p_i^2/(2 k_i)``. The springs of a tooth pair are where its flanks meet on the line of action, with the
lever arms that friction has there. Across that line they are as soft as along it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from fenics_gears.geometry.pair import GearPair

from .mesh import Mesh, MeshTraits
from .operator import Passage, Response
from .tooth_pair import DRIVE, PairNodes, coast_place, drive_place, over_nodes
from .window import ContactGrid

# The springs of a pair are at one point; this distance (mm) between them tells them apart from step to step.
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


def spring_mesh(pair: GearPair, springs: Springs, levels: int, coast_flanks: bool) -> Mesh:
    """A mesh of springs, at most so many `levels` of a pair."""
    return Mesh(
        pair,
        ContactGrid(APART * max(levels - 1, 1), max(levels, 2)),
        lambda phases: [tuple(_nodes(pair, each, phase) for each in springs(phase)) for phase in phases],
        lambda passages: [_response(passage) for passage in passages],
        traits=MeshTraits(divisible=True, nodes_on_flanks=False, has_pressure=False),
        coast_flanks=coast_flanks,
    )


def _nodes(pair: GearPair, springs: PairSprings, phase: float) -> SpringNodes:
    xi = pair.path_start + (phase + springs.index) * pair.base_pitch
    place = (drive_place if springs.flank == DRIVE else coast_place)(pair, springs.index, xi)
    ones = np.ones(len(springs.gap))
    gears = [side.gear for side in pair.sides]
    arms = [gear.base_radius * roll for gear, roll in zip(gears, place.contact_rolls)]
    rolls = [np.clip(roll, *gear.roll_ends) for gear, roll in zip(gears, place.contact_rolls)]
    return SpringNodes(
        place=place,
        offsets=APART * springs.level,
        lengths=ones,
        gap=springs.gap,
        friction_arms=np.outer(arms, ones),
        rolls=np.outer(rolls, ones),
        stiffness=springs.stiffness,
    )


def _response(passage: Passage) -> Response:
    softness = 1.0 / over_nodes(passage.pairs, "stiffness")
    if passage.previous is None:
        return Response(np.diag(softness))
    earlier = 1.0 / over_nodes(passage.previous, "stiffness")
    before = passage.node_before
    # Tangential displacement of the springs that were there a step before, per force on them then.
    displacement = np.zeros((len(before), 2 * len(earlier)))
    known = np.flatnonzero(before >= 0)
    displacement[known, len(earlier) + before[known]] = earlier[before[known]]
    return Response(np.diag(np.tile(softness, 2)), displacement)
