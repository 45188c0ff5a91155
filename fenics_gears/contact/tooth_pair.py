"""One tooth pair at one position: its contact nodes, gaps, sliding, and how they see either gear."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from fenics_gears.contact.interpolation import (
    FlankInterpolation,
    flank_interpolation,
    hat_average,
    hat_integrals,
    quadrature_offsets,
)
from fenics_gears.contact.window import ContactGrid, contact_roll_angles, node_offsets
from fenics_gears.elasticity.compliance import FlankCompliance
from fenics_gears.geometry.involute import flank_point, roll_angle_at_height
from fenics_gears.geometry.pair import GearPair

Removal = Callable[[np.ndarray], np.ndarray]


@dataclass(frozen=True)
class Flanks:
    """What the contact layer needs of the two gears: geometry, compliance, and material removed from either flank.

    `removal`: functions of the roll angle (rad) giving mm along the flank normal, or None for a true involute.
    """

    pair: GearPair
    compliance: tuple[FlankCompliance, FlankCompliance]
    removal: tuple[Removal | None, Removal | None] = (None, None)


@dataclass(frozen=True)
class ToothPair:
    """Contact nodes (n,) of the tooth pair `index` at one position.

    `offsets` (mm, from the line of action), `lengths` (mm of flank a node stands for), `gap` [9] (mm, positive when
    open), `pinion_arm` and `wheel_arm` (mm: distance from the tangent points T1 and T2 along the line of action),
    `pinion_roll` (rad), `contact_roll` of either gear (rad), `interpolation` of either flank.
    """

    index: int
    offsets: np.ndarray
    lengths: np.ndarray
    gap: np.ndarray
    pinion_arm: np.ndarray
    wheel_arm: np.ndarray
    pinion_roll: np.ndarray
    contact_roll: tuple[float, float]
    interpolation: tuple[FlankInterpolation, FlankInterpolation]


def tooth_pair(flanks: Flanks, grid: ContactGrid, index: int, xi: float) -> ToothPair | None:
    """The tooth pair whose theoretical contact lies at `xi` (mm from T1), or None where its window is empty."""
    offsets = node_offsets(flanks.pair, xi, grid)
    if not len(offsets):
        return None
    pinion, wheel = flanks.pair.pinion, flanks.pair.wheel
    roll_1, roll_2 = contact_roll_angles(flanks.pair, xi)
    y = quadrature_offsets(offsets)
    flank_1 = roll_angle_at_height(pinion.base_radius, roll_1, pinion.base_radius - y)
    flank_2 = roll_angle_at_height(wheel.base_radius, roll_2, wheel.base_radius + y)
    x_1 = flank_point(pinion.base_radius, flank_1, roll_1)[0]
    x_2 = flank_point(wheel.base_radius, flank_2, roll_2)[0]
    gap = flanks.pair.line_of_action_length - x_2 - x_1
    for removal, rolls in zip(flanks.removal, (flank_1, flank_2)):
        if removal is not None:
            gap = gap + removal(rolls)
    node_rolls = (
        roll_angle_at_height(pinion.base_radius, roll_1, pinion.base_radius - offsets),
        roll_angle_at_height(wheel.base_radius, roll_2, wheel.base_radius + offsets),
    )
    interpolation = tuple(
        flank_interpolation(
            offsets, rolls, gear.base_radius, contact_roll, sense, flank.roll_angle, flank.element_order
        )
        for gear, rolls, contact_roll, sense, flank in zip(
            (pinion, wheel), node_rolls, (roll_1, roll_2), (-1.0, 1.0), flanks.compliance
        )
    )
    return ToothPair(
        index=index,
        offsets=offsets,
        lengths=hat_integrals(offsets),
        gap=hat_average(offsets, gap),
        pinion_arm=hat_average(offsets, x_1),
        wheel_arm=hat_average(offsets, x_2),
        pinion_roll=node_rolls[0],
        contact_roll=(roll_1, roll_2),
        interpolation=interpolation,
    )
