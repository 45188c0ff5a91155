"""The outline of one tooth in its transverse section: rack-generated fillet and involute, in the tooth's body frame (see involute.py).

The rounding of the rack's tip is an ellipse in the transverse section of a helical gear, of semi-axes k rho along the pitch line and rho in depth, with
rho = rack_tip_radius and k = 1/cos(helix angle). Where its normal has the angle t from the depth direction and D = sqrt(1 + (k^2 - 1) sin(t)^2), its point
is (k^2 sin(t), cos(t)) rho/D from its centre and its radius of curvature k^2 rho/D^3. A spur gear has k = D = 1, a circle.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, pi, sin

import numpy as np

from fenics_gears.errors import GeometryError
from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.involute import canonical_point

ARC_LENGTH_SAMPLES = 401


@dataclass(frozen=True)
class ToothOutline:
    """Drive side of one tooth; the coast side is its mirror image about the centreline.

    fillet: (n, 2), mm, from the root circle (first point) to the form circle (last point), evenly spaced along the curve.
    centreline_angle, space_angle: polar angles (rad) of the tooth's centreline and of the centre of the tooth space
    beside the drive flank; the root circle runs from the fillet's first point to the space angle.
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
        cosine, sine = cos(2.0 * self.centreline_angle), sin(2.0 * self.centreline_angle)
        return np.asarray(points) @ np.array([[cosine, sine], [sine, -cosine]])


def centreline_angle(gear: Gear) -> float:
    """Polar angle (rad) of the tooth's centreline in its body frame."""
    return -0.5 * pi - gear.tooth_half_angle_at_base


def fillet_end(gear: Gear) -> float:
    """Fillet parameter (rad) at the form circle; 0 is the root circle."""
    return 0.5 * pi - gear.pressure_angle


def fillet_point(gear: Gear, parameter) -> np.ndarray:
    """Points (..., 2), mm, that the rounded tip of the rack cuts.

    parameter: (...), rad, angle of the rack rounding's normal from the tooth depth direction; 0 (root circle) to
    ``fillet_end`` (form circle). The point is cut when that normal passes through the pitch point, which is
    ``l = rack_tip_radius/D + depth/cos(parameter)`` away (law of gearing; Litvin & Fuentes, Gear Geometry and Applied
    Theory, ch. 6).
    """
    angle = np.asarray(parameter, dtype=float)
    distance = _distance_from_pitch_point(gear, angle)
    in_space = np.stack([-distance * np.sin(angle), distance * np.cos(angle) - gear.reference_radius], axis=-1)
    return _turned(in_space, _body_angle(gear, angle))


def fillet_tangent(gear: Gear, parameter) -> np.ndarray:
    """Derivative (..., 2), mm/rad, of ``fillet_point`` by its parameter."""
    angle = np.asarray(parameter, dtype=float)
    direction = np.stack([-np.cos(angle), -np.sin(angle)], axis=-1)
    return fillet_speed(gear, angle)[..., None] * _turned(direction, _body_angle(gear, angle))


def fillet_speed(gear: Gear, parameter) -> np.ndarray:
    """Length (mm) of fillet per rad of its parameter: rolling on the rack's rounding plus sliding."""
    angle = np.asarray(parameter, dtype=float)
    depth, excess, flattening = gear.rack_tip_centre[1], _excess(gear), _flattening(gear, angle)
    turning = depth / (gear.reference_radius * np.cos(angle) ** 2) - excess * np.cos(angle) / (gear.reference_radius * flattening**3)
    curvature_radius = gear.rack_stretch**2 * gear.rack_tip_radius / flattening**3
    return curvature_radius + _distance_from_pitch_point(gear, angle) * turning


def tooth_outline(gear: Gear, fillet_points: int = 41) -> ToothOutline:
    """Outline of one tooth.

    Raises GeometryError when the gear is undercut, has no involute above its fillet, or when neighbouring fillets would
    overlap because the rack's tip has no room for its rounding.
    """
    if gear.tip_radius <= gear.form_radius:
        raise GeometryError(
            f"no involute: the tip circle of the gear with {gear.teeth} teeth, radius {gear.tip_radius:.6g} mm, must lie "
            f"above its fillet, which reaches up to {gear.form_radius:.6g} mm"
        )
    if gear.rack_tip_centre[0] < 0.0:
        raise GeometryError(
            f"the fillets of neighbouring teeth overlap: the tip of the rack that cuts the gear with {gear.teeth} teeth "
            f"has room for a radius of {gear.largest_rack_tip_radius:.4g} mm, not of {gear.rack_tip_radius:.4g} mm"
        )
    centreline = centreline_angle(gear)
    return ToothOutline(
        gear=gear,
        fillet=fillet_point(gear, _even_parameters(gear, fillet_points)),
        centreline_angle=centreline,
        space_angle=centreline + 0.5 * gear.angular_pitch,
    )


def _distance_from_pitch_point(gear: Gear, angle):
    """Distance (mm) along the normal from the pitch point to the point being cut."""
    return gear.rack_tip_radius / _flattening(gear, angle) + gear.rack_tip_centre[1] / np.cos(angle)


def _excess(gear: Gear) -> float:
    """(k^2 - 1) rho, mm, zero for a circle."""
    return (gear.rack_stretch**2 - 1.0) * gear.rack_tip_radius


def _flattening(gear: Gear, angle):
    """D of the ellipse at an angle (rad, any shape) of its normal: 1 for a circle."""
    return np.sqrt(1.0 + (gear.rack_stretch**2 - 1.0) * np.sin(angle) ** 2)


def _body_angle(gear: Gear, angle):
    """Angle (rad) from the generating pose into the tooth's body frame while ``angle`` is being cut.

    The space lies over the rack's tooth at first; the gear has then rolled the rack's travel over its reference radius.
    """
    across, depth = gear.rack_tip_centre
    # Where the normal meets the pitch line: from the ellipse's centre it is aside of a circle's.
    aside = _excess(gear) * np.sin(angle) / _flattening(gear, angle)
    rolled = (across + aside - depth * np.tan(angle)) / gear.reference_radius
    return 0.5 * gear.angular_pitch - gear.tooth_half_angle_at_base - rolled


def _turned(vectors, angle):
    """Vectors (..., 2) turned counter-clockwise by angles (...)."""
    sine, cosine = np.sin(angle), np.cos(angle)
    x, y = vectors[..., 0], vectors[..., 1]
    return np.stack([cosine * x - sine * y, sine * x + cosine * y], axis=-1)


def _even_parameters(gear: Gear, count: int) -> np.ndarray:
    """Parameters (count,) at which the fillet is evenly divided along its length, both ends exact."""
    fine = np.linspace(0.0, fillet_end(gear), ARC_LENGTH_SAMPLES)
    speed = fillet_speed(gear, fine)
    length = np.concatenate([[0.0], np.cumsum(0.5 * (speed[1:] + speed[:-1]) * np.diff(fine))])
    return np.interp(np.linspace(0.0, length[-1], count), length, fine)
