"""The contact equations at one position of the gears: the nodes that may touch, and their response.

Unknowns of the mixed form (model.md section 4) are nodal forces `p` and centre coordinates `q`; the relative displacement
of the contact nodes is `u = G q - C p`. Rows come normals first, then tangents where friction asks for them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from fenics_gears.contact.compliance_product import compliance_product, directions
from fenics_gears.contact.rank import of_full_rank
from fenics_gears.contact.tooth_pair import DRIVE, Flanks, PairNodes, ToothPair
from fenics_gears.geometry.pair import GearPair

# The seven centre coordinates q of the model. Rotations are carried as arc lengths rb1 phi1, rb2 phi2 (mm), so that every
# coordinate is a length and every row a force, and no equation is scaled against another. The output shaft's end goes by its
# twist rb2 (phi3 - phi2): as the difference of two rotations the twist of a stiff shaft would be lost in round-off.
CENTRE_COORDINATES = ("centre_x1", "centre_y1", "rotation_1", "centre_x2", "centre_y2", "rotation_2", "shaft_twist")


@dataclass(frozen=True)
class ContactOperator:
    """Contact at one position: n nodes, m = n without friction, 2 n with it; k centre coordinates.

    `base_radii` (mm) of pinion and wheel; `pairs`: the tooth pairs whose nodes these are, in order; `normal_lever_arms` (n,),
    mm: of a normal force about the pinion's and the wheel's centre.

    `compliance` C (m, m), mm/N; `jacobian` G (m, k); `gap` (n,), mm; `rigid_slip` (n,), mm: slip of rigid flanks during the step that ends
    here; `previous_compliance` E (n, m of the step before) and `previous_jacobian` (n, k): the tangential displacement that
    the material points touching now had at the end of the step before is `previous_jacobian q - E p`. The last three are
    None without friction.

    `dependent_rows`: rows of the compliance that are combinations of others, see `contact.rank`.
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
        return per_node(self.pairs, np.array([pair.place.flank == DRIVE for pair in self.pairs], dtype=bool))


def node_slices(pairs: Sequence[PairNodes]) -> list[slice]:
    """Where each pair's contact nodes stand among those of all pairs, one pair after the other."""
    ends = np.cumsum([0] + [len(pair.offsets) for pair in pairs])
    return [slice(start, end) for start, end in zip(ends[:-1], ends[1:])]


def over_nodes(pairs: Sequence[PairNodes], name: str) -> np.ndarray:
    """An array of every pair's contact nodes, one pair after the other."""
    return np.concatenate([getattr(pair, name) for pair in pairs]) if pairs else np.empty(0)


def per_node(pairs: Sequence[PairNodes], values: np.ndarray) -> np.ndarray:
    """A value of each pair (pairs, ...) repeated for its contact nodes (n, ...)."""
    return np.repeat(values, [len(pair.offsets) for pair in pairs], axis=0)


def normals(pairs: Sequence[PairNodes]) -> np.ndarray:
    """Direction (n, 2) in space of each node's line of action, from pinion to wheel."""
    return _axes(pairs)[0]


