"""How the centre coordinates and the turning of rigid gears move contact nodes relative to each other, and which node
each one was a step before."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numba import njit

from fenics_gears.geometry.pair import GearPair

from .face import Face, one_slice
from .tooth_pair import PairNodes, node_ends, over_nodes, per_node

# The centre coordinates q of the model: seven in the plane. Rotations are carried as arc lengths rb1 phi1, rb2 phi2
# (mm), so that every coordinate is a length and every row a force, and no equation is scaled against another. The
# output shaft's end goes by its twist rb2 (phi3 - phi2): as the difference of two rotations the twist of a stiff shaft
# would be lost in round-off.
CENTRE_COORDINATES = ("centre_x1", "centre_y1", "rotation_1", "centre_x2", "centre_y2", "rotation_2", "shaft_twist")


# Six more of gears that also move along their axes and tilt; tilts are carried as arc lengths, rb theta.
FACE_COORDINATES = ("axial_1", "tilt_x1", "tilt_y1", "axial_2", "tilt_x2", "tilt_y2")


COORDINATES = CENTRE_COORDINATES + FACE_COORDINATES


IN_THE_PLANE = one_slice(1.0)


@dataclass(frozen=True)
class Lines:
    """Line of action of each contact node: its direction `normal` (n, 2) in space, from pinion to wheel, `tangent` (n,
    2) across it, sign (n,) of rotations there, and `lever_arms` (n,), mm, of normal forces about the centres of pinion
    and wheel.

    Lever arms are the base radii, and at a tip's edge those of the mate's normal. An involute turned by phi moves by rb
    phi along its own normal wherever it is touched, so that T1/rb1 = T2/rb2 holds exactly without friction.
    """

    pairs: Sequence[PairNodes]
    normal: np.ndarray
    tangent: np.ndarray
    turn: np.ndarray
    lever_arms: tuple[np.ndarray, np.ndarray]

    @cached_property
    def friction_arms(self) -> tuple[np.ndarray, np.ndarray]:
        """Lever arms (n,), mm, of friction about the centres of pinion and wheel."""
        return over_nodes(self.pairs, "pinion_lever_arm"), over_nodes(self.pairs, "wheel_lever_arm")


def lines_of(pairs: Sequence[PairNodes], base_radii: tuple[float, float]) -> Lines:
    """The lines of action of the pairs' nodes."""
    places = [pair.place for pair in pairs]
    of_pairs = [
        (*place.axes[0], *place.axes[1], place.turn, *(base_radii if place.line is None else place.line.lever_arms))
        for place in places
    ]
    values = per_node(pairs, np.array(of_pairs).reshape(len(pairs), 7))
    return Lines(pairs, values[:, :2], values[:, 2:4], values[:, 4], (values[:, 5].copy(), values[:, 6].copy()))


def normals(pairs: Sequence[PairNodes]) -> np.ndarray:
    """Direction (n, 2) in space of each node's line of action, from pinion to wheel."""
    return lines_of(pairs, (0.0, 0.0)).normal


def displacement_jacobian(
    pairs: tuple[PairNodes, ...],
    base_radii: tuple[float, float],
    normal_lever_arms: tuple[np.ndarray, np.ndarray],
    tangential: bool,
    lines: Lines | None = None,
    face: Face = IN_THE_PLANE,
) -> np.ndarray:
    """Relative displacement of the contact nodes per centre coordinate: G (m, 7), over CENTRE_COORDINATES, mm per mm;
    over a `face` of many slices (m, 13).

    `lines`: of the nodes, where they are known.
    """
    nodes, lines = len(normal_lever_arms[0]), lines or lines_of(pairs, base_radii)
    normal, tangent, turn = lines.normal, lines.tangent, lines.turn
    rows = np.zeros((2 * nodes if tangential else nodes, len(CENTRE_COORDINATES)))
    rows[:nodes, 0:2], rows[:nodes, 2] = normal, turn * normal_lever_arms[0] / base_radii[0]
    rows[:nodes, 3:5], rows[:nodes, 5] = -normal, turn * normal_lever_arms[1] / base_radii[1]
    if tangential:
        rows[nodes:, 0:2], rows[nodes:, 2] = tangent, turn * lines.friction_arms[0] / base_radii[0]
        rows[nodes:, 3:5], rows[nodes:, 5] = -tangent, turn * lines.friction_arms[1] / base_radii[1]
    if face.slices == 1:
        return rows
    from .face_jacobian import on_face

    return on_face(rows, lines, face, base_radii)


# By how much (rad) the roll angles of pinion and wheel rise, of all nodes or of each (n,).
Turned = tuple[float, float] | tuple[np.ndarray, np.ndarray]


def turned(gears: GearPair, advance: float) -> tuple[float, float]:
    """By how much (rad) the roll angles of pinion and wheel rise while the pinion turns by `advance`; the wheel's
    fall."""
    return advance, -advance * gears.pinion.base_radius / gears.wheel.base_radius


