"""The involute of a circle, its points named by their roll angle.

Body frame of one tooth: gear centre at the origin, the tooth points downwards, the drive flank's involute starts at
``(0, -base_radius)`` and has its material on the -x side. Turned counter-clockwise by ``contact_roll_angle``, the flank
point of that roll angle lies on the line of action ``y = -base_radius`` with its outward normal along +x.
"""

import numpy as np

NEWTON_STEPS = 60


def involute_function(roll_angle):
    """Polar angle ``v - atan(v)`` swept by the involute up to a roll angle; rad, any shape.

    Of the pressure angle ``a = atan(v)`` it is the textbook's ``inv a = tan a - a``, at 20 degrees:

    >>> round(float(involute_function(np.tan(np.radians(20.0)))), 6)
    0.014904
    """
    return roll_angle - np.arctan(roll_angle)


def sum_of_profile_shifts(teeth: int, operating_angle: float, transverse_angle: float, normal_angle: float) -> float:
    """Sum of both profile shifts, in normal modules, that leaves no backlash at an operating pressure angle, by
    ISO 21771: (z1 + z2) (inv(alpha_wt) - inv(alpha_t)) / (2 tan(alpha_n)). `teeth`: of both gears together; angles in
    rad.

    >>> round(sum_of_profile_shifts(40, *np.radians([22.0, 20.0, 20.0])), 4)
    0.283
    """
    swept = involute_function(np.tan(operating_angle)) - involute_function(np.tan(transverse_angle))
    return float(0.5 * teeth * swept / np.tan(normal_angle))


def centre_distance_of_shifts(
    teeth: int, shifts: float, module: float, normal_angle: float, helix_angle: float
) -> float:
    """Centre distance (mm) at which both profile shifts leave no backlash (ISO 21771). `teeth`, `shifts`: sums of both
    gears; normal module, mm; angles in rad.

    >>> round(centre_distance_of_shifts(40, 0.283, 2.0, np.radians(20.0), 0.0), 2)
    40.54
    """
    transverse = np.arctan(np.tan(normal_angle) / np.cos(helix_angle))
    operating = inverse_involute(involute_function(np.tan(transverse)) + 2.0 * shifts * np.tan(normal_angle) / teeth)
    bases = 0.5 * module * teeth * np.cos(transverse) / np.cos(helix_angle)
    return float(abs(bases) * np.hypot(1.0, operating))


def inverse_involute(polar_angle: float) -> float:
    """Roll angle (rad) whose involute function is ``polar_angle`` (rad, not negative).

    Newton on ``v - atan v``, whose slope is ``v^2/(1 + v^2)``, descends to the root from a start above it.

    >>> round(inverse_involute(involute_function(0.5)), 12)
    0.5
    """
    if polar_angle <= 0.0:
        return 0.0
    roll = max(np.cbrt(3.0 * polar_angle) * 1.1, polar_angle)
    for _ in range(NEWTON_STEPS):
        step = (involute_function(roll) - polar_angle) * (1.0 + roll**2) / roll**2
        roll -= step
        if abs(step) <= 1e-15 * roll:
            break
    return float(roll)


def canonical_point(base_radius: float, roll_angle) -> np.ndarray:
    """Drive-flank points in the tooth's body frame: (..., 2), mm, for roll angles (...) in rad."""
    roll = np.asarray(roll_angle, dtype=float)
    sine = np.sin(roll)
    cosine = np.cos(roll)
    return base_radius * np.stack([roll * cosine - sine, -(cosine + roll * sine)], axis=-1)


def canonical_normal(roll_angle) -> np.ndarray:
    """Outward unit normals of the drive flank in the tooth's body frame: (..., 2) for roll angles (...) in rad."""
    roll = np.asarray(roll_angle, dtype=float)
    return np.stack([np.cos(roll), -np.sin(roll)], axis=-1)


def flank_point(base_radius: float, roll_angle, contact_roll_angle):
    """Where a flank point lies while another one is on the line of action: ``(x, h)``, mm.

    ``x`` along the line of action from its tangent point, ``h`` from the gear's centre towards the line of action,
    where ``h = base_radius``. Roll angles in rad; arrays broadcast. Source: model.md, section 1 ([A.1] of the paper).

    The point in contact is ``rb v`` from the tangent point:

    >>> [round(float(length), 12) for length in flank_point(30.0, 0.4, 0.4)]
    [12.0, 30.0]
    """
    turned = contact_roll_angle - roll_angle
    x = base_radius * (np.sin(turned) + roll_angle * np.cos(turned))
    h = base_radius * (np.cos(turned) - roll_angle * np.sin(turned))
    return x, h


def arc_length(base_radius: float, roll_angle):
    """Length of the involute from the base circle to a roll angle: ``rb v^2/2``, mm.

    >>> round(float(roll_angle_at_arc_length(30.0, arc_length(30.0, 0.4))), 12)
    0.4
    """
    return 0.5 * base_radius * np.square(roll_angle)


def roll_angle_at_arc_length(base_radius: float, length):
    """Roll angle (rad) at a length (mm, not negative) along the involute from the base circle."""
    return np.sqrt(2.0 * np.asarray(length, dtype=float) / base_radius)
