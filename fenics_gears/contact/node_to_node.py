"""Contact of flank nodes that meet pair by pair [9]: the reference route's nodes, gaps and displacements.

Both gears are meshed so that every contact node of a position is a node on either flank. Nothing is averaged and, but for the
last step's displacement [A.2]-[A.4], nothing interpolated.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fenics_gears.contact.interpolation import hat_integrals
from fenics_gears.contact.operator import ContactOperator, earlier_rigid_tangent, over_nodes, rigid_rows, rigid_slip
from fenics_gears.contact.tooth_pair import PairNodes, Place, Removal, facing_points
from fenics_gears.contact.window import ContactGrid, flank_ends, node_offsets
from fenics_gears.elasticity.remeshed_gear import LoadedTooth
from fenics_gears.geometry.pair import GearPair

# A node this near to the end of a flank (in spacings) would leave an element too small for a mesh beside it.
SMALLEST_REST = 0.3


@dataclass(frozen=True)
class NodePairs(PairNodes):
    """Contact nodes (n,) of a tooth pair that are nodes of both gears' meshes; `wheel_roll`: their roll angles there (rad)."""

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
    rolls, arms, gap = facing_points(pair, removal, place.contact_rolls, offsets)
    if order == 2:
        # Elements are straight-sided: their middle nodes stand on the chord.
        arms = tuple(_alternating(arm[::2], 0.5 * (arm[2::2] + arm[:-2:2])) for arm in arms)
    return NodePairs(
        place=place,
        offsets=offsets,
        lengths=lengths,
        gap=gap,
        pinion_arm=arms[0],
        wheel_arm=arms[1],
        pinion_roll=rolls[0],
        wheel_roll=rolls[1],
    )


def _vertex_offsets(pair: GearPair, contact_rolls: tuple[float, float], grid: ContactGrid) -> np.ndarray:
    """Offsets (mm) of the contact grid without an end node that all but stands on an end of either flank."""
    offsets = node_offsets(pair, contact_rolls, grid)
    if len(offsets) < 3:
        return offsets
    near, exact = SMALLEST_REST * grid.spacing, 1e-9 * grid.spacing
    below, above = flank_ends(pair, contact_rolls)
    first = int(any(exact < offsets[0] - end < near for end in below))
    last = len(offsets) - int(any(exact < end - offsets[-1] < near for end in above))
    return offsets[first:last]


def _alternating(even: np.ndarray, odd: np.ndarray) -> np.ndarray:
    joined = np.empty(len(even) + len(odd))
    joined[::2], joined[1::2] = even, odd
    return joined


def loaded_teeth(pairs: tuple[NodePairs, ...], gear: int, order: int) -> tuple[LoadedTooth, ...]:
    """The teeth of a gear that have contact nodes, by rising angle: the pairs' order on the pinion, its reverse on the wheel."""
    teeth = (LoadedTooth(pair.place.contact_rolls[gear], pair.rolls(gear)[::order]) for pair in pairs)
    return tuple(sorted(teeth, key=lambda tooth: tooth.angle))


def by_direction(stiffness: np.ndarray, pairs: tuple[NodePairs, ...], gear: int) -> np.ndarray:
    """A gear's stiffness over x, y of its loaded teeth's nodes and the centre, put in the order of `pairs`: normals, tangents, centre."""
    counts = [len(pair.offsets) for pair in pairs]
    order = np.arange(len(pairs)) if gear == 0 else np.arange(len(pairs))[::-1]
    starts, start = {}, 0
    for place in order:
        starts[place], start = start, start + counts[place]
    nodes = np.concatenate([starts[place] + np.arange(count) for place, count in enumerate(counts)])
    rows = np.concatenate([2 * nodes, 2 * nodes + 1, 2 * start + np.arange(3)])
    return stiffness[np.ix_(rows, rows)]


def height_arms(pairs: tuple[NodePairs, ...], base_radii: tuple[float, float]) -> tuple[np.ndarray, np.ndarray]:
    """Arms (n,), mm, of forces along the line of action at the nodes: their heights above either centre.

    The paper's kinematics of material points. A flank turned by phi also moves by x phi along itself, and being slanted off the line
    of action it brings another point there; with that the arm would be rb. Without it contact shifts by R (phi2 - phi1), R the
    relative radius, and T1/rb1 differs from T2/rb2 by that over rb: 0.04 mm and 0.2 % on the paper's pair.
    """
    offsets = over_nodes(pairs, "offsets")
    return base_radii[0] - offsets, base_radii[1] + offsets


