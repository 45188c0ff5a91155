"""Coefficient of friction of lubricated flanks by published formulas, from load, speed, radii, oil and roughness at the
pitch point or along the path."""

from math import cos, log10, pi, sin

import numpy as np

from .pair import GearPair

# ISO/TR 14179-2: below this line load (N/mm) the coefficient rises no more.
LEAST_LINE_LOAD = 150.0
# Points along the path of contact, at which none is the pitch point, where Benedict and Kelley's formula has no value.
POINTS = 400
_MICROINCH = 0.0254
# Pitch line speeds (m/s) of the gears that the law was fitted to (ISO/TR 13989-2, whose coefficient is the same law
# with other factors). Below, friction is higher by an unknown amount; a speed above counts as the largest.
PITCH_LINE_SPEEDS = (1.0, 50.0)


class OutOfRange(ValueError):
    """A formula is asked for what it is not for."""


def schlenk(pair: GearPair, normal_force: float, pinion_speed: float, viscosity: float, roughness: float) -> float:
    """Mean coefficient of friction after Schlenk (ISO/TR 14179-2): 0.048 (F_bt/b / (v_sum rho))^0.2 eta^-0.05 Ra^0.25,
    of mineral oil (X_L = 1).

    `normal_force`: N along the line of action; `pinion_speed`: 1/min; `viscosity`: dynamic, mPa s, at the oil's
    temperature; `roughness`: mean Ra of both flanks, um. Raises OutOfRange below the slowest gears that it was fitted
    to.
    """
    pitch_radius = pair.pinion.base_radius / cos(pair.operating_pressure_angle)
    speed = 1e-3 * 2.0 * pi * pinion_speed / 60.0 * pitch_radius
    slowest, fastest = PITCH_LINE_SPEEDS
    if speed < slowest:
        raise OutOfRange(
            f"was fitted to gears from {slowest:g} to {fastest:g} m/s at the pitch line (ISO/TR 13989-2, of the same"
            f" law); this pair has {speed:.3g} m/s, where friction is higher than it says. Give a coefficient, such as"
            " 0.1."
        )
    line_load = max(normal_force / pair.face_width, LEAST_LINE_LOAD)
    first = pair.pitch_point
    second = pair.pitch_point_to_wheel_tangent
    radius = first * second / (first + second)
    # Both flanks' speeds along themselves at the pitch point.
    sum_of_speeds = 2.0 * min(speed, fastest) * sin(pair.operating_pressure_angle)
    return 0.048 * (line_load / (sum_of_speeds * radius)) ** 0.2 * viscosity**-0.05 * roughness**0.25


def benedict_kelley(
    pair: GearPair, normal_force: float, pinion_speed: float, viscosity: float, roughness: float
) -> float:
    """Mean over the path of contact of the coefficient after Benedict and Kelley (1961): 0.0127 (50 / (50 - S))
    log10(29.66e3 w / (eta v_s v_r^2)).

    Arguments as in `schlenk`; w in N/mm, sliding and rolling speed in m/s, S the roughness in microinches, of at most
    30. Raises OutOfRange where the logarithm is not positive: beyond the mixed lubrication of the tests.
    """
    path = pair.path_start + (np.arange(POINTS) + 0.5) / POINTS * (pair.path_end - pair.path_start)
    turning = 1e-3 * 2.0 * pi * pinion_speed / 60.0
    first = turning * path
    second = turning * pair.pinion.teeth / pair.wheel.teeth * (pair.line_of_action_length - path)
    rough = min(roughness / _MICROINCH, 30.0)
    values = 29.66e3 * normal_force / pair.face_width / (viscosity * np.abs(first - second) * (first + second) ** 2)
    if not values.min() > 1.0:
        where = int(values.argmin())
        raise OutOfRange(
            "is of discs in mixed lubrication (Benedict and Kelley, ASLE Transactions 4, 1961; AGMA 925): it has"
            f" positive values where 29660 w/(eta v_s v_r^2) is more than 1. Here that is {values[where]:.3g}, with w ="
            f" {normal_force / pair.face_width:.3g} N/mm, eta = {viscosity:.3g} mPa s, v_s ="
            f" {abs(first - second)[where]:.3g} m/s and v_r = {(first + second)[where]:.3g} m/s: the oil film carries"
            " the load. Give a coefficient, such as 0.02."
        )
    return 0.0127 * 50.0 / (50.0 - rough) * float(np.mean([log10(each) for each in values]))


FORMULAS = {"Schlenk": schlenk, "Benedict and Kelley": benedict_kelley}
