"""How motions of the gears move contact nodes relative to each other, and which node each one was a step before."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numba import njit

from fenics_gears.geometry.side import Side

from .face import Face, one_slice
from .tooth_pair import PairNodes, node_ends, over_nodes, per_node

# The centre coordinates q of the model: seven in the plane. Rotations are carried as arc lengths rb1 phi1, rb2 phi2
# (mm), so that every coordinate is a length and every row a force, and no equation is scaled against another. The
# output shaft's end goes by its twist rb2 (phi3 - phi2): as the difference of two rotations the twist of a stiff shaft
# would be lost in round-off.
CENTRE_COORDINATES = ("centre_x1", "centre_y1", "rotation_1", "centre_x2", "centre_y2", "rotation_2", "twist_2")


# Six more of gears that also move along their axes and tilt; tilts are carried as arc lengths, rb theta.
FACE_COORDINATES = ("axial_1", "tilt_x1", "tilt_y1", "axial_2", "tilt_x2", "tilt_y2")


COORDINATES = CENTRE_COORDINATES + FACE_COORDINATES


# The six motions of a gear about its centre, along x, y and z and about them, and their places (2, 6) in COORDINATES.
MOTIONS = ("centre_x{}", "centre_y{}", "axial_{}", "tilt_x{}", "tilt_y{}", "rotation_{}")
COLUMNS = np.array([[COORDINATES.index(motion.format(gear)) for motion in MOTIONS] for gear in (1, 2)])


IN_THE_PLANE = one_slice(1.0)


def rigid_motions(points: np.ndarray, directions: np.ndarray) -> np.ndarray:
    """Displacement (..., 6) of points (..., 3) of a rigid body along `directions` (..., 3), per unit of its motions
    along x, y and z and about them.

    A rotation theta moves the point at r by theta x r: along d by theta . (r x d).
    """
    turned = np.cross(points, directions)
    return np.concatenate([np.broadcast_to(directions, turned.shape), turned], axis=-1)


@dataclass(frozen=True)
class Lines:
    """Lines of action of contact nodes (n,) between two `sides`, over a `face`.

    `normal` (n, 2) and `tangent` (n, 2): directions in space along the line, from pinion to wheel, and across it.
    `turn` (n,): sign of rotations there; `height` (n,), mm: along the axes. `lever_arms` (2, n), mm: of normal forces
    about both centres. These are the base radii, and at a tip's edge those of the mate's normal. An involute turned by
    phi moves by rb phi along its own normal wherever it is touched, so that T1/rb1 = T2/rb2 holds exactly without
    friction.
    """

    pairs: Sequence[PairNodes]
    sides: tuple[Side, Side]
    face: Face
    normal: np.ndarray
    tangent: np.ndarray
    turn: np.ndarray
    height: np.ndarray
    lever_arms: np.ndarray

    @cached_property
    def friction_arms(self) -> np.ndarray:
        """Lever arms (2, n), mm, of friction about both centres."""
        return over_nodes(self.pairs, "friction_arms").reshape(2, -1)

    @cached_property
    def senses(self) -> np.ndarray:
        """The sense of each side, (2, 1)."""
        return np.array([[side.sense] for side in self.sides])

    @property
    def at_nodes(self) -> Lines:
        """The same with the heights of the contact nodes above the centres as lever arms."""
        return replace(self, lever_arms=self.lever_arms - self.senses * over_nodes(self.pairs, "offsets"))

    @property
    def points(self) -> np.ndarray:
        """Points of contact (2, n, 3), mm, from either gear's centre at its mid-width: along the line by the lever arm
        of friction, and across it by that of normal forces."""
        arms = (self.senses * each for each in (self.friction_arms, self.lever_arms))
        along, across = (arm[..., None] for arm in arms)
        middles = np.array(self.face.middles)[:, None, None]
        return np.concatenate([along * self.normal - across * self.tangent, self.height[:, None] - middles], axis=-1)

    @property
    def directions(self) -> np.ndarray:
        """Directions (2, n, 3) of the contact normal and of the tangent.

        Over a face the normal leans along the axis: it is perpendicular to the line of contact.
        """
        cosine = self.face.cosine
        leaning = -self.face.slope * self.turn[:, None]
        normal = cosine * np.concatenate([self.normal, leaning], axis=1)
        return np.stack([normal, np.concatenate([self.tangent, np.zeros_like(leaning)], axis=1)])


def lines_of(pairs: Sequence[PairNodes], sides: tuple[Side, Side], face: Face = IN_THE_PLANE) -> Lines:
    """The lines of action of the pairs' nodes."""
    radii = [side.gear.base_radius for side in sides]
    places = [pair.place for pair in pairs]
    of_pairs = [
        (*each.axes[0], *each.axes[1], each.turn, each.height, *(each.line.lever_arms if each.line else radii))
        for each in places
    ]
    values = per_node(pairs, np.array(of_pairs).reshape(len(pairs), 8))
    arms = np.ascontiguousarray(values[:, 6:].T)
    return Lines(pairs, sides, face, values[:, :2], values[:, 2:4], values[:, 4], values[:, 5], arms)


