"""Contact of flank nodes that meet pair by pair [9]: the reference route's nodes, gaps and displacements.

Both gears are meshed so that every contact node of a position is a node on either flank. Nothing is averaged and, but
for the last step's displacement [A.2]-[A.4], nothing interpolated.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fenics_gears.elasticity.remeshed_gear import LoadedTooth
from fenics_gears.geometry.pair import GearPair

from .interpolation import hat_integrals
from .kinematics import displacement_jacobian, earlier_tangential_jacobian, lines_of, turned
from .operator import Response
from .tooth_pair import PairNodes, Place, Removal, count_of, facing_points_at, node_slices, over_nodes
from .window import ContactGrid, flank_ends, node_offsets

# A node this near to the end of a flank (in spacings) would leave an element too small for a mesh beside it.
SMALLEST_REST = 0.3


@dataclass(frozen=True)
class NodePairs(PairNodes):
    """Contact nodes (n,) of a tooth pair that are nodes of both gears' meshes; `wheel_roll`: their roll angles there
    (rad)."""

    wheel_roll: np.ndarray

    def rolls(self, gear: int) -> np.ndarray:
        """Roll angles (n,), rad, on the pinion (0) or the wheel (1)."""
        return self.wheel_roll if gear else self.pinion_roll


def node_pairs(
    pair: GearPair, removal: tuple[Removal | None, Removal | None], grid: ContactGrid, order: int, place: Place
) -> NodePairs | None:
    """The contact nodes of the flanks at a place, or None where their window is empty.

    `grid` spaces the element vertices; elements of second `order` have a contact node midway between each two.
    """
    vertices = _vertex_offsets(pair, place.contact_rolls, grid)
    if not len(vertices):
        return None
    lengths, offsets = hat_integrals(vertices), vertices
    if order == 2:
        middle, cells = 0.5 * (vertices[1:] + vertices[:-1]), np.diff(vertices)
        # The force of an even pressure on a second-order element: 1/6, 4/6, 1/6 (Simpson).
        offsets, lengths = _alternating(vertices, middle), _alternating(lengths / 3.0, cells * 2.0 / 3.0)
    rolls, arms, gap = facing_points_at(pair, removal, place, offsets)
    if order == 2:
        # Elements are straight-sided: their middle nodes stand on the chord.
        arms = tuple(_alternating(arm[::2], 0.5 * (arm[2::2] + arm[:-2:2])) for arm in arms)
    return NodePairs(
        place=place,
        offsets=offsets,
        lengths=lengths,
        gap=gap,
        pinion_lever_arm=arms[0],
        wheel_lever_arm=arms[1],
        pinion_roll=rolls[0],
        wheel_roll=rolls[1],
    )


def _vertex_offsets(pair: GearPair, contact_rolls: tuple[float, float], grid: ContactGrid) -> np.ndarray:
    """Offsets (mm) of the contact grid, without an end node that lies very near to an end of either flank."""
    below, above = ends = flank_ends(pair, contact_rolls)
    offsets = node_offsets(ends, grid)
    if len(offsets) < 3:
        return offsets
    near, exact = SMALLEST_REST * grid.spacing, 1e-9 * grid.spacing
    first = int(any(exact < offsets[0] - end < near for end in below))
    last = len(offsets) - int(any(exact < end - offsets[-1] < near for end in above))
    return offsets[first:last]


def _alternating(even: np.ndarray, odd: np.ndarray) -> np.ndarray:
    joined = np.empty(len(even) + len(odd))
    joined[::2], joined[1::2] = even, odd
    return joined


def loaded_teeth(pairs: tuple[NodePairs, ...], gear: int, order: int) -> tuple[LoadedTooth, ...]:
    """The teeth of a gear that have contact nodes, by rising angle: the pairs' order on the pinion, its reverse on the
    wheel."""
    teeth = (LoadedTooth(pair.place.contact_rolls[gear], pair.rolls(gear)[::order]) for pair in pairs)
    return tuple(sorted(teeth, key=lambda tooth: tooth.angle))


def by_direction(stiffness: np.ndarray, pairs: tuple[NodePairs, ...], gear: int) -> np.ndarray:
    """A gear's stiffness over x, y of its loaded teeth's nodes and the centre, put in the order of `pairs`: normals,
    tangents, centre."""
    count = count_of(pairs)
    nodes = np.arange(count)
    if gear == 1:
        # Teeth come by rising angle, on the wheel in the opposite order of the pairs.
        slices = node_slices(pairs[::-1])[::-1]
        nodes = np.concatenate([nodes[each] for each in slices])
    rows = np.concatenate([2 * nodes, 2 * nodes + 1, 2 * count + np.arange(3)])
    return stiffness[np.ix_(rows, rows)]


def height_lever_arms(pairs: tuple[NodePairs, ...], base_radii: tuple[float, float]) -> tuple[np.ndarray, np.ndarray]:
    """Lever arms (n,), mm, of forces along the line of action: the heights of the nodes above either centre.

    The paper's kinematics of material points. A flank turned by phi also moves by x phi along itself; where it is
    slanted, another of its points then stands at the node, and with that the lever arm would be rb. Without it contact
    shifts by R (phi2 - phi1), R the relative radius, and T1/rb1 differs from T2/rb2 by that over rb: 0.04 mm and 0.2 %
    on the paper's pair.
    """
    offsets = over_nodes(pairs, "offsets")
    return base_radii[0] - offsets, base_radii[1] + offsets


def roll_interpolation(rolls: np.ndarray, known: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Weights (n, k) of [A.2], [A.3] from values at roll angles `known` (k,) to `rolls` (n,), and which rolls they
    reach (n,)."""
    order = np.argsort(known)
    sorted_rolls = known[order]
    reached = (rolls >= sorted_rolls[0]) & (rolls <= sorted_rolls[-1])
    left = np.clip(np.searchsorted(sorted_rolls, rolls, side="right") - 1, 0, len(known) - 2)
    part = (rolls - sorted_rolls[left]) / (sorted_rolls[left + 1] - sorted_rolls[left])
    weights, rows = np.zeros((len(rolls), len(known))), np.flatnonzero(reached)
    weights[rows, order[left[rows]]] = 1.0 - part[rows]
    weights[rows, order[left[rows] + 1]] += part[rows]
    return weights, reached


