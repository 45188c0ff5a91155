"""Gaps that deviations of single teeth add to those of the contact nodes, step by step.

The gap of a node is linear in the deviations of the two teeth that meet there. The factors depend on the position in
the mesh cycle alone and are kept; each step multiplies them by the deviations of the teeth then in mesh. Where
displacements are averaged over a node's function, so are deviations.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from fenics_gears.errors import SceneError
from fenics_gears.geometry.flank_deviations import FlankDeviations, flank_deviations
from fenics_gears.geometry.flank_errors import FlankErrors
from fenics_gears.geometry.pair import GearPair
from fenics_gears.geometry.side import Side
from fenics_gears.inputs.tree import GEARS

from .face import Face
from .flank_at_height import roll_angle_at_height
from .interpolation import node_average, quadrature_offsets
from .kinematics import IN_THE_PLANE
from .mesh_cycle import PerPosition
from .operator import Position
from .tooth_pair import DRIVE, PairNodes, ToothPair, node_slices

FEWEST_STEPS_A_WAVE = 2


@dataclass(frozen=True)
class _OnSide:
    """The contact nodes of one pair on one of its flanks: where they are among all, and the tooth, as of a Place.

    `shapes` (n, m): the gap per unit of each deviation; `measured`: functions that give the excess (n,) of a tooth.
    """

    nodes: slice
    side: Side
    tooth: int
    shapes: np.ndarray
    measured: list[Callable[[int], np.ndarray]]


class FlankGaps:
    """Additional gaps (n,), mm, by deviations of the teeth at a step and its position; `steps` of a mesh cycle."""

    def __init__(
        self, pair: GearPair, deviations: tuple[FlankDeviations, FlankDeviations], steps: int, slope: float = 0.0
    ):
        """`slope`: of the lines of contact, mm along the path of contact per mm of height."""
        self._pair = pair
        self._deviations = deviations
        self._steps = steps
        self._slope = slope
        self._amounts = [_amounts(own, side) for own, side in zip(deviations, pair.sides)]
        self._sides = PerPosition(self._sides_of)

    def __call__(self, step: float, position: Position) -> np.ndarray:
        """The additional gaps (n,), mm, positive when they open."""
        cycle = step // self._steps
        gap = np.zeros(position.operator.nodes)
        for each in self._sides(position):
            # Tooth 0 is the one that reaches the start of contact at the beginning of cycle 0.
            tooth = int(cycle - each.side.sense * each.tooth) % each.side.gear.tooth_count
            gap[each.nodes] += each.shapes @ self._amounts[each.side.number][tooth, : each.shapes.shape[1]]
            for excess in each.measured:
                gap[each.nodes] -= excess(tooth)
        return gap

    @staticmethod
    def of_runs(gaps: Sequence[FlankGaps], steps: np.ndarray) -> Callable[[Position, slice], np.ndarray]:
        """As of `RunOut.of_runs`, of teeth without measured curves."""
        first = gaps[0]
        amounts = [np.array([each._amounts[number] for each in gaps]) for number in range(2)]
        cycles = (steps // first._steps).astype(int)

        def of_position(position: Position, there: slice) -> np.ndarray:
            found = np.zeros((len(gaps), len(cycles[there]), position.operator.nodes))
            for each in first._sides(position):
                teeth = (cycles[there] - each.side.sense * each.tooth) % each.side.gear.tooth_count
                of_teeth = amounts[each.side.number][:, teeth, : each.shapes.shape[1]]
                found[..., each.nodes] += of_teeth @ each.shapes.T
            return found

        return of_position

    def _sides_of(self, position: Position) -> list[_OnSide]:
        pairs = position.operator.pairs
        return [
            _OnSide(nodes, side, tooth, self._shapes(side, pair), self._measured(side, pair))
            for nodes, pair in zip(node_slices(pairs), pairs)
            for side, tooth in zip(self._pair.sides, pair.place.teeth)
        ]

    def _shapes(self, side: Side, pair: PairNodes) -> np.ndarray:
        """The gap (n, m) that a unit of each deviation makes: index, and on drive flanks slope, form, both of the helix
        where there is one, and both parts of the waviness.

        Profiles and helices of coast flanks are true; an index deviation displaces both flanks of a tooth.
        """
        arm = pair.place.line_in(self._pair).lever_arms[side.number]
        # A tooth too far on opens the gap of the pinion, whose flank drives. On the wheel it is nearer to the pinion's.
        displaced = np.full(len(pair.offsets), pair.place.turn * side.sense * arm / side.gear.reference_radius)
        if pair.place.flank != DRIVE:
            return displaced[:, None]
        # Waves run along the lines of contact, as the periodic error of a generating machine leaves them.
        turned = side.sense * self._slope * pair.place.height / side.gear.base_radius
        excess = profile_shapes(self._deviations[side.number], self._rolls(side, pair), pair, turned)
        return np.stack([displaced, *(-each for each in excess)], axis=1)

    def _rolls(self, side: Side, pair: PairNodes) -> np.ndarray:
        """Roll angles (rad) of a gear's flank at a pair's nodes, or where these average."""
        arm = pair.place.line_in(self._pair).lever_arms[side.number]
        # Nodes that average displacements average the flank as well.
        offsets = quadrature_offsets(pair.offsets) if isinstance(pair, ToothPair) else pair.offsets
        contact = pair.place.contact_rolls[side.number]
        return roll_angle_at_height(side.gear.base_radius, contact, arm - side.sense * offsets)

    def _measured(self, side: Side, pair: PairNodes) -> list[Callable[[int], np.ndarray]]:
        """Functions of the tooth that give the excess of material (n,), mm, by its measured profile and helix; none
        without curves and on coast flanks."""
        own = self._deviations[side.number]
        functions: list[Callable[[int], np.ndarray]] = []
        if pair.place.flank != DRIVE:
            return functions
        if own.curves is not None:
            start, end = own.active_profile
            functions.append(_excess(own.curves, (self._rolls(side, pair) - start) / (end - start), pair))
        if own.helix is not None and own.helix.curves is not None:
            along = 0.5 + (pair.place.height - own.helix.middle) / own.helix.width
            functions.append(_excess(own.helix.curves, np.full(len(pair.offsets), along), pair, averaged=False))
        return functions


def _excess(
    curves: np.ndarray, along: np.ndarray, pair: PairNodes, averaged: bool = True
) -> Callable[[int], np.ndarray]:
    """The excess (n,), mm, of a tooth at places from 0 to 1 `along` its curve; beyond the ends the curve is level."""
    points = np.linspace(0.0, 1.0, curves.shape[1])
    if averaged and isinstance(pair, ToothPair):
        return lambda tooth: node_average(pair.offsets, np.interp(along, points, curves[tooth]))
    return lambda tooth: np.interp(along, points, curves[tooth])


def profile_shapes(
    deviations: FlankDeviations, roll: np.ndarray, pair: PairNodes, turned: float = 0.0
) -> list[np.ndarray]:
    """Excess of material (n,) at a pair's nodes for a unit of slope and form, of slope and form of the helix, and of
    both parts of the waviness.

    `roll`: roll angles (rad) at the nodes, or where these average; `turned`: by which the helix turns the gear's
    section at the pair's height, in the sense of rotation.
    """
    start, end = deviations.active_profile
    along = (roll - start) / (end - start)
    shapes = [along - 0.5, -0.5 * np.cos(2.0 * np.pi * along)]
    if deviations.helix is not None:
        over_face = np.full_like(roll, (pair.place.height - deviations.helix.middle) / deviations.helix.width)
        shapes += [over_face, 0.5 * np.cos(2.0 * np.pi * over_face)]
    if deviations.waviness is not None:
        waves = deviations.waviness.waves * (roll - turned)
        shapes += [np.cos(waves), -np.sin(waves)]
    return [node_average(pair.offsets, each) for each in shapes] if isinstance(pair, ToothPair) else shapes


def _amounts(deviations: FlankDeviations, side: Side) -> np.ndarray:
    """The deviations of each tooth (z, m), mm, in the order of the shapes.

    Waves continue from tooth to tooth. Roll angle v of the pinion's tooth i is on the line of action when the pinion
    has turned by i pitches and v. On the wheel, where roll angles fall, it is there after i pitches less v.
    """
    columns = [deviations.index, deviations.slope, deviations.form]
    if deviations.helix is not None:
        columns += [deviations.helix.slope, deviations.helix.form]
    if deviations.waviness is not None:
        waves = deviations.waviness
        phase = waves.phase + waves.waves * side.turn * np.arange(len(deviations.index))
        columns += [waves.amplitude * np.cos(phase), waves.amplitude * np.sin(phase)]
    return np.ascontiguousarray(np.stack(columns, axis=1))


def deviations_of(errors: FlankErrors, pair: GearPair, face: Face) -> tuple[FlankDeviations, FlankDeviations]:
    """Deviations of pinion and wheel; those along the face where it has many slices."""
    return flank_deviations(errors, pair, face.middles if face.slices > 1 else None)


def flank_gaps(errors: FlankErrors, pair: GearPair, steps: int, face: Face = IN_THE_PLANE) -> FlankGaps:
    """The gaps that flank errors add, in a run of so many steps a mesh cycle; `face`: with its slices."""
    return FlankGaps(pair, deviations_of(errors, pair, face), steps, face.slope)


def check_waves(errors: FlankErrors, pair: GearPair, steps: int) -> None:
    """Raise SceneError for waves that so many steps a mesh cycle do not sample."""
    for name in GEARS:
        waviness = getattr(errors, name).waviness
        teeth = getattr(pair, name).tooth_count
        waves = 0 if waviness is None else waviness.waves
        if waves * FEWEST_STEPS_A_WAVE > steps * teeth:
            raise SceneError(
                f"flank_errors.{name}.waviness.waves = {waves}: a turn of the {name} has {steps * teeth} steps,"
                f" fewer than {FEWEST_STEPS_A_WAVE} a wave; raise accuracy.steps_per_mesh_cycle to"
                f" {-(-FEWEST_STEPS_A_WAVE * waves // teeth)} or more"
            )
