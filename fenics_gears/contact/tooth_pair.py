"""One tooth pair at one position: its contact nodes, their gaps, and their interpolation of both flanks."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from fenics_gears.contact.flank_at_height import flank_at_height
from fenics_gears.contact.interpolation import INTERPOLATIONS, Averages, FlankInterpolation, Points, hat_integrals
from fenics_gears.contact.window import ContactGrid, coast_roll_angles, contact_roll_angles, flank_ends, node_offsets
from fenics_gears.elasticity.compliance import FlankCompliance
from fenics_gears.geometry.pair import GearPair

Removal = Callable[[np.ndarray], np.ndarray]


@dataclass(frozen=True)
class Flanks:
    """The two gears as contact sees them: geometry, compliance, and material removed from either flank.

    `removal`: functions of the roll angle (rad) giving mm along the flank normal, or None for a true involute.
    """

    pair: GearPair
    compliance: tuple[FlankCompliance, FlankCompliance]
    removal: tuple[Removal | None, Removal | None] = (None, None)

    def removal_at(self, place: Place) -> tuple[Removal | None, Removal | None]:
        """Material removed from the flanks at a place: modifications are made on the drive flanks."""
        return self.removal if place.flank == DRIVE else (None, None)


DRIVE, COAST = 0, 1
SENSES = (-1.0, 1.0)  # of offsets: towards the pinion's centre, away from the wheel's


@dataclass(frozen=True)
class Line:
    """A line of action: its distances `lever_arms` (mm) from both centres, and `length` (mm) between the feet of the
    centres on it."""

    lever_arms: tuple[float, float]
    length: float


@dataclass(frozen=True)
class Place:
    """Where a pair of flanks stands: `index` of the pinion's tooth, `flank` DRIVE or COAST, `contact_rolls` (rad) of
    either gear.

    Coast flanks are seen in the mirror, the line of centres being the mirror's line: `axes` (2, 2) are the line of
    action's direction and the one across it in space, `turn` the sign of rotations. `line`: another line than the
    theoretical line of action, of a tip edge (`contact.corner`); its direction is in `axes`, and `contact_rolls` are
    measured from it. `slice`, `height` (mm): of the face, and where its middle is along the axes; both 0 in the plane.
    """

    index: int
    flank: int
    contact_rolls: tuple[float, float]
    axes: tuple[tuple[float, float], tuple[float, float]] = ((1.0, 0.0), (0.0, 1.0))
    turn: float = 1.0
    line: Line | None = None
    slice: int = 0
    height: float = 0.0

    def line_in(self, pair: GearPair) -> Line:
        """The line of action of the flanks: the theoretical one but for tip edges."""
        return self.line or Line((pair.pinion.base_radius, pair.wheel.base_radius), pair.line_of_action_length)

    @property
    def teeth(self) -> tuple[int, int]:
        """Index of the pinion's and of the wheel's tooth, by the drive pairs they belong to."""
        return self.index, self.index - self.flank

    def ahead(self, gear: int) -> int:
        """Pitches by which the pinion's (0) or the wheel's (1) tooth stands counter-clockwise of that of drive pair
        0."""
        # A later pair index means a tooth ahead on the pinion, and behind on the wheel.
        return self.teeth[gear] if gear == 0 else -self.teeth[gear]


def drive_place(pair: GearPair, index: int, xi: float) -> Place:
    """The drive flanks of tooth pair `index`, with contact at `xi` (mm from T1)."""
    return Place(index, DRIVE, contact_roll_angles(pair, xi))


def coast_place(pair: GearPair, index: int, xi: float) -> Place:
    """The coast flank of the pinion's tooth in pair `index`, whose drive flank touches at `xi` (mm), and the one that
    faces it."""
    cosine, sine = np.cos(2.0 * pair.operating_pressure_angle), np.sin(2.0 * pair.operating_pressure_angle)
    return Place(index, COAST, coast_roll_angles(pair, xi), ((-cosine, -sine), (-sine, cosine)), -1.0)


@dataclass(frozen=True)
class PairNodes:
    """Contact nodes (n,) of the flanks at `place`.

    `offsets` (mm, from the line of action), `lengths` (mm of flank a node stands for), `gap` [9] (mm, positive when
    open), `pinion_lever_arm` and `wheel_lever_arm` (mm, of friction: distance of the point of contact from T1 and T2
    along the line of action), `pinion_roll` (rad).
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


