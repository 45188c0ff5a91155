"""The contact equations at one position of the gears: the nodes that may touch, and their response.

Unknowns of the mixed form (model.md section 4) are nodal forces `p` and centre coordinates `q`; the relative
displacement of the contact nodes is `u = G q - C p`. Rows come normals first, then tangents where friction asks for
them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import accumulate
from math import cos, sin
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fenics_gears.geometry.pair import GearPair

from .face import Face, one_slice
from .tooth_pair import DRIVE, PairNodes

if TYPE_CHECKING:
    from .formed_rows import FormedRows

# The centre coordinates q of the model: seven in the plane. Rotations are carried as arc lengths rb1 phi1, rb2 phi2
# (mm), so that every coordinate is a length and every row a force, and no equation is scaled against another. The
# output shaft's end goes by its twist rb2 (phi3 - phi2): as the difference of two rotations the twist of a stiff shaft
# would be lost in round-off.
CENTRE_COORDINATES = ("centre_x1", "centre_y1", "rotation_1", "centre_x2", "centre_y2", "rotation_2", "shaft_twist")
# Six more of gears that also move along their axes and tilt; tilts are carried as arc lengths, rb theta.
FACE_COORDINATES = ("axial_1", "tilt_x1", "tilt_y1", "axial_2", "tilt_x2", "tilt_y2")
COORDINATES = CENTRE_COORDINATES + FACE_COORDINATES
NO_NODES_BEFORE = np.empty(0, dtype=np.int64)
IN_THE_PLANE = one_slice(1.0)


class _FormedWhenRead:
    """A compliance of an operator, all of whose rows are formed when it is read (`contact.formed_rows`)."""

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name

    def __set__(self, operator: ContactOperator, compliance: np.ndarray | FormedRows | None) -> None:
        operator.__dict__[self._name] = compliance

    def __get__(self, operator: ContactOperator | None, owner: type | None = None):
        if operator is None:
            # The field has no default.
            raise AttributeError(self._name)
        held = operator.__dict__[self._name]
        return held if held is None or isinstance(held, np.ndarray) else held.whole()


class _OfAllCoordinates:
    """A jacobian of an operator, as it is read: with columns of zeros of the coordinates that move no contact."""

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name

    def __set__(self, operator: ContactOperator, jacobian: np.ndarray | None) -> None:
        operator.__dict__[self._name] = jacobian

    def __get__(self, operator: ContactOperator | None, owner: type | None = None):
        if operator is None:
            # The field has no default.
            raise AttributeError(self._name)
        held, more = operator.__dict__[self._name], operator.coordinates
        if held is None or held.shape[1] >= more:
            return held
        return np.pad(held, ((0, 0), (0, more - held.shape[1])))


class Stored(NamedTuple):
    """A compliance as it lies in memory, by rows (m, m'), mm/N, those of nodes that were closed at least; and the
    `address` of what forms the others, 0 where all are there."""

    rows: np.ndarray
    address: int = 0


@dataclass(frozen=True)
class ContactOperator:
    """Contact at one position: n nodes, m = n without friction, 2 n with it; k centre coordinates.

    `base_radii` (mm) of pinion and wheel; `pairs`: the tooth pairs whose nodes these are, in order; `normal_lever_arms`
    (n,), mm: of a normal force about the pinion's and the wheel's centre.

    `compliance` C (m, m), mm/N; `jacobian` G (m, k); `gap` (n,), mm; `rigid_slip` (n,), mm: slip of rigid flanks during
    the step that ends here; `previous_compliance` E (n, m of the step before) and `previous_jacobian` (n, k): the
    tangential displacement that the material points touching now had at the end of the step before is
    `previous_jacobian q - E p`. The last three are None without friction.

    `dependent_rows`: rows of the compliance that are combinations of others, see `contact.pairing`. `face`: whose
    slices the pairs are in. `sliding` (n,): sign of the nominal motion's, where friction follows it, else None.
    `coordinates`: k, where jacobians are stored without the last columns, of coordinates that move no contact.
    """

    pairs: tuple[PairNodes, ...]
    base_radii: tuple[float, float]
    normal_lever_arms: tuple[np.ndarray, np.ndarray]
    compliance: np.ndarray = _FormedWhenRead()  # type: ignore[assignment]
    jacobian: np.ndarray = _OfAllCoordinates()  # type: ignore[assignment]
    gap: np.ndarray
    rigid_slip: np.ndarray | None
    previous_compliance: np.ndarray | None = _FormedWhenRead()  # type: ignore[assignment]
    previous_jacobian: np.ndarray | None = _OfAllCoordinates()  # type: ignore[assignment]
    dependent_rows: int = 0
    face: Face = IN_THE_PLANE
    sliding: np.ndarray | None = None
    coordinates: int = 0

    @property
    def nodes(self) -> int:
        """Number of contact nodes."""
        return len(self.gap)

    @property
    def stored(self) -> Stored:
        """The compliance as far as its rows are formed."""
        held = self.__dict__["compliance"]
        return Stored(held) if isinstance(held, np.ndarray) else Stored(held.matrix, held.address)

    @property
    def stored_before(self) -> Stored | None:
        """The previous compliance by columns, (m before, n), as far as they are formed; None without friction."""
        held = self.__dict__["previous_compliance"]
        if held is None:
            return None
        return (
            Stored(np.ascontiguousarray(held.T)) if isinstance(held, np.ndarray) else Stored(held.matrix, held.address)
        )

    @property
    def stored_jacobians(self) -> tuple[np.ndarray, np.ndarray | None]:
        """G (m, c) and the previous jacobian (n, c) over the coordinates that contact moves, as they lie in memory."""
        return self.__dict__["jacobian"], self.__dict__["previous_jacobian"]

    @cached_property
    def node_pair(self) -> np.ndarray:
        """Position in `pairs` of the pair that each node (n,) belongs to."""
        return per_node(self.pairs, np.arange(len(self.pairs)))

    @cached_property
    def on_drive_flanks(self) -> np.ndarray:
        """Whether a node (n,) is on the drive flanks, not the coast flanks."""
        return np.array([pair.place.flank == DRIVE for pair in self.pairs], dtype=bool)[self.node_pair]


def node_slices(pairs: Sequence[PairNodes]) -> list[slice]:
    """Where each pair's contact nodes stand among those of all pairs, one pair after the other."""
    ends = list(accumulate((len(pair.offsets) for pair in pairs), initial=0))
    return [slice(start, end) for start, end in zip(ends[:-1], ends[1:])]


def node_ends(pairs: Sequence[PairNodes]) -> np.ndarray:
    """Where each pair's contact nodes begin among those of all pairs, and where the last one's end (P + 1,)."""
    return np.array(list(accumulate((len(pair.offsets) for pair in pairs), initial=0)))


def count_of(pairs: Sequence[PairNodes]) -> int:
    """Number of the pairs' contact nodes."""
    return sum(len(pair.offsets) for pair in pairs)


def over_nodes(pairs: Sequence[PairNodes], name: str) -> np.ndarray:
    """An array of every pair's contact nodes, one pair after the other."""
    return np.concatenate([getattr(pair, name) for pair in pairs]) if pairs else np.empty(0)


def per_node(pairs: Sequence[PairNodes], values: np.ndarray) -> np.ndarray:
    """A value of each pair (pairs, ...) repeated for its contact nodes (n, ...)."""
    return np.repeat(values, [len(pair.offsets) for pair in pairs], axis=0)


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


class Passage(NamedTuple):
    """Contact nodes on their way from one position to the next: the `pairs` now and the `previous` ones, None without
    friction; the node before of each node now (`node_before`, as of a Position); the place of both in the mesh cycle,
    in steps; and by how much (rad) the pinion turns (`advance`)."""

    pairs: tuple[PairNodes, ...]
    previous: tuple[PairNodes, ...] | None = None
    node_before: np.ndarray = NO_NODES_BEFORE
    index: float = 0
    index_before: float = -1
    advance: float = 0.0


class Response(NamedTuple):
    """How contact nodes yield: `compliance`, `previous_compliance` (None without friction), `dependent_rows` and
    `sliding` of a ContactOperator; `normal_lever_arms` and `previous_jacobian`, over all coordinates, where they are
    not those of flanks that slide along the line of action."""

    compliance: np.ndarray | FormedRows
    previous_compliance: np.ndarray | FormedRows | None = None
    dependent_rows: int = 0
    normal_lever_arms: tuple[np.ndarray, np.ndarray] | None = None
    previous_jacobian: np.ndarray | None = None
    sliding: np.ndarray | None = None


def contact_operator(
    gears: GearPair, passage: Passage, coordinates: list[int], response: Response, face: Face = IN_THE_PLANE
) -> ContactOperator:
    """The contact equations of nodes whose normal forces act along their pair's line; those of friction too where the
    passage has previous nodes.

    `coordinates`: which of COORDINATES are unknowns; those beyond, at the end, are of shafts, and move no contact.
    """
    pairs, frictional = passage.pairs, passage.previous is not None
    radii = gears.pinion.base_radius, gears.wheel.base_radius
    lines, angles = lines_of(pairs, radii), turned(gears, passage.advance)
    arms, slip, before, earlier = response.normal_lever_arms or lines.lever_arms, None, None, response.previous_jacobian
    if frictional:
        slip, before = slip_of_rigid_flanks(lines, angles), response.previous_compliance
        if isinstance(before, np.ndarray):
            before = np.asfortranarray(before)
        if earlier is None:
            earlier = earlier_tangential_jacobian(lines, radii, angles, face)
        earlier = _of_unknowns(earlier, coordinates)
    return ContactOperator(
        pairs=pairs,
        base_radii=radii,
        normal_lever_arms=arms,
        compliance=response.compliance,  # type: ignore[arg-type]
        jacobian=_of_unknowns(displacement_jacobian(pairs, radii, arms, frictional, lines, face), coordinates),
        gap=over_nodes(pairs, "gap") * face.cosine,
        rigid_slip=slip,
        previous_compliance=before,  # type: ignore[arg-type]
        previous_jacobian=earlier,
        dependent_rows=response.dependent_rows,
        face=face,
        sliding=response.sliding,
        coordinates=len(coordinates),
    )


def turned(gears: GearPair, advance: float) -> tuple[float, float]:
    """By how much (rad) the roll angles of pinion and wheel rise while the pinion turns by `advance`; the wheel's
    fall."""
    return advance, -advance * gears.pinion.base_radius / gears.wheel.base_radius


def _of_unknowns(rows: np.ndarray, coordinates: list[int]) -> np.ndarray:
    """The columns of those coordinates that contact moves."""
    return rows.take([each for each in coordinates if each < len(COORDINATES)], axis=1)


def slip_of_rigid_flanks(lines: Lines, turned: tuple[float, float]) -> np.ndarray:
    """Slip (n,), mm, of the points touching now while rigid gears turned to here: the exact integral of the sliding
    speed [12].

    The sliding speed times the step would be of first order only: the speed grows in proportion to the distance from
    the pitch point.
    """
    lever_arms, offsets = lines.friction_arms, over_nodes(lines.pairs, "offsets")
    straight = lines.turn * (lever_arms[0] * sin(turned[0]) + lever_arms[1] * sin(turned[1]))
    return (
        straight
        - (lines.lever_arms[0] - offsets) * (1.0 - cos(turned[0]))
        - (lines.lever_arms[1] + offsets) * (1.0 - cos(turned[1]))
    )


def earlier_tangential_jacobian(
    lines: Lines, radii: tuple[float, float], turned: tuple[float, float], face: Face = IN_THE_PLANE
) -> np.ndarray:
    """Tangential rigid displacement (n, 7), over a `face` of many slices (n, 13), of the points touching now,
    per centre coordinate one step before."""
    offsets, (arm_1, arm_2) = over_nodes(lines.pairs, "offsets"), lines.friction_arms
    height_1, height_2 = lines.lever_arms[0] - offsets, lines.lever_arms[1] + offsets
    tangent, turn = lines.tangent, lines.turn
    rows = np.zeros((len(offsets), len(CENTRE_COORDINATES)))
    # A point (x, -h) of the pinion stood at (x cos a - h sin a, ...) before the pinion turned by a; likewise the wheel.
    rows[:, 0:2], rows[:, 2] = tangent, turn * (arm_1 * cos(turned[0]) - turn * height_1 * sin(turned[0])) / radii[0]
    rows[:, 3:5], rows[:, 5] = -tangent, turn * (arm_2 * cos(turned[1]) - turn * height_2 * sin(turned[1])) / radii[1]
    if face.slices == 1:
        return rows
    from .face_jacobian import earlier_tangents_on_face

    return earlier_tangents_on_face(rows, lines, face, radii)
