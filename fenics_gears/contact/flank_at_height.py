"""The flank point at a height above the gear's centre (compiled, since every contact node of every position asks for
several)."""

from __future__ import annotations

import math

import numpy as np
from numba import njit

NEWTON_STEPS = 60
# The step just taken squares what is left.
CLOSE = 1e-10
# Rises above the contact point, in base radii and parts of the roll angle squared, where a series begins near the root.
NEAR = 0.2
# A height may lie below the start of the involute by round-off.
ROUND_OFF = 4e-16


def flank_at_height(base_radius: float, contact_roll_angle: float, height) -> tuple[np.ndarray, np.ndarray]:
    """Roll angle (rad) and ``x`` (mm, as of `geometry.involute.flank_point`) of the flank point at a height ``h`` (mm,
    any shape).

    ``nan`` where the involute has no such point: below ``base_radius cos(contact_roll_angle)``, where it starts, and
    above the height at which it turns away.
    """
    heights = np.asarray(height, dtype=float)
    rolls, x = _points(base_radius, contact_roll_angle, heights.reshape(-1))
    return rolls.reshape(heights.shape), x.reshape(heights.shape)


def roll_angle_at_height(base_radius: float, contact_roll_angle: float, height) -> np.ndarray:
    """The roll angle (rad) alone."""
    return flank_at_height(base_radius, contact_roll_angle, height)[0]


@njit(cache=True)
def _points(base_radius, contact, heights):
    rolls = np.empty(len(heights))
    x = np.empty(len(heights))
    for point in range(len(heights)):
        rolls[point], x[point] = _point(base_radius, contact, heights[point])
    return rolls, x


@njit(cache=True)
def points_of_pairs(base_radius, sense, contact_rolls, lever_arms, offsets, ends):
    """Roll angles (n,), rad, and x (n,), mm, of the flank points at offsets (n,), mm, from the lines of action of many
    pairs.

    `ends` (P + 1,): where the points of each pair begin and end; `contact_rolls` (P,), rad, and `lever_arms` (P,), mm:
    of these lines; `sense` of the gear's side.
    """
    rolls = np.empty(len(offsets))
    x = np.empty(len(offsets))
    for pair in range(len(contact_rolls)):
        for point in range(ends[pair], ends[pair + 1]):
            height = lever_arms[pair] - sense * offsets[point]
            rolls[point], x[point] = _point(base_radius, contact_rolls[pair], height)
    return rolls, x


@njit(cache=True)
def _point(base_radius, contact, height):
    """Newton in ``s = v^2/2`` (arc length over base radius), in which ``dh/ds = rb cos(vc - v)``: h is convex in s
    below the contact point and concave above it, so steps from the contact point never pass the root. Near the
    contact point they begin so close to the root that they cannot miss it."""
    target = height / base_radius
    if not math.cos(contact) - ROUND_OFF <= target < contact + 0.5 * math.pi:
        return np.nan, np.nan
    half_square = 0.5 * contact**2
    rise = target - 1.0
    if abs(rise) < NEAR * contact**2:
        # dh/ds is 1 - (vc - v)^2/2 there, and vc - v nearly (sc - s)/vc.
        half_square += rise + rise**3 / (6.0 * contact**2)
    for _ in range(NEWTON_STEPS):
        roll = math.sqrt(2.0 * half_square)
        slope = math.cos(contact - roll)
        residual = target - slope + roll * math.sin(contact - roll)
        half_square = max(half_square + residual / slope, 0.0)
        if abs(residual) <= CLOSE:
            break
    roll = math.sqrt(2.0 * half_square)
    return roll, base_radius * (math.sin(contact - roll) + roll * math.cos(contact - roll))