def slip_of_rigid_flanks(lines: Lines, turned: Turned) -> np.ndarray:
    """Slip (n,), mm, of the points touching now while rigid gears turned to here: the exact integral of the sliding
    speed [12].

    The sliding speed times the step would be of first order only: the speed grows in proportion to the distance from
    the pitch point.
    """
    lever_arms, offsets = lines.friction_arms, over_nodes(lines.pairs, "offsets")
    straight = lines.turn * (lever_arms[0] * np.sin(turned[0]) + lever_arms[1] * np.sin(turned[1]))
    return (
        straight
        - (lines.lever_arms[0] - offsets) * (1.0 - np.cos(turned[0]))
        - (lines.lever_arms[1] + offsets) * (1.0 - np.cos(turned[1]))
    )


def earlier_tangential_jacobian(
    lines: Lines, radii: tuple[float, float], turned: Turned, face: Face = IN_THE_PLANE
) -> np.ndarray:
    """Tangential rigid displacement (n, 7), over a `face` of many slices (n, 13), of the points touching now,
    per centre coordinate one step before."""
    offsets, (arm_1, arm_2) = over_nodes(lines.pairs, "offsets"), lines.friction_arms
    height_1, height_2 = lines.lever_arms[0] - offsets, lines.lever_arms[1] + offsets
    tangent, turn = lines.tangent, lines.turn
    rows = np.zeros((len(offsets), len(CENTRE_COORDINATES)))
    # A point (x, -h) of the pinion stood at (x cos a - h sin a, ...) before the pinion turned by a; likewise the wheel.
    (sine_1, sine_2), (cosine_1, cosine_2) = (tuple(map(function, turned)) for function in (np.sin, np.cos))
    rows[:, 0:2], rows[:, 2] = tangent, turn * (arm_1 * cosine_1 - turn * height_1 * sine_1) / radii[0]
    rows[:, 3:5], rows[:, 5] = -tangent, turn * (arm_2 * cosine_2 - turn * height_2 * sine_2) / radii[1]
    if face.slices == 1:
        return rows
    from .face_jacobian import earlier_tangents_on_face

    return earlier_tangents_on_face(rows, lines, face, radii)


# The tooth pairs at a position, and those a step before.
Step = tuple[Sequence[PairNodes], Sequence[PairNodes]]


def nodes_before(steps: Sequence[Step], spacing: float) -> list[np.ndarray]:
    """Of each of some steps, for each node the one of the same pair that it was a step before; -1 where there is none.

    Beside an edge, with which nodes move, it is the one with as many nodes between it and the edge; else the one at the
    same offset.
    """
    same: list[int] = []
    every: tuple[list[PairNodes], list[PairNodes]] = [], []
    begins = []
    for step in steps:
        pairs, previous = step
        begins.append([len(each) for each in every])
        known = {_key(pair): place for place, pair in enumerate(previous, len(every[1]))}
        same += [known.get(_key(pair), -1) for pair in pairs]
        for all_pairs, own in zip(every, step):
            all_pairs += own
    ends = [node_ends(each) for each in every]
    (offsets, now), (offsets_before, before) = ((over_nodes(each, "offsets"), at) for each, at in zip(every, ends))
    found = _nodes_before(offsets, now, offsets_before, before, np.array(same, dtype=np.int64), spacing)
    # Counted from the first node of the step before.
    first, first_before = (at[list(begin)] for at, begin in zip(ends, zip(*begins)))
    found -= np.where(found >= 0, np.repeat(first_before, np.diff([*first, len(found)])), 0)
    return np.split(found, first[1:])


@njit(cache=True)
def _nodes_before(offsets, ends, offsets_before, ends_before, same, spacing):
    """From offsets (n,), mm, and ends (P + 1,) of each pair's nodes, now and before; `same` (P,): the pair before, -1
    for none."""
    found = np.full(len(offsets), -1)
    for pair in range(len(same)):
        if same[pair] >= 0:
            first, last = ends_before[same[pair]], ends_before[same[pair] + 1]
            own = slice(ends[pair], ends[pair + 1])
            _same_nodes(found[own], offsets[own], offsets_before[first:last], spacing)
            for node in range(ends[pair], ends[pair + 1]):
                found[node] += first if found[node] >= 0 else 0
    return found


@njit(cache=True)
def _same_nodes(found, now, before, spacing):
    """For each node now, at offsets (n,), mm, the place of the same one among those before, -1 for none."""
    (low, high), (low_before, high_before) = _closer(now, spacing), _closer(before, spacing)
    low, high = low and low_before, high and high_before
    for node in range(len(now)):
        place = node
        if high and not low:
            place = node + len(before) - len(now)
        elif not low or high:
            place = np.abs(before - now[node]).argmin()
            if abs(now[node] - before[place]) > 0.75 * spacing:
                place = -1
        found[node] = place if place < len(before) else -1
        found[node] = max(found[node], -1)


@njit(cache=True)
def _closer(offsets, spacing):
    """Whether the nodes stand closer at the first and at the last end, since an edge is there."""
    if len(offsets) < 3:
        return False, False
    return offsets[1] - offsets[0] < 0.5 * spacing, offsets[-1] - offsets[-2] < 0.5 * spacing


def _key(pair: PairNodes) -> tuple[int, int, int]:
    return pair.place.flank, pair.place.index, pair.place.slice