def _axes(pairs: Sequence[PairNodes]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Normal (n, 2) and tangential (n, 2) direction of each node in space, and the sign (n,) of rotations there."""
    axes = per_node(pairs, np.array([pair.place.axes for pair in pairs]).reshape(len(pairs), 2, 2))
    return axes[:, 0], axes[:, 1], per_node(pairs, np.array([pair.place.turn for pair in pairs]))


def line_lever_arms(pairs: Sequence[PairNodes], base_radii: tuple[float, float]) -> tuple[np.ndarray, np.ndarray]:
    """Lever arms (n,), mm, of normal forces: the base radii, and at a tip's edge those of the mate's normal.

    An involute turned by phi moves by rb phi along its own normal wherever it is touched, so that T1/rb1 = T2/rb2 holds
    exactly without friction.
    """
    lines = [base_radii if pair.place.line is None else pair.place.line.lever_arms for pair in pairs]
    arms = per_node(pairs, np.array(lines).reshape(len(pairs), 2))
    return arms[:, 0].copy(), arms[:, 1].copy()


def displacement_jacobian(
    pairs: tuple[PairNodes, ...],
    base_radii: tuple[float, float],
    normal_lever_arms: tuple[np.ndarray, np.ndarray],
    tangential: bool,
) -> np.ndarray:
    """Relative displacement of the contact nodes per centre coordinate: G (m, 7), over CENTRE_COORDINATES, mm per mm."""
    nodes = sum(len(pair.offsets) for pair in pairs)
    rows = np.zeros((2 * nodes if tangential else nodes, len(CENTRE_COORDINATES)))
    normal, tangent, turn = _axes(pairs)
    rows[:nodes, 0:2], rows[:nodes, 2] = normal, turn * normal_lever_arms[0] / base_radii[0]
    rows[:nodes, 3:5], rows[:nodes, 5] = -normal, turn * normal_lever_arms[1] / base_radii[1]
    if tangential:
        rows[nodes:, 0:2], rows[nodes:, 2] = tangent, turn * over_nodes(pairs, "pinion_lever_arm") / base_radii[0]
        rows[nodes:, 3:5], rows[nodes:, 5] = -tangent, turn * over_nodes(pairs, "wheel_lever_arm") / base_radii[1]
    return rows


class CompliancePairing:
    """Compliance between the contact nodes of two sets of tooth pairs, from the flank compliances of both gears."""

    def __init__(self, flanks: Flanks, kept: tuple[dict, dict] | None = None):
        """`kept`: where blocks of either gear, over the face width, are kept; pairings of the same bodies may share it."""
        self._widths, self._gears = flanks.pair.face_widths, flanks.compliance
        self._blocks = ({}, {}) if kept is None else kept

    def _block(self, gear: int, responding: ToothPair, loaded: ToothPair) -> np.ndarray:
        body, blocks = self._gears[gear], self._blocks[gear]
        teeth = responding.place.ahead(gear), loaded.place.ahead(gear)
        sides = responding.place.flank, loaded.place.flank
        key = body.key(*teeth), *sides
        if key not in blocks:
            blocks[key] = np.ascontiguousarray(body.between(*teeth, sides)) / self._widths[gear]
        return blocks[key]

    def product(
        self,
        responding: tuple[ToothPair, ...],
        loaded: tuple[ToothPair, ...],
        response_directions,
        load_directions,
        symmetric: bool = False,
    ) -> np.ndarray:
        """Sum over both gears of `N A N^T`: (d_r n_r, d_l n_l), mm/N, directions outermost.

        `response_directions(gear, pair)` and `load_directions(gear, pair)` give unit vectors (d, 2) in tooth frames.
        """
        if not responding or not loaded:
            return np.zeros((0, 0))
        rows, columns = node_slices(responding), node_slices(loaded)
        kinds = len(response_directions(0, responding[0])), len(load_directions(0, loaded[0]))
        result = np.zeros((kinds[0], rows[-1].stop, kinds[1], columns[-1].stop))
        for a, pair_a in enumerate(responding):
            for b, pair_b in enumerate(loaded):
                if symmetric and b > a:
                    continue
                part = np.zeros((kinds[0], len(pair_a.offsets), kinds[1], len(pair_b.offsets)))
                for gear in range(2):
                    n_a, n_b = pair_a.interpolation[gear], pair_b.interpolation[gear]
                    compliance_product(
                        self._block(gear, pair_a, pair_b),
                        n_a.near, n_a.first, n_a.last, response_directions(gear, pair_a),
                        n_b.near, n_b.first, n_b.last, load_directions(gear, pair_b),
                        part,
                    )  # fmt: skip
                result[:, rows[a], :, columns[b]] = part
                if symmetric and b < a:
                    result[:, rows[b], :, columns[a]] = part.transpose(2, 3, 0, 1)
        return result.reshape(kinds[0] * rows[-1].stop, -1)


def own_directions(tangential: bool):
    """Directions at a pair's own position: e_x, and e_y where friction asks for it."""
    return lambda gear, pair: directions(pair.place.contact_rolls[gear], tangential)


def earlier_tangent(advance: tuple[float, float]):
    """e_y at the material point as it stood `advance` (rad, of either gear) before: that tooth's frame then."""
    return lambda gear, pair: directions(pair.place.contact_rolls[gear] - pair.place.turn * advance[gear], True)[1:]


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
    own = own_directions(previous is not None)
    compliance, dependent = of_full_rank(pairing.product(pairs, pairs, own, own, symmetric=True))
    before = None
    if previous is not None:
        before = pairing.product(pairs, previous, earlier_tangent(turned(flanks.pair, advance)), own)
    return replace(operator_on_lines(flanks.pair, pairs, coordinates, compliance, before, advance), dependent_rows=dependent)


def operator_on_lines(
    gears: GearPair,
    pairs: tuple[PairNodes, ...],
    coordinates: list[int],
    compliance: np.ndarray,
    previous_compliance: np.ndarray | None,
    advance: float,
) -> ContactOperator:
    """The contact equations of nodes whose normal forces act along their pair's line; `previous_compliance` None without friction.

    Arguments as of `contact_operator`, arrays as of ContactOperator.
    """
    radii = (gears.pinion.base_radius, gears.wheel.base_radius)
    arms, frictional = line_lever_arms(pairs, radii), previous_compliance is not None
    slip = slip_of_rigid_flanks(pairs, radii, turned(gears, advance)) if frictional else None
    earlier = earlier_tangential_jacobian(pairs, radii, turned(gears, advance))[:, coordinates] if frictional else None
    return ContactOperator(
        pairs=pairs,
        base_radii=radii,
        normal_lever_arms=arms,
        compliance=compliance,
        jacobian=np.ascontiguousarray(displacement_jacobian(pairs, radii, arms, frictional)[:, coordinates]),
        gap=over_nodes(pairs, "gap"),
        rigid_slip=slip,
        previous_compliance=previous_compliance,
        previous_jacobian=None if earlier is None else np.ascontiguousarray(earlier),
    )


def turned(gears: GearPair, advance: float) -> tuple[float, float]:
    """By how much (rad) the roll angles of pinion and wheel rise while the pinion turns by `advance`; the wheel's fall."""
    return advance, -advance * gears.pinion.base_radius / gears.wheel.base_radius


def slip_of_rigid_flanks(pairs: tuple[PairNodes, ...], base_radii: tuple[float, float], turned: tuple[float, float]) -> np.ndarray:
    """Slip (n,), mm, of the points touching now while rigid gears turned to here: the exact integral of the sliding speed [12].

    The sliding speed times the step would be of first order only: the speed grows in proportion to the distance from the pitch point.
    """
    offsets, arm_1, arm_2 = (over_nodes(pairs, name) for name in ("offsets", "pinion_lever_arm", "wheel_lever_arm"))
    line_1, line_2 = line_lever_arms(pairs, base_radii)
    turn = per_node(pairs, np.array([pair.place.turn for pair in pairs]))
    straight = turn * (arm_1 * np.sin(turned[0]) + arm_2 * np.sin(turned[1]))
    return straight - (line_1 - offsets) * (1.0 - np.cos(turned[0])) - (line_2 + offsets) * (1.0 - np.cos(turned[1]))


def sliding_now(pairs: tuple[PairNodes, ...], base_radii: tuple[float, float]) -> np.ndarray:
    """Sliding (n,), mm per rad of the pinion, of rigid gears at this position: x - (z1/z2) (L - x) of [12], zero at the pitch point."""
    turn = per_node(pairs, np.array([pair.place.turn for pair in pairs]))
    return turn * (over_nodes(pairs, "pinion_lever_arm") - base_radii[0] / base_radii[1] * over_nodes(pairs, "wheel_lever_arm"))


def earlier_tangential_jacobian(pairs, radii, turned) -> np.ndarray:
    """Tangential rigid displacement (n, 7) of the points touching now, per centre coordinate one step before."""
    rows = np.zeros((sum(len(pair.offsets) for pair in pairs), len(CENTRE_COORDINATES)))
    offsets, arm_1, arm_2 = (over_nodes(pairs, name) for name in ("offsets", "pinion_lever_arm", "wheel_lever_arm"))
    line_1, line_2 = line_lever_arms(pairs, radii)
    height_1, height_2 = line_1 - offsets, line_2 + offsets
    _, tangent, turn = _axes(pairs)
    # A point (x, -h) of the pinion stood at (x cos a - h sin a, ...) before the pinion turned by a; likewise the wheel.
    rows[:, 0:2], rows[:, 2] = tangent, turn * (arm_1 * np.cos(turned[0]) - turn * height_1 * np.sin(turned[0])) / radii[0]
    rows[:, 3:5], rows[:, 5] = -tangent, turn * (arm_2 * np.cos(turned[1]) - turn * height_2 * np.sin(turned[1])) / radii[1]
    return rows
