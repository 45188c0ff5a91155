"""Clearance between a tip corner and the fillet of the mating gear, away from the line of action."""

from __future__ import annotations

from math import atan, pi

import numpy as np

from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.involute import involute_function
from fenics_gears.geometry.outline import fillet_end, fillet_point

PATH_POINTS = 1001
FILLET_POINTS = 1001


def fillet_clearance(gear: Gear, mate: Gear, centre_distance: float) -> float:
    """Least radial distance (mm) from the path of the mate's tip corner down to the gear's fillet; infinite where it
    never comes over the fillet, negative where it would cut into it.

    Drive flanks in contact, undercut-free gear. Along the fillet the radius is a smooth function of the polar angle, so
    that sampling it costs an error of second order only.
    """
    radius, angle = _tip_corner_path(gear, mate, centre_distance)
    fillet = fillet_point(gear, np.linspace(fillet_end(gear), 0.0, FILLET_POINTS))
    fillet_radius = np.hypot(fillet[:, 0], fillet[:, 1])
    # From straight down, as that of the path.
    fillet_angle = np.arctan2(fillet[:, 1], fillet[:, 0]) + 0.5 * pi
    over_fillet = (angle >= fillet_angle[0]) & (angle <= fillet_angle[-1])
    if not over_fillet.any():
        return np.inf
    return float(np.min(radius[over_fillet] - np.interp(angle[over_fillet], fillet_angle, fillet_radius)))


def _tip_corner_path(gear: Gear, mate: Gear, centre_distance: float) -> tuple[np.ndarray, np.ndarray]:
    """Radius (mm) and polar angle from straight down (rad) of the mate's tip corner in the gear's tooth frame.

    From its contact on the line of action, where it lies on the involute, to the line of centres. ``mate_angle`` and
    ``gear_angle`` are those of the corner from the line of centres, seen from either centre.
    """
    operating = np.arccos((gear.base_radius + mate.base_radius) / centre_distance)
    contact_roll = np.tan(operating) * (1.0 + mate.base_radius / gear.base_radius)
    contact_roll -= mate.base_radius * mate.tip_roll_angle / gear.base_radius
    mate_angle = np.linspace(atan(mate.tip_roll_angle) - operating, 0.0, PATH_POINTS)
    across = mate.tip_radius * np.sin(mate_angle)
    along = centre_distance - mate.tip_radius * np.cos(mate_angle)
    gear_angle = np.arctan2(across, along)
    gear_rotation = mate.teeth / gear.teeth * (mate_angle[0] - mate_angle)
    angle = -involute_function(contact_roll) + (gear_angle[0] - gear_angle) - gear_rotation
    return np.hypot(across, along), angle
