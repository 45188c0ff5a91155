"""Tooth thickness as drawings give it: base tangent length, dimension over balls, normal thickness; each way between
them and the profile shift, in normal modules.

Angles in rad, lengths in mm. All measure the half angle psi_b of a tooth at the base circle (DIN 3960, ISO 21771): W_k
= cos(beta_b) [(k - 1) p_bt + d_b psi_b]. For the centre of a ball between two teeth inv(alpha_K) = D_M/(d_b
cos(beta_b)) + psi_b - pi/z.
"""

from math import acos, atan, cos, hypot, pi, sqrt, tan

from .gear import Gear
from .involute import inverse_involute, involute_function


def base_helix_angle(gear: Gear) -> float:
    """Helix angle at the base cylinder: tan(beta_b) = tan(beta) cos(alpha_t).

    >>> from fenics_gears import gear_pair, load_scene
    >>> base_helix_angle(gear_pair(load_scene("demos/lundvall2004.toml").gears).pinion)
    0.0
    """
    return atan(tan(gear.helix_angle) * cos(gear.pressure_angle))


def shift_of_half_angle(gear: Gear, half_angle: float) -> float:
    """The profile shift at which a tooth has that half angle at the base circle."""
    involute = tan(gear.pressure_angle) - gear.pressure_angle
    return 0.5 * (gear.teeth * (half_angle - involute) - 0.5 * pi) / tan(gear.normal_pressure_angle)


def normal_thickness(gear: Gear) -> float:
    """Normal thickness s_n = m_n (pi/2 + 2 x tan(alpha_n)) at the reference cylinder."""
    return gear.normal_module * (
        0.5 * pi + 2.0 * gear.profile_shift * gear.rack_stretch * tan(gear.normal_pressure_angle)
    )


def shift_of_normal_thickness(gear: Gear, thickness: float) -> float:
    """The profile shift with that normal thickness."""
    return 0.5 * (thickness / gear.normal_module - 0.5 * pi) / tan(gear.normal_pressure_angle)


def base_tangent_length(gear: Gear, teeth: int) -> float:
    """Base tangent length W_k over that many teeth."""
    return cos(base_helix_angle(gear)) * (
        (teeth - 1) * gear.base_pitch + 2.0 * gear.base_radius * gear.tooth_half_angle_at_base
    )


def shift_of_base_tangent_length(gear: Gear, length: float, teeth: int) -> float:
    """The profile shift with that base tangent length."""
    return shift_of_half_angle(
        gear, 0.5 * (length / cos(base_helix_angle(gear)) - (teeth - 1) * gear.base_pitch) / gear.base_radius
    )


def spanned_teeth(gear: Gear) -> int:
    """Teeth over which a caliper touches the flanks nearest to the shifted reference circle: k of ISO 21771."""
    shift = gear.profile_shift * gear.rack_stretch
    involute = tan(gear.pressure_angle) - gear.pressure_angle
    roll = gear.roll_angle(_middle_radius(gear)) / cos(base_helix_angle(gear)) ** 2
    spanned = roll - involute - 2.0 * shift * tan(gear.normal_pressure_angle) / gear.teeth
    return max(2, round(float(gear.teeth / pi * spanned + 0.5)))


def tangent_contact_radius(gear: Gear, length: float) -> float:
    """Radius at which a caliper with that base tangent length touches the flanks."""
    return hypot(gear.base_radius, 0.5 * length * cos(base_helix_angle(gear)))


def ball_centre(gear: Gear, ball_diameter: float) -> float:
    """Radius of the centre of a ball between two teeth; the base radius where it is too small to touch both flanks."""
    swept = _ball_angle(gear, ball_diameter) + gear.tooth_half_angle_at_base - pi / gear.teeth
    return float(gear.radius(inverse_involute(swept)))


def ball_contact_radius(gear: Gear, ball_diameter: float) -> float:
    """Radius at which a ball between two teeth touches the flanks; the base radius where it touches below."""
    roll = sqrt((ball_centre(gear, ball_diameter) / gear.base_radius) ** 2 - 1.0)
    return float(gear.radius(max(0.0, roll - 0.5 * ball_diameter * cos(base_helix_angle(gear)) / gear.base_radius)))


def dimension_over_balls(gear: Gear, ball_diameter: float) -> float:
    """Dimension M_dK over two balls, as opposite as the number of teeth lets them be."""
    return 2.0 * ball_centre(gear, ball_diameter) * _opposite(gear) + ball_diameter


def shift_of_dimension_over_balls(gear: Gear, dimension: float, ball_diameter: float) -> float | None:
    """The profile shift with that dimension over balls; None where their centres would lie within the base circle."""
    centre = 0.5 * (dimension - ball_diameter) / _opposite(gear)
    if centre <= gear.base_radius:
        return None
    swept = float(involute_function(tan(acos(gear.base_radius / centre))))
    return shift_of_half_angle(gear, swept - _ball_angle(gear, ball_diameter) + pi / gear.teeth)


def ball_diameter(gear: Gear) -> float:
    """Diameter of a ball that touches the flanks near the shifted reference circle, rounded to 0.05 mm."""
    roll = float(gear.roll_angle(_middle_radius(gear)))
    centre = tan(roll + pi / gear.teeth - gear.tooth_half_angle_at_base)
    return max(1, round(40.0 * gear.base_radius * (centre - roll) * cos(base_helix_angle(gear)))) / 20.0


def _ball_angle(gear: Gear, ball_diameter: float) -> float:
    return ball_diameter / (2.0 * gear.base_radius * cos(base_helix_angle(gear)))


def _middle_radius(gear: Gear) -> float:
    """Radius, without sign, of the shifted reference circle, in the middle of the tooth, or of the base circle if that
    is larger."""
    return max(gear.sign * (gear.reference_radius + gear.profile_shift * gear.module), abs(gear.base_radius))


def _opposite(gear: Gear) -> float:
    """Distance of two balls over twice the radius of their centres: less than 1 with an odd number of teeth."""
    return 1.0 if gear.teeth % 2 == 0 else cos(0.5 * pi / gear.teeth)
