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
from typing import TYPE_CHECKING

import numpy as np

from fenics_gears.contact.compliance_product import compliance_product, directions
from fenics_gears.contact.rank import of_full_rank
from fenics_gears.contact.tooth_pair import DRIVE, Flanks, PairNodes, Place, ToothPair
from fenics_gears.geometry.pair import GearPair

if TYPE_CHECKING:
    from fenics_gears.contact.face import Face

# The centre coordinates q of the model: seven in the plane. Rotations are carried as arc lengths rb1 phi1, rb2 phi2
# (mm), so that every coordinate is a length and every row a force, and no equation is scaled against another. The
# output shaft's end goes by its twist rb2 (phi3 - phi2): as the difference of two rotations the twist of a stiff shaft
# would be lost in round-off.
CENTRE_COORDINATES = ("centre_x1", "centre_y1", "rotation_1", "centre_x2", "centre_y2", "rotation_2", "shaft_twist")
# Six more of gears that also move along their axes and tilt; tilts are carried as arc lengths, rb theta.
FACE_COORDINATES = ("axial_1", "tilt_x1", "tilt_y1", "axial_2", "tilt_x2", "tilt_y2")
COORDINATES = CENTRE_COORDINATES + FACE_COORDINATES


@dataclass(frozen=True)
class ContactOperator:
    """Contact at one position: n nodes, m = n without friction, 2 n with it; k centre coordinates.

    `base_radii` (mm) of pinion and wheel; `pairs`: the tooth pairs whose nodes these are, in order; `normal_lever_arms`
    (n,),
    mm: of a normal force about the pinion's and the wheel's centre.

    `compliance` C (m, m), mm/N; `jacobian` G (m, k); `gap` (n,), mm; `rigid_slip` (n,), mm: slip of rigid flanks during
    the step that ends here; `previous_compliance` E (n, m of the step before) and `previous_jacobian` (n, k): the
    tangential displacement that the material points touching now had at the end of the step before is
    `previous_jacobian q - E p`. The last three are None without friction.

    `dependent_rows`: rows of the compliance that are combinations of others, see `contact.rank`. `face`: of pairs in
        slices; None in the plane.
    """

    pairs: tuple[PairNodes, ...]
    base_radii: tuple[float, float]
    normal_lever_arms: tuple[np.ndarray, np.ndarray]
    compliance: np.ndarray
    jacobian: np.ndarray
    gap: np.ndarray
    rigid_slip: np.ndarray | None
    previous_compliance: np.ndarray | None
    previous_jacobian: np.ndarray | None
    dependent_rows: int = 0
    face: Face | None = None

    @property
    def nodes(self) -> int:
        """Number of contact nodes."""
        return len(self.gap)

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
    face: Face | None = None,
) -> np.ndarray:
    """Relative displacement of the contact nodes per centre coordinate: G (m, 7), over CENTRE_COORDINATES, mm per mm;
    over a `face` (m, 13).

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
    if face is None:
        return rows
    from fenics_gears.contact.face_jacobian import on_face

    return on_face(rows, lines, face, base_radii)


# A flank of a gear, by its tooth's place and its side; contact nodes as `compliance_product` takes them, and none of
# them.
_Flank = tuple[int, int]
_Nodes = tuple[int, np.ndarray, np.ndarray, np.ndarray]
NO_NODES: _Nodes = (0, np.empty((0, 1)), np.empty(0, dtype=np.int64), np.eye(2))


class CompliancePairing:
    """Compliance between the contact nodes of tooth pairs, from the flank compliances of both gears."""

    def __init__(self, flanks: Flanks, kept: tuple[dict, dict] | None = None, width: float | None = None):
        """`kept`: where blocks of either gear are kept; pairings of the same bodies may share it. `width` (mm): over
        which a force spreads, the
        common face width unless given."""
        self._width, self._gears = width or flanks.pair.face_width, flanks.compliance
        self._blocks = ({}, {}) if kept is None else kept

    def _block(self, gear: int, responding: _Flank, loaded: _Flank) -> np.ndarray:
        body, blocks, teeth, sides = (
            self._gears[gear],
            self._blocks[gear],
            (responding[0], loaded[0]),
            (responding[1], loaded[1]),
        )
        key = body.key(*teeth), sides
        if key not in blocks:
            blocks[key] = np.ascontiguousarray(body.between(*teeth, sides))
        return blocks[key]

    def compliance(
        self,
        pairs: Sequence[ToothPair],
        previous: Sequence[ToothPair] | None = None,
        turned: tuple[float, float] = (0.0, 0.0),
    ) -> tuple[np.ndarray, np.ndarray | None]:
        """Sum over both gears of `N A N^T`, mm/N: C (m, m) between the nodes of `pairs`, and E (n, m before) by forces
        on those of `previous`.

        With `previous`, the pairs a step before, there are tangential rows, and E is the displacement along the tangent
        that the material points had while the gears stood `turned` (rad, of either one) before. E is None without.
        """
        tangential = previous is not None
        kinds, nodes, nodes_before = 2 if tangential else 1, _count(pairs), _count(previous or ())
        compliance, earlier = np.zeros((kinds, nodes, kinds, nodes)), np.zeros((1, nodes, 2, nodes_before))
        for gear in range(2):
            now, before = (_nodes_of(each, gear, tangential) for each in (pairs, previous or ()))
            loads = _matched(now, before)
            for pair, (flank, own) in zip(pairs, now):
                row, near, first, axes = own
                if tangential:
                    axes = np.concatenate([axes, _earlier_tangent(pair.place, gear, turned)])
                own = row, near, first, axes / self._width
                for other, loaded, loaded_before in loads:
                    # The other half follows by symmetry.
                    loaded = loaded if loaded[0] <= row else NO_NODES
                    if len(loaded[2]) or len(loaded_before[2]):
                        compliance_product(
                            self._block(gear, flank, other), own, loaded, compliance, loaded_before, earlier
                        )
        rows = kinds * nodes
        return compliance.reshape(rows, rows), earlier.reshape(nodes, 2 * nodes_before) if tangential else None


def _count(pairs: Sequence[PairNodes]) -> int:
    return sum(len(pair.offsets) for pair in pairs)


def _nodes_of(pairs: Sequence[ToothPair], gear: int, tangential: bool) -> list[tuple[_Flank, _Nodes]]:
    """The flank of each pair, its contact nodes, and the directions of forces on them: e_x, and e_y where friction asks
    for it."""
    found, start = [], 0
    for pair in pairs:
        view, place = pair.interpolation[gear], pair.place
        axes = directions(place.contact_rolls[gear], tangential)
        found.append(((place.ahead(gear), place.flank), (start, view.near, view.first, axes)))
        start += len(view.near)
    return found


def _matched(
    now: list[tuple[_Flank, _Nodes]], before: list[tuple[_Flank, _Nodes]]
) -> list[tuple[_Flank, _Nodes, _Nodes]]:
    """Contact nodes now and a step before that are on the same flank, and those that have none beside them."""
    left, found = list(before), []
    for flank, nodes in now:
        same = next((place for place, (other, _) in enumerate(left) if other == flank), None)
        found.append((flank, nodes, NO_NODES if same is None else left.pop(same)[1]))
    return found + [(flank, NO_NODES, nodes) for flank, nodes in left]


def _earlier_tangent(place: Place, gear: int, turned: tuple[float, float]) -> np.ndarray:
    """e_y (1, 2) at the material point as it stood `turned` (rad, of either gear) before: that tooth's frame then."""
    return directions(place.contact_rolls[gear] - place.turn * turned[gear], True)[1:]