@dataclass(frozen=True)
class NodeResponse:
    """Contact nodes of one position and how either gear responds: `compliance` (2n, 2n), mm/N, hub held, normals then
    tangents."""

    pairs: tuple[NodePairs, ...]
    compliance: tuple[np.ndarray, np.ndarray]


def node_to_node_response(
    pair: GearPair, now: NodeResponse, before: NodeResponse | None = None, advance: float = 0.0
) -> Response:
    """How the nodes of a position yield; with `before`, the position one step earlier, under friction too. `advance`:
    rotation of the pinion (rad) during the step."""
    radii, rows = (pair.pinion.base_radius, pair.wheel.base_radius), count_of(now.pairs) * (1 if before is None else 2)
    compliance = np.ascontiguousarray((now.compliance[0] + now.compliance[1])[:rows, :rows])
    elastic = jacobian = None
    if before is not None:
        elastic, jacobian = _last_displacement(radii, now.pairs, before, turned(pair, advance))
    return Response(compliance, elastic, 0, height_lever_arms(now.pairs, radii), jacobian)


# Columns of CENTRE_COORDINATES that move the pinion and the wheel.
GEAR_COLUMNS = ((0, 1, 2), (3, 4, 5))


def _last_displacement(
    radii, pairs, before: NodeResponse, angles: tuple[float, float]
) -> tuple[np.ndarray, np.ndarray]:
    """E (n, 2 n of the step before) and G (n, 7) with u_t(t_n) = G q - E p at the material points that are contact
    nodes now.

    `angles`: by which the roll angles of pinion and wheel have risen, rad. Between the last step's nodes displacements
    are linear in the roll angle [A.2]; beyond them the gear moves rigidly [A.4].
    """
    last = count_of(before.pairs)
    tangential_last = displacement_jacobian(before.pairs, radii, height_lever_arms(before.pairs, radii), True)[last:]
    outside = earlier_tangential_jacobian(lines_of(pairs, radii), radii, angles)
    elastic, jacobian = np.zeros((len(outside), 2 * last)), np.zeros_like(outside)
    for gear, columns in enumerate(GEAR_COLUMNS):
        weights, reached = _pairwise(pairs, before.pairs, gear)
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
            weights[rows, columns], reached[rows] = roll_interpolation(pair.rolls(gear), before.rolls(gear))
    return weights, reached
