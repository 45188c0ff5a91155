"""The outline of one tooth in its transverse section: rack-generated fillet and involute, in the tooth's body frame
(see involute.py).

The rounding of the rack's tip is an ellipse of semi-axes k rho along the pitch line and rho in depth, with rho =
rack_tip_radius and k = 1/cos(helix angle). Where its normal has the angle t from the depth direction and D = sqrt(1 +
(k^2 - 1) sin(t)^2), its point is (k^2 sin(t), cos(t)) rho/D from its centre and its radius of curvature k^2 rho/D^3. A
spur gear has k = D = 1.

Where the rack cuts deep, or its rounding protrudes beyond its flank, the fillet crosses the involute: what is below the
crossing is cut away. From a protruding rounding up, at the protuberance angle, a short straight flank goes back; the
fillet's parameter t goes on along it as length in modules.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, pi, sin, tan
from typing import TYPE_CHECKING

import numpy as np

from fenics_gears.errors import GeometryError

from .involute import canonical_point, involute_function

if TYPE_CHECKING:
    from .gear import Gear

ARC_LENGTH_SAMPLES = 401


@dataclass(frozen=True)
class ToothOutline:
    """Drive side of one tooth; the coast side is its mirror image about the centreline.

    fillet: (n, 2), mm, from the root circle to the form circle, evenly spaced along the curve. centreline_angle,
    space_angle: polar angles (rad) of the tooth's centreline and of the centre of the tooth space at the drive flank.
    """

    gear: Gear
    fillet: np.ndarray
    centreline_angle: float
    space_angle: float

    def involute(self, roll_angle) -> np.ndarray:
        """Drive-flank points (..., 2), mm, at roll angles (...) in rad."""
        return canonical_point(self.gear.base_radius, roll_angle)

    def coast(self, points) -> np.ndarray:
        """Mirror images (..., 2) about the tooth's centreline of points (..., 2)."""
        cosine = cos(2.0 * self.centreline_angle)
        sine = sin(2.0 * self.centreline_angle)
        return np.asarray(points) @ np.array([[cosine, sine], [sine, -cosine]])


def centreline_angle(gear: Gear) -> float:
    """Polar angle (rad) of the tooth's centreline in its body frame."""
    return -0.5 * pi - gear.tooth_half_angle_at_base


def centreline_mirror(gear: Gear, components: int = 2) -> np.ndarray:
    """Reflection (c, c) of x, y and perhaps z at the tooth's centreline in its body frame."""
    angle = centreline_angle(gear)
    axis = np.array([cos(angle), sin(angle)])
    mirror = np.eye(components)
    mirror[:2, :2] = 2.0 * np.outer(axis, axis) - np.eye(2)
    return mirror


def tip_corner(gear: Gear) -> np.ndarray:
    """Point (2,), mm, where the tip circle begins on the drive side, beyond the chamfer if there is one."""
    if not gear.tip_chamfer:
        return canonical_point(gear.base_radius, gear.tip_roll_angle)
    angle = centreline_angle(gear) + 0.5 * gear.tip_thickness / gear.tip_radius
    return gear.tip_radius * np.array([cos(angle), sin(angle)])


def tooth_outline(gear: Gear, fillet_points: int = 41) -> ToothOutline:
    """Outline of one tooth, mm; GeometryError for a gear without involute above its fillet, or overlapping fillets.

    >>> from fenics_gears import gear_pair, load_scene
    >>> pinion = gear_pair(load_scene("demos/lundvall2004.toml").gears).pinion
    >>> tooth_outline(pinion, 3).fillet.shape
    (3, 2)
    """
    if gear.tip_form_radius <= gear.form_radius:
        raise GeometryError(
            f"no involute: the fillet of the gear with {gear.tooth_count} teeth reaches up to radius"
            f" {abs(gear.form_radius):.6g} mm, its tip circle has {abs(gear.tip_radius):.6g} mm"
        )
    if not gear.internal and gear.rack_tip_centre[0] < 0.0:
        raise GeometryError(
            f"the fillets of neighbouring teeth overlap: the tip of the rack that cuts the gear with {gear.teeth} teeth"
            f" has room for a radius of {gear.largest_rack_tip_radius:.4g} mm, not of {gear.rack_tip_radius:.4g} mm"
        )
    centreline = centreline_angle(gear)
    return ToothOutline(
        gear=gear,
        fillet=fillet_point(gear, _even_parameters(gear, fillet_points)),
        centreline_angle=centreline,
        space_angle=centreline + 0.5 * gear.angular_pitch,
    )


