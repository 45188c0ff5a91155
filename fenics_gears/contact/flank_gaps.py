"""Gaps that deviations of single teeth add to those of the contact nodes, step by step.

The gap of a node is linear in the deviations of the two teeth that meet there. The factors depend on the position in
the mesh cycle alone and are kept; each step multiplies them by the deviations of the teeth then in mesh. Where
displacements are averaged over a node's function, so are deviations.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from fenics_gears.errors import SceneError
from fenics_gears.geometry.flank_deviations import FlankDeviations, flank_deviations
from fenics_gears.geometry.flank_errors import FlankErrors
from fenics_gears.geometry.pair import GearPair
from fenics_gears.inputs.tree import GEARS

from .face import Face
from .flank_at_height import roll_angle_at_height
from .interpolation import node_average, quadrature_offsets
from .kinematics import IN_THE_PLANE
from .mesh_cycle import PerPosition
from .operator import Position
from .tooth_pair import DRIVE, PairNodes, ToothPair, node_slices

# A later tooth stands behind on the pinion, whose flank drives: the gap opens. On the wheel it stands nearer to the
# pinion's.
SENSES = (1.0, -1.0)
FEWEST_STEPS_A_WAVE = 2


@dataclass(frozen=True)
class _Nodes:
    """The contact nodes of one pair at a position: where they stand among all; for either gear the index of its tooth
    and the gap (n, m) per unit of each deviation; of either gear the functions that give the measured excess (n,) of a
    tooth."""

    nodes: slice
    teeth: tuple[int, int]
    shapes: tuple[np.ndarray, np.ndarray]
    measured: tuple[list[Callable[[int], np.ndarray]], list[Callable[[int], np.ndarray]]]


class FlankGaps:
    """Additional gaps (n,), mm, by deviations of the teeth at a step and its position; `steps` of a mesh cycle."""

    def __init__(
        self, pair: GearPair, deviations: tuple[FlankDeviations, FlankDeviations], steps: int, slope: float = 0.0
    ):
        """`slope`: of the lines of contact, mm along the path of contact per mm of height."""
        self._pair, self._deviations, self._steps, self._slope = pair, deviations, steps, slope
        gears = (pair.pinion, pair.wheel)
        self._amounts = tuple(
            _amounts(own, gear.angular_pitch, sense) for own, gear, sense in zip(deviations, gears, SENSES)
        )
        self._teeth = tuple(gear.teeth for gear in gears)
        self._nodes = PerPosition(self._nodes_of)

    def __call__(self, step: float, position: Position) -> np.ndarray:
        """The additional gaps (n,), mm, positive when they open."""
        cycle = step // self._steps
        gap = np.empty(position.operator.nodes)
        first, second = self._amounts
        for each in self._nodes(position):
            # Tooth 0 is the one that reaches the start of contact at the beginning of cycle 0.
            one, two = (int(cycle - tooth) % teeth for tooth, teeth in zip(each.teeth, self._teeth))
            shapes_1, shapes_2 = each.shapes
            gap[each.nodes] = shapes_1 @ first[one, : shapes_1.shape[1]] + shapes_2 @ second[two, : shapes_2.shape[1]]
            for tooth, measured in zip((one, two), each.measured):
                for excess in measured:
                    gap[each.nodes] -= excess(tooth)
        return gap

    def _nodes_of(self, position: Position) -> list[_Nodes]:
        pairs = position.operator.pairs
        return [
            _Nodes(
                nodes,
                pair.place.teeth,
                (self._shapes(0, pair), self._shapes(1, pair)),
                (self._measured(0, pair), self._measured(1, pair)),
            )
            for nodes, pair in zip(node_slices(pairs), pairs)
        ]

    def _shapes(self, gear: int, pair: PairNodes) -> np.ndarray:
        """The gap (n, m) that a unit of each deviation makes: index, and on drive flanks slope, form, both of the helix
        where there is one, and both parts of the waviness.

        Profiles and helices of coast flanks are true; an index deviation displaces both flanks of a tooth.
        """
        own, body, arm = (
            self._deviations[gear],
            (self._pair.pinion, self._pair.wheel)[gear],
            pair.place.line_in(self._pair).lever_arms[gear],
        )
        displaced = np.full(len(pair.offsets), pair.place.turn * SENSES[gear] * arm / body.reference_radius)
        if pair.place.flank != DRIVE:
            return displaced[:, None]
        # Waves run along the lines of contact, as the periodic error of a generating machine leaves them.
        turned = SENSES[gear] * self._slope * pair.place.height / body.base_radius
        excess = profile_shapes(own, self._rolls(gear, pair), pair, turned)
        return np.stack([displaced, *(-each for each in excess)], axis=1)

    def _rolls(self, gear: int, pair: PairNodes) -> np.ndarray:
        """Roll angles (rad) of a gear's flank at a pair's nodes, or where these average."""
        body, arm = (self._pair.pinion, self._pair.wheel)[gear], pair.place.line_in(self._pair).lever_arms[gear]
        # Nodes that average displacements average the flank as well.
        offsets = quadrature_offsets(pair.offsets) if isinstance(pair, ToothPair) else pair.offsets
        return roll_angle_at_height(body.base_radius, pair.place.contact_rolls[gear], arm - SENSES[gear] * offsets)

    def _measured(self, gear: int, pair: PairNodes) -> list[Callable[[int], np.ndarray]]:
        """Functions of the tooth that give the excess of material (n,), mm, by its measured profile and helix; none
        without curves and on coast flanks."""
        own, functions = self._deviations[gear], []
        if pair.place.flank != DRIVE:
            return functions
        if own.curves is not None:
            start, end = own.active_profile
            functions.append(_excess(own.curves, (self._rolls(gear, pair) - start) / (end - start), pair))
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
    """Excess of material (n,) at a pair's nodes for a unit of slope, form, of slope and form of the helix, and of the
    cosine and the sine of the waviness.

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


def _amounts(deviations: FlankDeviations, angular_pitch: float, sense: float) -> np.ndarray:
    """The deviations of each tooth (z, m), mm, in the order of the shapes.

    Waves continue from tooth to tooth: roll angle v of the pinion's tooth i is on the line of action when the pinion
    has turned by v + i times the angular pitch; on the wheel, where roll angles fall, by i times the angular pitch less
    v.
    """
    columns = [deviations.index, deviations.slope, deviations.form]
    if deviations.helix is not None:
        columns += [deviations.helix.slope, deviations.helix.form]
    if deviations.waviness is not None:
        waves = deviations.waviness
        phase = waves.phase + sense * waves.waves * angular_pitch * np.arange(len(deviations.index))
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
        waviness, teeth = getattr(errors, name).waviness, getattr(pair, name).teeth
        waves = 0 if waviness is None else waviness.waves
        if waves * FEWEST_STEPS_A_WAVE > steps * teeth:
            raise SceneError(
                f"flank_errors.{name}.waviness.waves = {waves}: a turn of the {name} has {steps * teeth} steps,"
                f" fewer than {FEWEST_STEPS_A_WAVE} a wave; raise accuracy.steps_per_mesh_cycle to"
                f" {-(-FEWEST_STEPS_A_WAVE * waves // teeth)} or more"
            )
