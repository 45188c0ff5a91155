"""Area and polar second moment of a gear's cross-section, between bore and outline; reliefs and errors are left out.

By Green's theorem over the boundary, A = 1/2 of the integral of r^2 dtheta, and I_p = 1/4 of that of r^4 dtheta. Along
an involute of roll angle v these are rb^2 v^2 dv and rb^4 v^2 (1 + v^2) dv; the fillet goes by Gauss quadrature.
"""

from dataclasses import dataclass
from math import atan2, pi, remainder

import numpy as np

from .gear import Gear
from .involute import canonical_point, involute_function
from .outline import centreline_angle, fillet_point, fillet_tangent, tip_corner

# The fillet is smooth: from 20 points on nothing but round-off changes.
QUADRATURE_POINTS = 40


@dataclass(frozen=True)
class CrossSection:
    """`area`, mm^2, and `polar_moment`, mm^4, about the gear's centre."""

    area: float
    polar_moment: float


def gear_section(gear: Gear) -> CrossSection:
    """The cross-section of a gear from bore to tip; a web counts by its share of the face width."""
    tip = gear.tip_roll_angle
    form = gear.form_roll_angle
    half_tip = gear.tooth_half_angle_at_base - float(involute_function(tip))
    chamfer = 0.0
    if gear.tip_chamfer:
        half_tip = 0.5 * gear.tip_thickness / gear.tip_radius
        chamfer = _straight(tip_corner(gear), canonical_point(gear.base_radius, tip))
    half_tooth = (
        _arc(gear.tip_radius, half_tip)
        + chamfer
        + _involute(gear.base_radius, tip)
        - _involute(gear.base_radius, form)
        + _fillet(gear)
    )
    area, moment = gear.sign * (2 * gear.teeth * half_tooth - _arc(gear.bore_radius, 2.0 * pi))
    if (web := gear.web) is not None:
        area, moment = np.array([area, moment]) - (1.0 - web.share) * (
            _arc(web.rim_radius, 2.0 * pi) - _arc(web.hub_radius, 2.0 * pi)
        )
    return CrossSection(float(area), float(moment))


def cells_section(points: np.ndarray, cells: np.ndarray) -> CrossSection:
    """The cross-section that straight-sided cells (m, 3 or 4), corners counter-clockwise, of points (n, 2), mm,
    cover."""
    corner = points[cells]
    ahead = np.roll(corner, -1, axis=1)
    turned = corner[..., 0] * ahead[..., 1] - corner[..., 1] * ahead[..., 0]
    squares = ((corner + ahead) ** 2 - corner * ahead).sum(axis=-1)
    return CrossSection(float(0.5 * turned.sum()), float((turned * squares).sum() / 12.0))


def _arc(radius: float, angle: float) -> np.ndarray:
    """Both integrals over an arc about the centre."""
    return np.array([0.5 * radius**2, 0.25 * radius**4]) * angle


def _straight(start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """Of the triangle with the centre."""
    area = 0.5 * (start[0] * end[1] - start[1] * end[0])
    return area * np.array([1.0, (start @ start + start @ end + end @ end) / 6.0])


def _involute(base_radius: float, roll_angle: float) -> np.ndarray:
    """From the base circle to a roll angle."""
    return np.array(
        [
            0.5 * base_radius**2 * roll_angle**3 / 3.0,
            0.25 * base_radius**4 * (roll_angle**3 / 3.0 + roll_angle**5 / 5.0),
        ]
    )


def _fillet(gear: Gear) -> np.ndarray:
    """From the form circle down the fillet and along the root circle to the middle of the tooth space."""
    nodes, weights = np.polynomial.legendre.leggauss(QUADRATURE_POINTS)
    half = 0.5 * gear.fillet_end
    points = fillet_point(gear, half * (1.0 + nodes))
    tangents = fillet_tangent(gear, half * (1.0 + nodes))
    turning = half * weights * (points[:, 1] * tangents[:, 0] - points[:, 0] * tangents[:, 1])
    along = np.array([0.5 * turning.sum(), 0.25 * turning @ np.einsum("nd,nd->n", points, points)])
    x, y = fillet_point(gear, 0.0)
    at_root = remainder(atan2(gear.sign * y, gear.sign * x) - centreline_angle(gear), 2.0 * pi)
    return along + _arc(gear.root_radius, 0.5 * gear.angular_pitch - at_root)
