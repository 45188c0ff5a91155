"""Contact of flank nodes that meet pair by pair [9]: the reference route's nodes, gaps and displacements.

Both gears are meshed so that every contact node of a position is a node on either flank. Nothing is averaged and, but
for the last step's displacement [A.2]-[A.4], nothing interpolated.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fenics_gears.elasticity.remeshed_gear import LoadedTooth
from fenics_gears.geometry.pair import GearPair
from fenics_gears.geometry.side import Side

from .interpolation import hat_integrals
from .kinematics import COLUMNS, Lines, approach, displacement_jacobian, lines_of, points_before
from .operator import Response
from .tooth_pair import PairNodes, Place, Removal, count_of, facing_points_at, node_slices
from .window import ContactGrid, flank_ends, node_offsets

# A node this near to the end of a flank (in spacings) would leave an element too small for a mesh.
SMALLEST_REST = 0.3


def node_pairs(
    pair: GearPair, removal: tuple[Removal | None, Removal | None], grid: ContactGrid, order: int, place: Place
) -> PairNodes | None:
    """The contact nodes of the flanks at a place, or None where their window is empty.

    `grid` spaces the element vertices; elements of second `order` have a contact node midway between each two.
    """
    vertices = _vertex_offsets(pair, place.contact_rolls, grid)
    if not len(vertices):
        return None
    lengths = hat_integrals(vertices)
    offsets = vertices
    if order == 2:
        offsets = _alternating(vertices, 0.5 * (vertices[1:] + vertices[:-1]))
        # The force of an even pressure on a second-order element: 1/6, 4/6, 1/6 (Simpson).
        lengths = _alternating(lengths / 3.0, np.diff(vertices) * 2.0 / 3.0)
    rolls, arms, gap = facing_points_at(pair, removal, place, offsets)
    if order == 2:
        # Elements are straight-sided: their middle nodes are on the chord.
        arms = np.array([_alternating(arm[::2], 0.5 * (arm[2::2] + arm[:-2:2])) for arm in arms])
    return PairNodes(place, offsets, lengths, gap, arms, rolls)


def _vertex_offsets(pair: GearPair, contact_rolls: tuple[float, float], grid: ContactGrid) -> np.ndarray:
    """Offsets (mm) of the contact grid, without an end node that lies very near to an end of either flank."""
    below, above = ends = flank_ends(pair, contact_rolls)
    offsets = node_offsets(ends, grid)
    if len(offsets) < 3:
        return offsets
    near = SMALLEST_REST * grid.spacing
    exact = 1e-9 * grid.spacing
    first = int(any(exact < offsets[0] - end < near for end in below))
    last = len(offsets) - int(any(exact < end - offsets[-1] < near for end in above))
    return offsets[first:last]


def _alternating(even: np.ndarray, odd: np.ndarray) -> np.ndarray:
    joined = np.empty(len(even) + len(odd))
    joined[::2] = even
    joined[1::2] = odd
    return joined


def loaded_teeth(pairs: tuple[PairNodes, ...], gear: int, order: int) -> tuple[LoadedTooth, ...]:
    """The teeth of a gear that have contact nodes, by rising angle: in the pairs' order on the gear that pushes, in
    reverse on the other."""
    teeth = (LoadedTooth(pair.place.contact_rolls[gear], pair.rolls[gear][::order]) for pair in pairs)
    return tuple(sorted(teeth, key=lambda tooth: tooth.angle))


def by_direction(stiffness: np.ndarray, pairs: tuple[PairNodes, ...], side: Side) -> np.ndarray:
    """A gear's stiffness over x, y of its loaded teeth's nodes and the centre, put in the order of `pairs`: normals,
    tangents, centre."""
    count = count_of(pairs)
    # Teeth come by rising angle.
    by_angle = node_slices(pairs[:: side.sense])[:: side.sense]
    nodes = np.concatenate([np.arange(count)[each] for each in by_angle])
    rows = np.concatenate([2 * nodes, 2 * nodes + 1, 2 * count + np.arange(3)])
    return stiffness[np.ix_(rows, rows)]


def roll_interpolation(rolls: np.ndarray, known: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Weights (n, k) of [A.2], [A.3] from values at roll angles `known` (k,) to `rolls` (n,), and which rolls they
    reach (n,)."""
    order = np.argsort(known)
    sorted_rolls = known[order]
    reached = (rolls >= sorted_rolls[0]) & (rolls <= sorted_rolls[-1])
    left = np.clip(np.searchsorted(sorted_rolls, rolls, side="right") - 1, 0, len(known) - 2)
    part = (rolls - sorted_rolls[left]) / (sorted_rolls[left + 1] - sorted_rolls[left])
    weights = np.zeros((len(rolls), len(known)))
    rows = np.flatnonzero(reached)
    weights[rows, order[left[rows]]] = 1.0 - part[rows]
    weights[rows, order[left[rows] + 1]] += part[rows]
    return weights, reached


