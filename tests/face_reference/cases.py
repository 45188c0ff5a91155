"""The pairs of the reference."""

from __future__ import annotations

from math import atan, cos, radians, tan

from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.gear_data import Material
from fenics_gears.geometry.pair import GearPair

NORMAL_MODULE, NORMAL_PRESSURE_ANGLE, TEETH, FACE_WIDTH = 3.0, radians(20.0), (24, 32), 7.5
STEEL = Material(206000.0, 0.3)


def reference_pair(helix_angle: float) -> GearPair:
    """The pair in its transverse section, on its nominal centre distance; helix angle in rad."""
    module, angle = NORMAL_MODULE / cos(helix_angle), atan(tan(NORMAL_PRESSURE_ANGLE) / cos(helix_angle))
    gears = []
    for teeth in TEETH:
        radius = 0.5 * teeth * module
        root = radius - 1.25 * NORMAL_MODULE
        gears.append(Gear(teeth, module, angle, 0.0, radius + NORMAL_MODULE, root, 0.5 * root, 0.38 * NORMAL_MODULE))
    return GearPair(*gears, 0.5 * sum(TEETH) * module, FACE_WIDTH)


def base_slope(helix_angle: float) -> float:
    """tau = tan(beta_b) of a right-hand pinion."""
    return tan(helix_angle) * cos(atan(tan(NORMAL_PRESSURE_ANGLE) / cos(helix_angle)))