def flank_points(
    pair: GearPair, place: Place, offsets: np.ndarray
) -> tuple[tuple[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]:
    """Roll angles (rad) and x (mm, of `flank_at_height`), of pinion and wheel, at offsets (mm, any shape) from the line
    of a place."""
    (roll_1, roll_2), (arm_1, arm_2) = place.contact_rolls, place.line_in(pair).lever_arms
    rolls_1, x_1 = flank_at_height(pair.pinion.base_radius, roll_1, arm_1 - offsets)
    rolls_2, x_2 = flank_at_height(pair.wheel.base_radius, roll_2, arm_2 + offsets)
    return (rolls_1, rolls_2), (x_1, x_2)


def facing_points(pair: GearPair, removal: tuple[Removal | None, Removal | None], place: Place, offsets: np.ndarray):
    """Flank points that face each other along the line of action at offsets (mm, any shape).

    Their roll angles (rad) and distances from T1, T2 (mm), each of pinion and wheel, and the gap (mm).
    """
    rolls, distances = flank_points(pair, place, offsets)
    gap = pair.line_of_action_length - distances[1] - distances[0]
    for removed, roll in zip(removal, rolls):
        if removed is not None:
            gap = gap + removed(roll)
    return rolls, distances, gap


def tooth_pair(flanks: Flanks, grid: ContactGrid, place: Place) -> ToothPair | None:
    """The contact nodes of the flanks at a place, or None where their window is empty."""
    offsets = node_offsets(flank_ends(flanks.pair, place.contact_rolls), grid)
    if not len(offsets):
        return None
    at = INTERPOLATIONS[grid.interpolation].places(offsets)
    _, distances, gap = facing_points(flanks.pair, flanks.removal_at(place), place, at)
    return nodes_on_flanks(flanks, grid, place, offsets, distances, gap)


def seen_gap(view: Averages | Points, offsets: np.ndarray, gap: np.ndarray) -> np.ndarray:
    """Gaps (n,), mm, of contact nodes at `offsets` (n,), mm, from gaps at the points that they see.

    Averages of flanks that are nowhere one inside the other may not say that they are: they would press without load.
    """
    return np.maximum(view.seen(offsets, gap), min(0.0, float(gap.min())))


def nodes_on_flanks(
    flanks: Flanks,
    grid: ContactGrid,
    place: Place,
    offsets: np.ndarray,
    distances: tuple[np.ndarray, np.ndarray],
    gap: np.ndarray,
) -> ToothPair:
    """Contact nodes at `offsets` (n,), mm, that see the flanks by the grid's interpolation.

    `distances`: of pinion's and wheel's surface from their foot on the place's line, mm, and `gap`, mm, where the
    interpolation wants them.
    """
    view, line = INTERPOLATIONS[grid.interpolation], place.line_in(flanks.pair)
    rolls = flank_points(flanks.pair, place, offsets)[0]
    # Flanks that deform to touch meet midway between where they stand undeformed. Friction acts there on both, so that
    # action and reaction leave no torque.
    meeting = 0.5 * (view.seen(offsets, distances[0] - distances[1]) + line.length)
    interpolation = interpolations(flanks, grid, place, offsets, rolls)
    return ToothPair(
        place=place,
        offsets=offsets,
        lengths=hat_integrals(offsets),
        gap=seen_gap(view, offsets, gap),
        pinion_lever_arm=meeting,
        wheel_lever_arm=line.length - meeting,
        pinion_roll=rolls[0],
        interpolation=interpolation,
    )


def interpolations(
    flanks: Flanks, grid: ContactGrid, place: Place, offsets: np.ndarray, rolls: tuple[np.ndarray, np.ndarray]
) -> tuple[FlankInterpolation, FlankInterpolation]:
    """How contact nodes at `offsets` (n,), mm, see the nodes of either flank; `rolls` (rad): their roll angles on
    pinion and wheel."""
    view, line, gears = (
        INTERPOLATIONS[grid.interpolation],
        place.line_in(flanks.pair),
        (flanks.pair.pinion, flanks.pair.wheel),
    )
    first, second = (
        view.of_flank(
            # Offsets from the line at the gear's own base radius.
            offsets + sense * (arm - gear.base_radius), own, gear.base_radius, roll, sense,
            flank.rolls_of(place.ahead(number)), flank.element_order,
        )
        for number, (gear, own, roll, arm, sense, flank) in enumerate(
            zip(gears, rolls, place.contact_rolls, line.lever_arms, SENSES, flanks.compliance)
        )
    )  # fmt: skip
    return first, second
