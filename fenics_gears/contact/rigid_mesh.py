"""The mesh of rigid flanks: the tooth pair with the smallest gap carries the whole force, and its gap is the
kinematic transmission error."""

from __future__ import annotations

import numpy as np

from fenics_gears.geometry.pair import GearPair
from fenics_gears.geometry.sliding import sliding_per_rotation

from .interpolation import hat_integrals
from .kinematics import lines_of
from .mesh import Mesh, MeshTraits, nodes_at
from .operator import Passage, Response
from .places import pair_places
from .rigid_step import solve_rigid
from .tooth_pair import DRIVE, PairNodes, Place, Removal, count_of, facing_points_at
from .window import ContactGrid, flank_ends, node_offsets


def rigid_mesh(
    pair: GearPair, removal: tuple[Removal | None, Removal | None], grid: ContactGrid, coast_flanks: bool = False
) -> Mesh:
    """Rigid flanks; `removal`: material removed from either drive flank."""
    return Mesh(
        pair,
        grid,
        lambda phases: [
            nodes_at(pair_places(pair, grid, phase, coast_flanks), lambda place: _nodes(pair, removal, grid, place))
            for phase in phases
        ],
        lambda passages: [_response(pair, passage) for passage in passages],
        solve_rigid,
        MeshTraits(has_pressure=False, rigid=True),
        coast_flanks=coast_flanks,
    )


def _nodes(pair: GearPair, removal, grid: ContactGrid, place: Place) -> PairNodes | None:
    offsets = node_offsets(flank_ends(pair, place.contact_rolls), grid)
    if not len(offsets):
        return None
    if offsets[0] < 0.0 < offsets[-1]:
        # True involutes touch on the line of action itself.
        offsets = np.unique(np.append(offsets, 0.0))
    removal = removal if place.flank == DRIVE else (None, None)
    rolls, arms, gap = facing_points_at(pair, removal, place, offsets)
    return PairNodes(place, offsets, hat_integrals(offsets), gap, arms, rolls)


def _response(pair: GearPair, passage: Passage) -> Response:
    """No compliance, and the sense in which the nodes slide in the nominal motion."""
    nodes = count_of(passage.pairs)
    if passage.previous is None:
        return Response(np.zeros((nodes, nodes)))
    lines = lines_of(passage.pairs, pair.sides)
    sliding = np.sign(lines.turn * sliding_per_rotation(pair, lines.friction_arms[0]))
    # By columns, as it is stored.
    before = np.zeros((2 * count_of(passage.previous), nodes)).T
    return Response(np.zeros((2 * nodes, 2 * nodes)), before, sliding=sliding)
