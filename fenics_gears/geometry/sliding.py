"""Sliding of the flanks along the path of contact, from the rigid pair's nominal motion (ISO 21771, Niemann/Winter).

At xi (mm, any shape) from T1 the flanks' radii of curvature are rho1 = xi and rho2 = T1T2 - xi. Their points move
across the line of action with omega1 rho1 and omega2 rho2.
"""

import numpy as np

from .pair import GearPair

# Start of contact, LPSTC, pitch point, HPSTC (of the pinion), end of contact: ISO 21771 where the pinion drives.
CONTACT_POINTS = ("A", "B", "C", "D", "E")


def contact_points(pair: GearPair) -> np.ndarray:
    """Positions (5,), mm from T1, of the CONTACT_POINTS."""
    return np.array([pair.path_start, pair.lpstc, pair.pitch_point, pair.hpstc, pair.path_end])


def sliding_per_rotation(pair: GearPair, position):
    """Sliding speed over the pinion's angular speed, mm: v_g / omega1 = rho1 - rho2 z1/z2. It is of the pinion's flank
    over the wheel's, positive towards the pinion's tip: negative before the pitch point."""
    return position - pair.rotation_ratio * (pair.line_of_action_length - position)


def specific_sliding(pair: GearPair, position) -> tuple[np.ndarray, np.ndarray]:
    """Sliding speed over the speed of the flank's own point across the line of action, of pinion and wheel.

    zeta1 = 1 - rho2 z1/(rho1 z2), zeta2 = 1 - rho1 z2/(rho2 z1): negative in a dedendum; minus infinity at a gear's
    base circle.
    """
    position = np.asarray(position, dtype=float)
    across = pair.rotation_ratio * (pair.line_of_action_length - position)
    with np.errstate(divide="ignore"):
        return 1.0 - across / position, 1.0 - position / across


def sliding_speed(pair: GearPair, position, mesh_frequency: float):
    """Sliding speed v_g, mm/s, at a mesh frequency (Hz), signed as `sliding_per_rotation`."""
    return sliding_per_rotation(pair, position) * mesh_frequency * pair.pinion.angular_pitch
