"""Clearance between a tip corner and the fillet of the mating gear, away from the line of action."""

from __future__ import annotations

from math import acos, atan, pi

import numpy as np

from fenics_gears.geometry.fillet import fillet_point
from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.involute import involute_function

PATH_POINTS = 1001
FILLET_POINTS = 1001


def fillet_clearance(gear: Gear, mate: Gear, centre_distance: float) -> float:
    """Least radial distance (mm) from the path of the mate's tip corner down to the gear's fillet; infinite where it
    never comes over the fillet, negative where it would cut into it. Of an undercut gear see
    `_clearance_along_circles`.

    Drive flanks in contact. Along the fillet the radius is a smooth function of the polar angle, so
    that sampling it costs an error of second order only.
    """
    if gear.undercut:
        return min(_clearance_along_circles(gear, mate, centre_distance, corner) for corner in _corners(mate))
    return min(_clearance_of_corner(gear, mate, centre_distance, corner) for corner in _corners(mate))


def _clearance_of_corner(gear: Gear, mate: Gear, centre_distance: float, corner: tuple[float, float]) -> float:
    at_contact = atan(mate.tip_roll_angle) - _operating_angle(gear, mate, centre_distance)
    radius, angle = _tip_corner_path(gear, mate, centre_distance, np.linspace(at_contact, 0.0, PATH_POINTS), corner)
    fillet = fillet_point(gear, np.linspace(gear.fillet_end, 0.0, FILLET_POINTS))
    fillet_radius = np.hypot(fillet[:, 0], fillet[:, 1])
    # From straight down, as that of the path.
    fillet_angle = np.arctan2(fillet[:, 1], fillet[:, 0]) + 0.5 * pi
    over_fillet = (angle >= fillet_angle[0]) & (angle <= fillet_angle[-1])
    if not over_fillet.any():
        return np.inf
    return float(np.min(radius[over_fillet] - np.interp(angle[over_fillet], fillet_angle, fillet_radius)))


def _corners(gear: Gear) -> list[tuple[float, float]]:
    """Radius (mm) of each corner of a tip's drive side, and the angle (rad) by which it lies behind the end of the
    involute: a chamfer has two."""
    if not gear.tip_chamfer:
        return [(gear.tip_radius, 0.0)]
    behind = (
        gear.tooth_half_angle_at_base
        - involute_function(gear.tip_roll_angle)
        - 0.5 * gear.tip_thickness / gear.tip_radius
    )
    return [(gear.tip_form_radius, 0.0), (gear.tip_radius, float(behind))]


def _clearance_along_circles(gear: Gear, mate: Gear, centre_distance: float, corner: tuple[float, float]) -> float:
    """Least arc (mm) about the gear's centre from its fillet and involute to the path of the mate's tip corner, from
    where this comes below the gear's tip.

    An undercut fillet has up to two points at a polar angle, but one at a radius.
    """
    above = acos((centre_distance**2 + corner[0] ** 2 - gear.tip_radius**2) / (2.0 * centre_distance * corner[0]))
    radius, angle = _tip_corner_path(
        gear, mate, centre_distance, np.linspace(above + corner[1], corner[1], PATH_POINTS), corner
    )
    fillet = fillet_point(gear, np.linspace(0.0, gear.fillet_end, FILLET_POINTS))
    involute = -involute_function(gear.roll_angle(np.maximum(radius, gear.form_radius)))
    cut = np.interp(radius, np.hypot(fillet[:, 0], fillet[:, 1]), np.arctan2(fillet[:, 0], -fillet[:, 1]))
    arcs = radius * (angle - np.where(radius < gear.form_radius, cut, involute))
    return float(np.min(arcs, where=radius > gear.root_radius, initial=np.inf))


def _operating_angle(gear: Gear, mate: Gear, centre_distance: float) -> float:
    return float(np.arccos((gear.base_radius + mate.base_radius) / centre_distance))


def _tip_corner_path(
    gear: Gear, mate: Gear, centre_distance: float, mate_angle: np.ndarray, corner: tuple[float, float]
) -> tuple[np.ndarray, np.ndarray]:
    """Radius (mm) and polar angle from straight down (rad) of a corner of the mate's tip in the gear's tooth frame.

    ``mate_angle`` (n,), rad: of the end of the mate's involute from the line of centres, seen from the mate's centre.
    Where that end is on the line of action it lies on the gear's involute.
    """
    operating = _operating_angle(gear, mate, centre_distance)
    contact_roll = np.tan(operating) * (1.0 + mate.base_radius / gear.base_radius)
    contact_roll -= mate.base_radius * mate.tip_roll_angle / gear.base_radius
    at_contact = atan(mate.tip_roll_angle) - operating

    def seen(radius, turned):
        return radius * np.sin(turned), centre_distance - radius * np.cos(turned)

    across, along = seen(corner[0], mate_angle - corner[1])
    gear_angle = np.arctan2(*seen(mate.tip_form_radius, at_contact)) - np.arctan2(across, along)
    gear_rotation = mate.teeth / gear.teeth * (at_contact - mate_angle)
    return np.hypot(across, along), -involute_function(contact_roll) + gear_angle - gear_rotation
