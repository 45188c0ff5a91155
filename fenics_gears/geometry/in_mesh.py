"""Where two gears in mesh stand, in the frame of the line of action and in that of pictures: the line of centres
upright, the pinion above."""

import numpy as np

from .outline import rotation
from .pair import GearPair

MIRROR = np.array([-1.0, 1.0])


def standing(pair: GearPair, gear: int, phase: float) -> tuple[np.ndarray, np.ndarray]:
    """Centre (2,), mm, and angles (teeth,), rad, of a gear's sectors in the frame of the line of action, at a phase of
    the mesh cycle. Sector 0 has the tooth of pair 0, which reached the start of contact last."""
    side = pair.sides[gear]
    own = side.gear
    contact = pair.path_start + phase * pair.base_pitch
    centre = np.array([side.foot, side.sense * own.base_radius - pair.base_radii[0]])
    first = 0.5 * np.pi * (1 - side.sense) + side.arm(contact) / own.base_radius
    return centre, first + own.angular_pitch * np.arange(own.tooth_count)


def upright(pair: GearPair, points: np.ndarray, coast: bool = False) -> np.ndarray:
    """Points or vectors (..., 2) in the frame of the line of action as the picture has them, the line of centres
    upright. coast: of the coast flanks' line of action, its mirror image at the line of centres."""
    shown = np.asarray(points) @ rotation(-pair.operating_pressure_angle).T
    return shown * MIRROR if coast else shown


def extent_of(pair: GearPair) -> tuple[tuple[float, float], tuple[float, float]]:
    """Ends (mm) of both gears across and along the line of centres, the pinion's centre being 0."""
    if pair.wheel.internal:
        outer = -pair.wheel.bore_radius
        return (-outer, outer), (-pair.centre_distance - outer, -pair.centre_distance + outer)
    tips = pair.pinion.tip_radius, pair.wheel.tip_radius
    return (-max(tips), max(tips)), (-pair.centre_distance - tips[1], tips[0])


def common_depth(pair: GearPair) -> float:
    """How far (mm) the tip circles reach into one another."""
    return pair.pinion.tip_radius + pair.wheel.tip_radius - pair.centre_distance
