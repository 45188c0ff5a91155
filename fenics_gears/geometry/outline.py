"""The outline of one tooth in its transverse section: rack-generated fillet and involute, in the tooth's body frame
(see involute.py)."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, pi, sin

import numpy as np

from fenics_gears.errors import GeometryError
from fenics_gears.geometry.fillet import fillet_point, fillet_speed
from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.involute import canonical_point

ARC_LENGTH_SAMPLES = 401


@dataclass(frozen=True)
class ToothOutline:
    """Drive side of one tooth; the coast side is its mirror image about the centreline.

    fillet: (n, 2), mm, from the root circle (first point) to the form circle (last point), evenly spaced along the
    curve. centreline_angle, space_angle: polar angles (rad) of the tooth's centreline and of the centre of the tooth
    space beside the drive flank; the root circle runs from the fillet's first point to the space angle.
    """

    gear: Gear
    fillet: np.ndarray
    centreline_angle: float
    space_angle: float

    def involute(self, roll_angle) -> np.ndarray:
        """Drive-flank points (..., 2), mm, at roll angles (...) in rad."""
        return canonical_point(self.gear.base_radius, roll_angle)

    @property
    def tip_corner(self) -> np.ndarray:
        """Point (2,), mm, of the drive side where the tip circle begins, beyond the chamfer if there is one."""
        return tip_corner(self.gear)

    def coast(self, points) -> np.ndarray:
        """Mirror images (..., 2) about the tooth's centreline of points (..., 2)."""
        cosine, sine = cos(2.0 * self.centreline_angle), sin(2.0 * self.centreline_angle)
        return np.asarray(points) @ np.array([[cosine, sine], [sine, -cosine]])


def centreline_angle(gear: Gear) -> float:
    """Polar angle (rad) of the tooth's centreline in its body frame."""
    return -0.5 * pi - gear.tooth_half_angle_at_base


def tip_corner(gear: Gear) -> np.ndarray:
    """Point (2,), mm, where the tip circle begins on the drive side: at the end of the involute, or beyond the straight
    chamfer there."""
    if not gear.tip_chamfer:
        return canonical_point(gear.base_radius, gear.tip_roll_angle)
    angle = centreline_angle(gear) + 0.5 * gear.tip_thickness / gear.tip_radius
    return gear.tip_radius * np.array([cos(angle), sin(angle)])


def tooth_outline(gear: Gear, fillet_points: int = 41) -> ToothOutline:
    """Outline of one tooth.

    Raises GeometryError when the gear has no involute above its fillet, or when neighbouring fillets would
    overlap because the rack's tip has no room for its rounding.
    """
    if gear.tip_form_radius <= gear.form_radius:
        raise GeometryError(
            f"no involute: the tip circle of the gear with {gear.teeth} teeth, radius {gear.tip_radius:.6g} mm, must"
            f" lie above its fillet, which reaches up to {gear.form_radius:.6g} mm"
        )
    if gear.rack_tip_centre[0] < 0.0:
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