@dataclass(frozen=True)
class NodeResponse:
    """Contact nodes of one position and how either gear responds: `compliance` (2n, 2n), mm/N, hub held, normals then
    tangents."""

    pairs: tuple[PairNodes, ...]
    compliance: tuple[np.ndarray, np.ndarray]


def node_to_node_response(
    pair: GearPair, now: NodeResponse, before: NodeResponse | None = None, advance: float = 0.0
) -> Response:
    """How the nodes of a position yield; with `before`, the position one step earlier, under friction too. `advance`:
    mesh cycles of the step.

    Lever arms of forces along the line of action are the heights of the nodes above either centre: the paper's
    kinematics of material points. A flank turned by phi also moves by x phi along itself. Where it is slanted, another
    of its points is then at the node, and with that the lever arm would be rb. Without it contact shifts by R (phi2 -
    phi1), R the relative radius. T1/rb1 differs from T2/rb2 by that over rb: 0.04 mm and 0.2 % on the paper's pair.
    """
    rows = count_of(now.pairs) * (1 if before is None else 2)
    compliance = np.ascontiguousarray(sum(now.compliance)[:rows, :rows])
    lines = lines_of(now.pairs, pair.sides)
    elastic = jacobian = None
    if before is not None:
        elastic, jacobian = _last_displacement(lines, before, np.full(len(lines.turn), advance))
    return Response(compliance, elastic, 0, lines.at_nodes.lever_arms, jacobian)


def _last_displacement(lines: Lines, before: NodeResponse, advance: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """E (n, 2 n of the step before) and G (n, 13) with u_t(t_n) = G q - E p at the material points that are contact
    nodes now.

    Between the last step's nodes displacements are linear in the roll angle [A.2]; beyond them the gear moves rigidly
    [A.4].
    """
    last = count_of(before.pairs)
    tangential_last = displacement_jacobian(lines_of(before.pairs, lines.sides), True)[last:]
    outside = approach(lines.sides, points_before(lines, advance), lines.directions[1])
    elastic = np.zeros((len(outside), 2 * last))
    jacobian = np.zeros_like(outside)
    for gear, columns in enumerate(COLUMNS):
        weights, reached = _pairwise(lines.pairs, before.pairs, gear)
        elastic += weights @ before.compliance[gear][last:]
        moved = np.where(reached[:, None], weights @ tangential_last, outside)
        jacobian[:, columns] = moved[:, columns]
    return elastic, jacobian


def _pairwise(pairs, previous, gear: int) -> tuple[np.ndarray, np.ndarray]:
    """Weights (n, nodes before) of [A.2] between the nodes of the same tooth pair, and whether they reach a node
    (n,)."""
    earlier = {pair.place.index: (columns, pair) for columns, pair in zip(node_slices(previous), previous)}
    weights = np.zeros((count_of(pairs), count_of(previous)))
    reached = np.zeros(len(weights), dtype=bool)
    for rows, pair in zip(node_slices(pairs), pairs):
        if pair.place.index in earlier:
            columns, before = earlier[pair.place.index]
            weights[rows, columns], reached[rows] = roll_interpolation(pair.rolls[gear], before.rolls[gear])
    return weights, reached
