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
class PairNodes:
    """Contact nodes (n,) of the tooth pair `index` at one position.

    `offsets` (mm, from the line of action), `lengths` (mm of flank a node stands for), `gap` [9] (mm, positive when
    open), `pinion_arm` and `wheel_arm` (mm: distance from the tangent points T1 and T2 along the line of action),
    `pinion_roll` (rad), `contact_roll` of either gear (rad).
    """

    index: int
    offsets: np.ndarray
    lengths: np.ndarray
    gap: np.ndarray
    pinion_arm: np.ndarray
    wheel_arm: np.ndarray
    pinion_roll: np.ndarray
    contact_roll: tuple[float, float]


@dataclass(frozen=True)
class ToothPair(PairNodes):
    """Contact nodes that see the flanks through the `interpolation` of either one."""

    interpolation: tuple[FlankInterpolation, FlankInterpolation]


def rolls_at(pair: GearPair, xi: float, offsets: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Roll angles (rad, any shape) on pinion and wheel of the flank points at offsets (mm), with contact at `xi` (mm from T1)."""
    radii = (pair.pinion.base_radius, pair.wheel.base_radius)
    heights = (radii[0] - offsets, radii[1] + offsets)
    return tuple(
        roll_angle_at_height(radius, contact_roll, height)
        for radius, contact_roll, height in zip(radii, contact_roll_angles(pair, xi), heights)
    )


def facing_points(pair: GearPair, removal: tuple[Removal | None, Removal | None], xi: float, offsets: np.ndarray):
    """Flank points that face each other at offsets (mm, any shape): roll angles (rad) and distances from T1, T2 (mm) of both, gap (mm)."""
    rolls = rolls_at(pair, xi, offsets)
    gears, contact_rolls = (pair.pinion, pair.wheel), contact_roll_angles(pair, xi)
    arms = tuple(
        flank_point(gear.base_radius, roll, contact_roll)[0] for gear, roll, contact_roll in zip(gears, rolls, contact_rolls)
    )
    gap = pair.line_of_action_length - arms[1] - arms[0]
    for removed, roll in zip(removal, rolls):
        if removed is not None:
            gap = gap + removed(roll)
    return rolls, arms, gap


def tooth_pair(flanks: Flanks, grid: ContactGrid, index: int, xi: float) -> ToothPair | None:
    """The tooth pair whose theoretical contact lies at `xi` (mm from T1), or None where its window is empty."""
    offsets = node_offsets(flanks.pair, xi, grid)
    if not len(offsets):
        return None
    pinion, wheel = flanks.pair.pinion, flanks.pair.wheel
    roll_1, roll_2 = contact_roll_angles(flanks.pair, xi)
    _, (x_1, x_2), gap = facing_points(flanks.pair, flanks.removal, xi, quadrature_offsets(offsets))
    node_rolls = rolls_at(flanks.pair, xi, offsets)
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