def approach(sides: tuple[Side, Side], points: np.ndarray, directions: np.ndarray) -> np.ndarray:
    """Relative displacement (n, 13), mm per mm, along `directions` (n, 3) of flanks that touch at `points` (2, n, 3),
    mm, from their gears' centres, per one of COORDINATES."""
    rows = np.zeros((len(directions), len(COORDINATES)))
    for side, columns, own in zip(sides, COLUMNS, points):
        units = np.repeat([1.0, side.gear.base_radius], 3)
        rows[:, columns] = side.sense * rigid_motions(own, directions) / units
    return rows


def displacement_jacobian(lines: Lines, tangential: bool) -> np.ndarray:
    """Relative displacement of the contact nodes per one of COORDINATES: G (m, 13), mm per mm, of normals first, then
    of tangents."""
    points = lines.points
    return np.concatenate([approach(lines.sides, points, each) for each in lines.directions[: 1 + tangential]])


def points_before(lines: Lines, advance: np.ndarray) -> np.ndarray:
    """Points (2, n, 3), mm, from either gear's centre, at which the points that touch now were before the gears turned
    by `advance` (n,), mesh cycles."""
    x, y, z = np.moveaxis(lines.at_nodes.points, -1, 0)
    turned = np.outer([side.turn for side in lines.sides], advance)
    cosine = np.cos(turned)
    sine = np.sin(turned)
    return np.stack([cosine * x + sine * y, cosine * y - sine * x, z], axis=-1)


def slip_of_rigid_flanks(lines: Lines, before: np.ndarray) -> np.ndarray:
    """Slip (n,), mm, of the points that touch now since they stood at `before`: the exact integral of the sliding speed
    [12].

    The sliding speed times the step would be of first order only: the speed grows in proportion to the distance from
    the pitch point.
    """
    moved = lines.at_nodes.points - before
    return lines.senses[:, 0] @ np.einsum("sni,ni->sn", moved[..., :2], lines.tangent)


# The tooth pairs at a position, and those a step before.
Step = tuple[Sequence[PairNodes], Sequence[PairNodes]]


def nodes_before(steps: Sequence[Step], spacing: float) -> list[np.ndarray]:
    """Of each of some steps, for each node the one of the same pair that it was a step before; -1 where there is none.

    Near an edge, with which nodes move, it is the one with as many nodes between it and the edge. Elsewhere it is the
    one at the same offset.
    """
    same: list[int] = []
    every: tuple[list[PairNodes], ...] = ([], [])
    begins = []
    for step in steps:
        pairs, previous = step
        begins.append([len(each) for each in every])
        known = {_key(pair): place for place, pair in enumerate(previous, len(every[1]))}
        same += [known.get(_key(pair), -1) for pair in pairs]
        for all_pairs, own in zip(every, step):
            all_pairs += own
    ends = [node_ends(each) for each in every]
    (offsets, now), before = ((over_nodes(each, "offsets"), at) for each, at in zip(every, ends))
    same_nodes = _nodes_before(offsets, now, *before, np.array(same, dtype=np.int64), spacing)
    # Counted from the first node of the step before.
    first, first_before = (at[list(begin)] for at, begin in zip(ends, zip(*begins)))
    same_nodes -= np.where(same_nodes >= 0, np.repeat(first_before, np.diff([*first, len(same_nodes)])), 0)
    return np.split(same_nodes, first[1:])


@njit(cache=True)
def _nodes_before(offsets, ends, offsets_before, ends_before, same, spacing):
    """From offsets (n,), mm, and ends (P + 1,) of each pair's nodes, now and before; `same` (P,): the pair before, -1
    for none."""
    same_nodes = np.full(len(offsets), -1)
    for pair in range(len(same)):
        if same[pair] >= 0:
            first = ends_before[same[pair]]
            last = ends_before[same[pair] + 1]
            own = slice(ends[pair], ends[pair + 1])
            _same_nodes(same_nodes[own], offsets[own], offsets_before[first:last], spacing)
            for node in range(ends[pair], ends[pair + 1]):
                same_nodes[node] += first if same_nodes[node] >= 0 else 0
    return same_nodes


@njit(cache=True)
def _same_nodes(places, now, before, spacing):
    """For each node now, at offsets (n,), mm, the place of the same one among those before, -1 for none."""
    low, high = _closer(now, spacing)
    low_before, high_before = _closer(before, spacing)
    low = low and low_before
    high = high and high_before
    for node in range(len(now)):
        place = node
        if high and not low:
            place = node + len(before) - len(now)
        elif not low or high:
            place = np.abs(before - now[node]).argmin()
            if abs(now[node] - before[place]) > 0.75 * spacing:
                place = -1
        places[node] = place if place < len(before) else -1
        places[node] = max(places[node], -1)


@njit(cache=True)
def _closer(offsets, spacing):
    """Whether the nodes are closer at the first and at the last end, since an edge is there."""
    if len(offsets) < 3:
        return False, False
    return offsets[1] - offsets[0] < 0.5 * spacing, offsets[-1] - offsets[-2] < 0.5 * spacing


def _key(pair: PairNodes) -> tuple[int, int, int]:
    return pair.place.flank, pair.place.index, pair.place.slice
