"""The flank point at a height above the gear's centre (compiled, since every contact node of every position asks for several)."""

from __future__ import annotations

import math

from numba import vectorize

NEWTON_STEPS = 60
# The step just taken squares what is left.
CLOSE = 1e-10


@vectorize(cache=True)
def roll_angle_at_height(base_radius, contact_roll_angle, height):
    """Roll angle (rad) of the flank point at a height ``h`` (mm) above the gear's centre; arrays broadcast.

    ``nan`` where the involute has no such point: below ``base_radius cos(contact_roll_angle)``, where it starts, and
    above the height at which it turns away. Newton in ``s = v^2/2`` (arc length over base radius), in which
    ``dh/ds = rb cos(vc - v)``: h is convex in s below the contact point and concave above it, so steps
    from the contact point never pass the root.
    """
    target = height / base_radius
    if not math.cos(contact_roll_angle) <= target < contact_roll_angle + 0.5 * math.pi:
        return math.nan
    half_square = 0.5 * contact_roll_angle**2
    for _ in range(NEWTON_STEPS):
        roll = math.sqrt(2.0 * half_square)
        turned = contact_roll_angle - roll
        slope = math.cos(turned)
        residual = target - slope + roll * math.sin(turned)
        half_square = max(half_square + residual / slope, 0.0)
        if abs(residual) <= CLOSE:
            break
    return math.sqrt(2.0 * half_square)