def roll_interpolation(rolls: np.ndarray, known: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Weights (n, k) of [A.2], [A.3] from values at roll angles `known` (k,) to `rolls` (n,), and which rolls they reach (n,)."""
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
    """Contact nodes of one position and how either gear responds: `compliance` (2n, 2n), mm/N, hub held, normals then tangents."""

    pairs: tuple[NodePairs, ...]
    compliance: tuple[np.ndarray, np.ndarray]


def node_to_node_operator(
    pair: GearPair,
    now: NodeResponse,
    *,
    coordinates: list[int],
    before: NodeResponse | None = None,
    advance: float = 0.0,
) -> ContactOperator:
    """The contact equations of a position; with `before`, the position one step earlier, those of friction too.

    `coordinates`: which of CENTRE_COORDINATES are unknowns; `advance`: rotation of the pinion (rad) during the step.
    """
    radii, tangential = (pair.pinion.base_radius, pair.wheel.base_radius), before is not None
    arms, nodes = height_arms(now.pairs, radii), sum(len(each.offsets) for each in now.pairs)
    kept = 2 * nodes if tangential else nodes
    rigid = rigid_rows(now.pairs, radii, arms, tangential)[:, coordinates]
    sliding = previous_compliance = previous_rigid = None
    if tangential:
        sliding = rigid_slip(now.pairs, pair.rotation_ratio, advance)
        previous_compliance, previous_rigid = _last_displacement(radii, now.pairs, before, advance)
        previous_rigid = np.ascontiguousarray(previous_rigid[:, coordinates])
    return ContactOperator(
        pairs=now.pairs,
        base_radii=radii,
        normal_arms=arms,
        compliance=np.ascontiguousarray((now.compliance[0] + now.compliance[1])[:kept, :kept]),
        rigid=np.ascontiguousarray(rigid),
        gap=over_nodes(now.pairs, "gap"),
        sliding=sliding,
        previous_compliance=previous_compliance,
        previous_rigid=previous_rigid,
    )


# Columns of CENTRE_COORDINATES that move the pinion and the wheel.
GEAR_COLUMNS = ((0, 1, 2), (3, 4, 5))


def _last_displacement(radii, pairs, before: NodeResponse, advance: float) -> tuple[np.ndarray, np.ndarray]:
    """E (n, 2 n of the step before) and G (n, 7) with u_t(t_n) = G q - E p at the material points that are contact nodes now.

    Between the last step's nodes displacements are linear in the roll angle [A.2]; beyond them the gear moves rigidly [A.4].
    """
    nodes, last = sum(len(pair.offsets) for pair in pairs), len(over_nodes(before.pairs, "offsets"))
    rigid_last = rigid_rows(before.pairs, radii, height_arms(before.pairs, radii), True)[last:]
    outside = earlier_rigid_tangent(pairs, radii, (advance, -advance * radii[0] / radii[1]))
    elastic, rigid = np.zeros((nodes, 2 * last)), np.zeros_like(outside)
    for gear, columns in enumerate(GEAR_COLUMNS):
        weights, reached = _pairwise(pairs, before.pairs, gear)
        elastic += weights @ before.compliance[gear][last:]
        moved = np.where(reached[:, None], weights @ rigid_last, outside)
        rigid[:, columns] = moved[:, columns]
    return elastic, rigid


def _pairwise(pairs, previous, gear: int) -> tuple[np.ndarray, np.ndarray]:
    """Weights of [A.2] between the nodes of the same tooth pair, and the nodes they reach."""
    starts, start = {}, 0
    for pair in previous:
        starts[pair.place.index] = (start, pair)
        start += len(pair.offsets)
    weights, reached, row = np.zeros((sum(len(pair.offsets) for pair in pairs), start)), [], 0
    for pair in pairs:
        rows = slice(row, row + len(pair.offsets))
        row = rows.stop
        if pair.place.index not in starts:
            reached.append(np.zeros(len(pair.offsets), dtype=bool))
            continue
        first, earlier = starts[pair.place.index]
        weights[rows, first : first + len(earlier.offsets)], inside = roll_interpolation(pair.rolls(gear), earlier.rolls(gear))
        reached.append(inside)
    return weights, np.concatenate(reached) if reached else np.empty(0, dtype=bool)
