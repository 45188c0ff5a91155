"""The flank point at a height above the gear's centre (compiled, since every contact node of every position asks for several)."""

from __future__ import annotations

import math

import numpy as np
from numba import njit

NEWTON_STEPS = 60
# The step just taken squares what is left.
CLOSE = 1e-10


def roll_angle_at_height(base_radius: float, contact_roll_angle: float, height) -> np.ndarray:
    """Roll angle (rad) of the flank point at a height ``h`` (mm, any shape) above the gear's centre.

    ``nan`` where the involute has no such point: below ``base_radius cos(contact_roll_angle)``, where it starts, and
    above the height at which it turns away.
    """
    heights = np.asarray(height, dtype=float)
    return _roll_angles(base_radius, contact_roll_angle, heights.reshape(-1)).reshape(heights.shape)


@njit(cache=True)
def _roll_angles(base_radius, contact, heights):
    """Newton in ``s = v^2/2`` (arc length over base radius), in which ``dh/ds = rb cos(vc - v)``: h is convex in s below the
    contact point and concave above it, so steps from the contact point never pass the root."""
    lowest, turning, rolls = math.cos(contact), contact + 0.5 * math.pi, np.full(len(heights), np.nan)
    for point in range(len(heights)):
        target = heights[point] / base_radius
        if not lowest <= target < turning:
            continue
        half_square = 0.5 * contact**2
        for _ in range(NEWTON_STEPS):
            roll = math.sqrt(2.0 * half_square)
            slope = math.cos(contact - roll)
            residual = target - slope + roll * math.sin(contact - roll)
            half_square = max(half_square + residual / slope, 0.0)
            if abs(residual) <= CLOSE:
                break
        rolls[point] = math.sqrt(2.0 * half_square)
    return rolls
