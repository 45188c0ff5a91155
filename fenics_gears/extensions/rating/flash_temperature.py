"""Flash temperature of the flanks by Blok's formula, as in ISO/TS 6336-20 and AGMA 925: along the path of contact, for
any force of the tooth pair.

A line contact of half-width b_H moves over both flanks with the speeds v_1 and v_2 of the contact along them. Friction
heats it by ``31.62 K mu w / sqrt(b_H) |v_1 - v_2| / (B_M1 sqrt(v_1) + B_M2 sqrt(v_2))``, K = 0.80 for a semi-elliptic
pressure; w in N/mm, b_H in mm, v in m/s, B_M in N/(mm s^0.5 K).
"""

from math import cos, pi

import numpy as np

from fenics_gears import GearPair, Material

SEMI_ELLIPTIC = 0.80
# Thermal contact coefficient of case-hardened steel, N/(mm s^0.5 K) (AGMA 925).
STEEL = 13.6
_UNITS = 1000.0**0.5


def flash_temperature(
    pair: GearPair, materials: tuple[Material, Material], positions, line_force, friction: float, pinion_speed: float
) -> np.ndarray:
    """Rise (n,), K, of a tooth pair at positions (n,) on the path of contact (mm from T1), under normal forces per face
    width (n,), N/mm; `pinion_speed`: 1/min. Spur pairs, and helical ones in the transverse section."""
    first = np.asarray(positions, dtype=float)
    second = pair.line_of_action_length - first
    line_force = np.asarray(line_force, dtype=float)
    turning = 2.0 * pi * pinion_speed / 60.0
    speeds = 1e-3 * turning * first, 1e-3 * turning * pair.pinion.teeth / pair.wheel.teeth * second
    compliance = sum((1.0 - each.poissons_ratio**2) / each.youngs_modulus for each in materials)
    # Hertz: b_H^2 = 4 w rho / (pi E*), 1/E* the sum of (1 - nu^2)/E.
    half_width = np.sqrt(4.0 * np.maximum(line_force, 0.0) * first * second / (first + second) * compliance / pi)
    spread = STEEL * (np.sqrt(speeds[0]) + np.sqrt(speeds[1]))
    heat = SEMI_ELLIPTIC * _UNITS * friction * line_force * np.abs(speeds[0] - speeds[1]) / spread
    return np.divide(heat, np.sqrt(half_width), out=np.zeros_like(heat), where=half_width > 0.0)


def standard_share(pair: GearPair, positions) -> np.ndarray:
    """Load share X_Gamma (n,) of unmodified spur teeth in ISO/TS 6336-20: a third at the ends of the path, two thirds
    where single contact begins and ends, one in it."""
    start = pair.path_start
    end = pair.path_end
    lowest = end - pair.base_pitch
    highest = start + pair.base_pitch
    positions = np.asarray(positions, dtype=float)
    third = 1.0 / 3.0
    approach = third + third * (positions - start) / (lowest - start)
    recess = third + third * (end - positions) / (end - highest)
    return np.where(positions < lowest, approach, np.where(positions > highest, recess, 1.0))


def transverse_line_force(pair: GearPair, tangential_force: float) -> float:
    """Normal force per face width (N/mm) in the transverse section of a tangential force (N) at the reference
    circle."""
    return tangential_force / (cos(pair.pinion.pressure_angle) * pair.face_width)
