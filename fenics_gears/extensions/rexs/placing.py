"""Where the gears of a REXS file are: centre distances and directions, by the positions of gears and shafts or by the
angles of stages.

The scene of a train is seen from the end to which the rotation of its first gear points, so that this gear turns
counter-clockwise; the file's w axis points upwards.
"""

from __future__ import annotations

from math import atan2, cos, degrees, isclose, pi, remainder, sin

import numpy as np

from .shaft_parts import POSITION, located
from .stage import GearParts, Stage
from .transmission import axis_of
from .values import Value, ValueProblem, computed, numbers_of, place, together, value_of

ANGLE = "rotating_angle_around_neg_u_axis"
DEGREE = pi / 180.0
# Directions that a program rounded before it wrote them in two places differ by less, rad.
SAME_DIRECTION = 0.01
# An offset along the axes that is a smaller part of the face width is rounding.
ROUNDED_OFFSET = 1e-3
AXIS = np.array([1.0, 0.0, 0.0])
UPWARDS = np.array([0.0, 0.0, 1.0])


def distance_of_positions(stage: Stage) -> Value | None:
    """The distance (mm) of both axes; None where the file does not say where they are."""
    across = _across(stage)
    if across is None:
        return None
    why = f"no center_distance; from {_origin(stage)}"
    return computed(float(np.linalg.norm(across)), 1.0, "mm", why)


def turning_axis(stage: Stage) -> np.ndarray:
    """The unit vector of the pinion's rotation; along its axis where the file does not say how it turns."""
    return _axis_of_parts(stage.pinion) * (stage.sense or 1.0)


def offset_of_wheel(stage: Stage, width: float) -> Value | None:
    """How far (mm) the middle of the wheel is to the right of the pinion's, the end from which this turns
    counter-clockwise; None where the file does not say it, or where this is rounding over the face width (mm)."""
    middles = [located(part.gear) for part in stage.named.values()]
    if stage.sense is None or None in middles or middles[0][1] != middles[1][1]:
        return None
    number = float((middles[1][0] - middles[0][0]) @ turning_axis(stage))
    return computed(number, 1.0, "mm", _origin(stage)) if abs(number) > ROUNDED_OFFSET * width else None


def direction(stage: Stage, turning: np.ndarray) -> Value | None:
    """Of the wheel's centre from the pinion's in a train whose first gear turns about a vector; None where the file
    does not say it. Raises ValueProblem where it says two things."""
    by_place = _across(stage)
    by_angle = _by_angle(stage)
    found = [(_seen(each, turning), origin) for each, origin in (
        (by_place, _origin(stage)), (by_angle, f"{ANGLE} of component {stage.stage.id}")
    ) if each is not None and np.any(each)]  # fmt: skip
    if not found:
        return None
    if len(found) == 2 and abs(remainder(found[0][0] - found[1][0], 2.0 * pi)) > SAME_DIRECTION:
        raise ValueProblem(
            f"{place(stage.stage, ANGLE)} has the wheel at {degrees(found[1][0]):.4g} deg, but {found[0][1]} at"
            f" {degrees(found[0][0]):.4g} deg. Allowed: the same direction."
        )
    angle, origin = found[0]
    return computed(0.0 if isclose(angle, 0.0, abs_tol=1e-12) else angle, DEGREE, "deg", origin)


def _seen(across: np.ndarray, turning: np.ndarray) -> float:
    """The angle (rad) of a vector, counter-clockwise about the axis of turning, 0 to the right."""
    upwards = UPWARDS if abs(turning @ UPWARDS) < 0.9 else np.array([0.0, 1.0, 0.0])
    right = np.cross(upwards, turning)
    return atan2(float(across @ np.cross(turning, right)), float(across @ right))


def _across(stage: Stage) -> np.ndarray | None:
    """The vector (mm) from the pinion's axis to the wheel's, across them; None where the places are not given from the
    same part, or the axes are not parallel."""
    found = [_placed(part) for part in stage.named.values()]
    if any(each is None for each in found) or found[0][1] != found[1][1]:
        return None
    axes = [_axis_of_parts(part) for part in stage.named.values()]
    if abs(axes[0] @ axes[1]) < 1.0 - 1e-6:
        return None
    between = found[1][0] - found[0][0]
    return between - (between @ axes[0]) * axes[0]


def _placed(part: GearParts) -> tuple[np.ndarray, str] | None:
    """Where a gear or its shaft is."""
    return next((found for each in (part.gear, *part.shafts) if (found := located(each)) is not None), None)


def _axis_of_parts(part: GearParts) -> np.ndarray:
    return next((axis for each in (part.gear, *part.shafts) if (axis := axis_of(each)) is not None), AXIS)


def _origin(stage: Stage) -> str:
    holders = (
        next((each for each in (part.gear, *part.shafts) if POSITION in each.attributes), part.gear)
        for part in stage.named.values()
    )
    return together(f"{POSITION} of component {each.id}" for each in holders)


def _by_angle(stage: Stage) -> np.ndarray | None:
    """A vector from the pinion to the wheel by the stage's angle, which counts from the w axis of the first gear about
    its axis turned round."""
    if ANGLE not in stage.stage.attributes:
        return None
    angle = value_of(stage.stage, ANGLE, "deg").number
    parts = sorted(stage.named.values(), key=lambda part: part.gear.id != stage.first)
    axis = _axis_of_parts(parts[0])
    upwards = _upwards(parts[0])
    vector = cos(angle) * upwards + sin(angle) * np.cross(upwards, axis)
    return vector if parts[0] is stage.pinion else -vector


def _upwards(part: GearParts) -> np.ndarray:
    """The w axis of a gear's shaft, or of the gear itself, which programs turn to where its teeth are."""
    holders = (each for each in (*part.shafts, part.gear) if "w_axis_vector" in each.attributes)
    for each in holders:
        vector = np.array(numbers_of(each, "w_axis_vector"))
        length = float(np.linalg.norm(vector)) if vector.shape == (3,) else 0.0
        if length > 0.0:
            return vector / length
    return UPWARDS
