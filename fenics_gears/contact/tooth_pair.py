"""One tooth pair at one position: its contact nodes, gaps, sliding, and how they see either gear."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from fenics_gears.contact.interpolation import INTERPOLATIONS, FlankInterpolation, hat_integrals
from fenics_gears.contact.window import ContactGrid, coast_roll_angles, contact_roll_angles, node_offsets
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


DRIVE, COAST = 0, 1


@dataclass(frozen=True)
class Line:
    """A line along which flanks are seen: its distances `lever_arms` (mm) from both centres, `length` (mm) between the centres' feet on it."""

    lever_arms: tuple[float, float]
    length: float


@dataclass(frozen=True)
class Place:
    """Where a pair of flanks stands: `index` of the pinion's tooth, `flank` DRIVE or COAST, `contact_rolls` (rad) of either gear.

    Coast flanks are seen in the mirror, the line of centres being the mirror's line: `axes` (2, 2) are the line of action's
    direction and the one across it in space, `turn` the sign of rotations. `line`: where the flanks are seen along another line
    than that of action, see `contact.corner`; its direction is in `axes`, and `contact_rolls` are measured from it.
    """

    index: int
    flank: int
    contact_rolls: tuple[float, float]
    axes: tuple[tuple[float, float], tuple[float, float]] = ((1.0, 0.0), (0.0, 1.0))
    turn: float = 1.0
    line: Line | None = None

    def line_in(self, pair: GearPair) -> Line:
        """The line along which the flanks are seen, the line of action unless said otherwise."""
        return self.line or Line((pair.pinion.base_radius, pair.wheel.base_radius), pair.line_of_action_length)

    @property
    def teeth(self) -> tuple[int, int]:
        """Index of the pinion's and of the wheel's tooth, by the drive pairs they belong to."""
        return self.index, self.index - self.flank

    def ahead(self, gear: int) -> int:
        """Pitches by which the pinion's (0) or the wheel's (1) tooth stands counter-clockwise of that of drive pair 0."""
        # A later pair index means a tooth ahead on the pinion, and behind on the wheel.
        return self.teeth[gear] if gear == 0 else -self.teeth[gear]


def drive_place(pair: GearPair, index: int, xi: float) -> Place:
    """The drive flanks of tooth pair `index`, with contact at `xi` (mm from T1)."""
    return Place(index, DRIVE, contact_roll_angles(pair, xi))


def coast_place(pair: GearPair, index: int, xi: float) -> Place:
    """The coast flank of the pinion's tooth in pair `index`, whose drive flank touches at `xi` (mm), and the one that faces it."""
    cosine, sine = np.cos(2.0 * pair.operating_pressure_angle), np.sin(2.0 * pair.operating_pressure_angle)
    return Place(index, COAST, coast_roll_angles(pair, xi), ((-cosine, -sine), (-sine, cosine)), -1.0)


@dataclass(frozen=True)
class PairNodes:
    """Contact nodes (n,) of the flanks at `place`.

    `offsets` (mm, from the line of action), `lengths` (mm of flank a node stands for), `gap` [9] (mm, positive when
    open), `pinion_lever_arm` and `wheel_lever_arm` (mm: distance of the point of contact from the tangent points T1 and T2 along the line of
    action), `pinion_roll` (rad).
    """

    place: Place
    offsets: np.ndarray
    lengths: np.ndarray
    gap: np.ndarray
    pinion_lever_arm: np.ndarray
    wheel_lever_arm: np.ndarray
    pinion_roll: np.ndarray


@dataclass(frozen=True)
class ToothPair(PairNodes):
    """Contact nodes that see the flanks through the `interpolation` of either one."""

    interpolation: tuple[FlankInterpolation, FlankInterpolation]


def rolls_at(pair: GearPair, contact_rolls: tuple[float, float], offsets: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Roll angles (rad, any shape) on pinion and wheel of the flank points at offsets (mm), given those on the line of action."""
    radii = (pair.pinion.base_radius, pair.wheel.base_radius)
    heights = (radii[0] - offsets, radii[1] + offsets)
    return tuple(
        roll_angle_at_height(radius, contact_roll, height)
        for radius, contact_roll, height in zip(radii, contact_rolls, heights)
    )


def facing_points(
    pair: GearPair, removal: tuple[Removal | None, Removal | None], contact_rolls: tuple[float, float], offsets: np.ndarray
):
    """Flank points that face each other at offsets (mm, any shape): roll angles (rad) and distances from T1, T2 (mm) of both, gap (mm)."""
    rolls, gears = rolls_at(pair, contact_rolls, offsets), (pair.pinion, pair.wheel)
    arms = tuple(
        flank_point(gear.base_radius, roll, contact_roll)[0] for gear, roll, contact_roll in zip(gears, rolls, contact_rolls)
    )
    gap = pair.line_of_action_length - arms[1] - arms[0]
    for removed, roll in zip(removal, rolls):
        if removed is not None:
            gap = gap + removed(roll)
    return rolls, arms, gap


def tooth_pair(flanks: Flanks, grid: ContactGrid, place: Place) -> ToothPair | None:
    """The contact nodes of the flanks at a place, or None where their window is empty."""
    offsets = node_offsets(flanks.pair, place.contact_rolls, grid)
    if not len(offsets):
        return None
    pinion, wheel, view = flanks.pair.pinion, flanks.pair.wheel, INTERPOLATIONS[grid.interpolation]
    # Modifications are made on the drive flanks.
    removal = flanks.removal if place.flank == DRIVE else (None, None)
    _, (x_1, x_2), gap = facing_points(flanks.pair, removal, place.contact_rolls, view.places(offsets))
    node_rolls = rolls_at(flanks.pair, place.contact_rolls, offsets)
    # Flanks that deform to touch meet midway between where they stand undeformed. Both forces of friction act there, so that
    # action and reaction leave no couple.
    meeting = 0.5 * (view.seen(offsets, x_1 - x_2) + flanks.pair.line_of_action_length)
    interpolation = tuple(
        view.of_flank(
            offsets, rolls, gear.base_radius, contact_roll, sense, flank.rolls_of(place.ahead(number)), flank.element_order
        )
        for number, (gear, rolls, contact_roll, sense, flank) in enumerate(
            zip((pinion, wheel), node_rolls, place.contact_rolls, (-1.0, 1.0), flanks.compliance)
        )
    )
    return ToothPair(
        place=place,
        offsets=offsets,
        lengths=hat_integrals(offsets),
        gap=view.seen(offsets, gap),
        pinion_lever_arm=meeting,
        wheel_lever_arm=flanks.pair.line_of_action_length - meeting,
        pinion_roll=node_rolls[0],
        interpolation=interpolation,
    )