def _even_parameters(gear: Gear, count: int) -> np.ndarray:
    """Parameters (count,) at which the fillet is evenly divided along its length, both ends exact."""
    fine = np.linspace(0.0, gear.fillet_end, ARC_LENGTH_SAMPLES)
    speed = fillet_speed(gear, fine)
    length = np.concatenate([[0.0], np.cumsum(0.5 * (speed[1:] + speed[:-1]) * np.diff(fine))])
    return np.interp(np.linspace(0.0, length[-1], count), length, fine)


def fillet_point(gear: Gear, parameter) -> np.ndarray:
    """Points (..., 2), mm, that the rounded tip of the rack cuts.

    parameter: (...), rad, angle of the rack rounding's normal from the tooth depth direction; 0 (root circle) to
    ``gear.fillet_end`` (form circle). The point is cut when that normal passes through the pitch point, ``l =
    rack_tip_radius/D + depth/cos(parameter)`` away (law of gearing; Litvin & Fuentes, Gear Geometry and Applied Theory,
    ch. 6).
    """
    if gear.internal:
        return _of_ring(gear, parameter)[0]
    angle, along = _on_rack(gear, parameter)
    distance = _distance_from_pitch_point(gear, angle) - along * np.tan(angle)
    in_space = np.stack([-distance * np.sin(angle), distance * np.cos(angle) - gear.reference_radius], axis=-1)
    return _turned(in_space, _body_angle(gear, angle, along))


def fillet_tangent(gear: Gear, parameter) -> np.ndarray:
    """Derivative (..., 2), mm/rad, of ``fillet_point`` by its parameter."""
    if gear.internal:
        return _of_ring(gear, parameter)[1]
    angle, along = _on_rack(gear, parameter)
    direction = np.stack([-np.cos(angle), -np.sin(angle)], axis=-1)
    return fillet_speed(gear, parameter)[..., None] * _turned(direction, _body_angle(gear, angle, along))


def fillet_speed(gear: Gear, parameter) -> np.ndarray:
    """Length (mm) of fillet per rad of its parameter: rolling on the rack's rounding plus sliding."""
    if gear.internal:
        return np.linalg.norm(fillet_tangent(gear, parameter), axis=-1)
    angle, along = _on_rack(gear, parameter)
    depth = gear.rack_tip_centre[1]
    excess = _excess(gear)
    flattening = _flattening(gear, angle)
    turning = depth / (gear.reference_radius * np.cos(angle) ** 2) - excess * np.cos(angle) / (
        gear.reference_radius * flattening**3
    )
    curvature_radius = gear.rack_stretch**2 * gear.rack_tip_radius / flattening**3
    speed = curvature_radius + _distance_from_pitch_point(gear, angle) * turning
    if not gear.protuberance:
        return speed
    distance = _distance_from_pitch_point(gear, angle) - along * np.tan(angle)
    on_flank = gear.module * (1.0 - distance / (gear.reference_radius * np.cos(angle)))
    return np.where(along > 0.0, on_flank, speed)


def _of_ring(gear: Gear, parameter) -> tuple[np.ndarray, np.ndarray]:
    """Points and slopes of an internal gear's fillet."""
    from .ring_fillet import body_points

    return body_points(gear, parameter)


def _on_rack(gear: Gear, parameter) -> tuple[np.ndarray, np.ndarray | float]:
    """Angle (rad) of the rack's normal at a fillet parameter, and length (mm) along a protuberance's straight flank."""
    angle = np.asarray(parameter, dtype=float)
    if not gear.protuberance:
        return angle, 0.0
    end = 0.5 * pi - gear.transverse_protuberance_angle
    return np.minimum(angle, end), gear.module * np.maximum(angle - end, 0.0)