def contact_operator(
    flanks: Flanks,
    pairing: CompliancePairing,
    pairs: tuple[ToothPair, ...],
    *,
    coordinates: list[int],
    previous: tuple[ToothPair, ...] | None = None,
    advance: float = 0.0,
) -> ContactOperator:
    """Assemble the contact equations of `pairs`; with `previous`, the pairs one step before, those of friction too.

    `coordinates`: which of CENTRE_COORDINATES are unknowns; `advance`: rotation of the pinion (rad) during the step.
    """
    compliance, before = pairing.compliance(pairs, previous, turned(flanks.pair, advance))
    compliance, dependent = of_full_rank(compliance)
    return operator_on_lines(flanks.pair, pairs, coordinates, compliance, before, advance, dependent)


def operator_on_lines(
    gears: GearPair,
    pairs: tuple[PairNodes, ...],
    coordinates: list[int],
    compliance: np.ndarray,
    previous_compliance: np.ndarray | None,
    advance: float,
    dependent_rows: int = 0,
    face: Face | None = None,
) -> ContactOperator:
    """The contact equations of nodes whose normal forces act along their pair's line; `previous_compliance` None
    without friction.

    Arguments as of `contact_operator`, arrays as of ContactOperator.
    """
    radii, frictional = (gears.pinion.base_radius, gears.wheel.base_radius), previous_compliance is not None
    lines = lines_of(pairs, radii)
    return ContactOperator(
        pairs=pairs,
        base_radii=radii,
        normal_lever_arms=lines.lever_arms,
        compliance=compliance,
        jacobian=displacement_jacobian(pairs, radii, lines.lever_arms, frictional, lines, face).take(
            coordinates, axis=1
        ),
        gap=over_nodes(pairs, "gap"),
        rigid_slip=slip_of_rigid_flanks(lines, turned(gears, advance)) if frictional else None,
        previous_compliance=np.asfortranarray(previous_compliance) if frictional else None,
        previous_jacobian=earlier_tangential_jacobian(lines, radii, turned(gears, advance), face).take(
            coordinates, axis=1
        )
        if frictional
        else None,
        dependent_rows=dependent_rows,
        face=face,
    )


def turned(gears: GearPair, advance: float) -> tuple[float, float]:
    """By how much (rad) the roll angles of pinion and wheel rise while the pinion turns by `advance`; the wheel's
    fall."""
    return advance, -advance * gears.pinion.base_radius / gears.wheel.base_radius


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
    lines: Lines, radii: tuple[float, float], turned: tuple[float, float], face: Face | None = None
) -> np.ndarray:
    """Tangential rigid displacement (n, 7), over a `face` (n, 13), of the points touching now, per centre coordinate
    one step before."""
    offsets, (arm_1, arm_2) = over_nodes(lines.pairs, "offsets"), lines.friction_arms
    height_1, height_2 = lines.lever_arms[0] - offsets, lines.lever_arms[1] + offsets
    tangent, turn = lines.tangent, lines.turn
    rows = np.zeros((len(offsets), len(CENTRE_COORDINATES)))
    # A point (x, -h) of the pinion stood at (x cos a - h sin a, ...) before the pinion turned by a; likewise the wheel.
    rows[:, 0:2], rows[:, 2] = tangent, turn * (arm_1 * cos(turned[0]) - turn * height_1 * sin(turned[0])) / radii[0]
    rows[:, 3:5], rows[:, 5] = -tangent, turn * (arm_2 * cos(turned[1]) - turn * height_2 * sin(turned[1])) / radii[1]
    if face is None:
        return rows
    from fenics_gears.contact.face_jacobian import earlier_tangents_on_face

    return earlier_tangents_on_face(rows, lines, face, radii)