def _distance_from_pitch_point(gear: Gear, angle):
    return gear.rack_tip_radius / _flattening(gear, angle) + gear.rack_tip_centre[1] / np.cos(angle)


def _excess(gear: Gear) -> float:
    """(k^2 - 1) rho, mm, zero for a circle."""
    return (gear.rack_stretch**2 - 1.0) * gear.rack_tip_radius


def _flattening(gear: Gear, angle):
    """D of the ellipse at an angle (rad, any shape) of its normal: 1 for a circle."""
    return np.sqrt(1.0 + (gear.rack_stretch**2 - 1.0) * np.sin(angle) ** 2)


def _body_angle(gear: Gear, angle, along=0.0):
    """Angle (rad) from the generating pose, the space over the rack's tooth, into the tooth's body frame while
    ``angle`` is being cut: the gear has rolled the rack's travel over its reference radius."""
    across, depth = gear.rack_tip_centre
    # Where the normal meets the pitch line: from the ellipse's centre it is aside of a circle's.
    aside = _excess(gear) * np.sin(angle) / _flattening(gear, angle)
    rolled = (across + aside - depth * np.tan(angle) + along / np.cos(angle)) / gear.reference_radius
    return 0.5 * gear.angular_pitch - gear.tooth_half_angle_at_base - rolled


def _turned(vectors, angle):
    sine = np.sin(angle)
    cosine = np.cos(angle)
    x = vectors[..., 0]
    y = vectors[..., 1]
    return np.stack([cosine * x - sine * y, sine * x + cosine * y], axis=-1)


def touching_end(gear: Gear) -> float:
    """Fillet parameter (rad) where the rounding passes into the rack's straight flank, which cuts the involute."""
    return 0.5 * pi - gear.pressure_angle


def crossing(gear: Gear) -> float:
    """Fillet parameter (rad) where the fillet of an undercut gear comes out of its involute, to the last digit.

    The fillet rises steadily: it is inside the tooth where its rack's normal is that of the flank, or at the base
    circle, and outside at its end.
    """

    def above_base_circle(parameter: float) -> bool:
        return float(np.hypot(*fillet_point(gear, parameter))) >= gear.base_radius

    last = _last(gear)
    inside = touching_end(gear)
    if not (gear.protuberance and above_base_circle(inside)):
        inside = halved(above_base_circle, 0.0, last)
    return halved(lambda parameter: _outside(gear, parameter) >= 0.0, inside, last)


def _last(gear: Gear) -> float:
    """Parameter at the end of what cuts the fillet: of the rounding, or where the protuberance is back at the flank."""
    if not gear.protuberance:
        return touching_end(gear)
    angle = gear.transverse_protuberance_angle
    flank = gear.pressure_angle
    end = 0.5 * pi - angle
    rounding = gear.rack_tip_radius
    flattening = float(_flattening(gear, end))
    across, depth = gear.rack_tip_centre
    beyond = (
        across
        + gear.rack_stretch**2 * rounding * cos(angle) / flattening
        - gear.rack_half_thickness(depth + rounding * sin(angle) / flattening)
    )
    length = beyond / (cos(angle) * tan(flank) - sin(angle)) / gear.module
    return end + length if length > 0.0 and fillet_speed(gear, end + 0.5 * length) > 0.0 else end


def _outside(gear: Gear, parameter: float) -> float:
    """Angle (rad) from the drive flank's involute out of the tooth to a point of the fillet above the base circle."""
    x, y = fillet_point(gear, parameter)
    roll = np.sqrt(max((x**2 + y**2) / gear.base_radius**2 - 1.0, 0.0))
    return float(np.arctan2(x, -y) + involute_function(roll))


def halved(reached, low: float, high: float) -> float:
    """The least number between two from which on `reached` is true, to the last digit; `high` where it never is."""
    while low < (middle := 0.5 * (low + high)) < high:
        low, high = (low, middle) if reached(middle) else (middle, high)
    return high


def rotation(angle: float, components: int = 2) -> np.ndarray:
    """Counter-clockwise rotation (2, 2) by an angle (rad); with three components (3, 3), about z."""
    turn = np.eye(components)
    turn[:2, :2] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
    return turn
