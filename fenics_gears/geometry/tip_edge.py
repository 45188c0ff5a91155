"""The rounded edge between a tooth's flank and its tip circle, in the tooth's body frame (see involute.py)."""

from dataclasses import dataclass

import numpy as np

from fenics_gears.errors import GeometryError

from .gear import Gear
from .involute import canonical_normal, canonical_point
from .outline import halved, tip_corner


@dataclass(frozen=True)
class TipEdge:
    """An arc of `radius` (mm) tangent to the involute and to the tip circle, or its chamfer; radius 0 is the sharp
    edge.

    `centre` (2,), mm; `flank_roll` (rad): where the arc leaves the involute; `flank_normal` and `tip_normal` (2,):
    outward unit normals at its ends.
    """

    radius: float
    centre: np.ndarray
    flank_roll: float
    flank_normal: np.ndarray
    tip_normal: np.ndarray

    def points(self, shares) -> np.ndarray:
        """Points (..., 2), mm, at shares (...) of the arc's angle, 0 on the flank and 1 on the tip circle."""
        start = np.angle(complex(*self.flank_normal))
        turn = np.angle(complex(*self.tip_normal) / complex(*self.flank_normal))
        angles = start + np.asarray(shares, dtype=float) * turn
        return self.centre + self.radius * np.stack([np.cos(angles), np.sin(angles)], axis=-1)


def tip_edge(gear: Gear, radius: float) -> TipEdge:
    """The tip edge of the drive flank; GeometryError for a radius that leaves no tip or flank.

    The curve parallel to an involute is an involute of the same base circle: the arc's centre, `radius` inside flank
    and tip circle, is at rb^2 + (rb v - radius)^2 = (ra - radius)^2.
    """
    if gear.tip_chamfer and radius >= 0.0:
        return _chamfered(gear, radius)
    largest = 0.5 * gear.tip_thickness
    if not 0.0 <= radius <= largest:
        raise GeometryError(
            f"tip edge radius {radius:.4g} mm of the gear with {gear.teeth} teeth: it must lie between 0 and half the"
            f" tooth's thickness at the tip, {largest:.4g} mm; change corner_contact.edge_radius"
        )
    base = gear.base_radius
    inner = gear.tip_radius - radius
    roll = (radius + np.sqrt(max(inner**2 - base**2, 0.0))) / base if radius else gear.tip_roll_angle
    if inner <= base or roll <= gear.form_roll_angle:
        raise GeometryError(
            f"tip edge radius {radius:.4g} mm of the gear with {gear.teeth} teeth leaves no involute below it; lower"
            " corner_contact.edge_radius"
        )
    normal = canonical_normal(roll)
    centre = canonical_point(base, roll) - radius * normal
    return TipEdge(radius, centre, float(roll), normal, centre / np.linalg.norm(centre))


def _chamfered(gear: Gear, radius: float) -> TipEdge:
    base = gear.base_radius
    foot = canonical_point(gear.base_radius, gear.tip_roll_angle)
    end = tip_corner(gear)
    along = (end - foot) / np.linalg.norm(end - foot)
    outward = np.array([-along[1], along[0]])

    def centre(roll: float) -> np.ndarray:
        return canonical_point(base, roll) - radius * canonical_normal(roll)

    roll = gear.tip_roll_angle
    if radius:
        roll = halved(lambda at: (centre(at) - foot) @ outward >= -radius, gear.form_roll_angle, roll)
    if roll <= gear.form_roll_angle * (1.0 + 1e-9) or (centre(roll) - end) @ along > 0.0:
        raise GeometryError(
            f"tip edge radius {radius:.4g} mm of the gear with {gear.teeth} teeth does not fit between its involute and"
            f" its chamfer, which is {np.linalg.norm(end - foot):.4g} mm long; lower corner_contact.edge_radius"
        )
    return TipEdge(radius, centre(roll), float(roll), canonical_normal(roll), outward)


def form_edge(gear: Gear) -> TipEdge:
    """The sharp edge where the fillet of an undercut gear cuts off its drive flank."""
    roll = gear.form_roll_angle
    normal = canonical_normal(roll)
    return TipEdge(0.0, canonical_point(gear.base_radius, roll), roll, normal, normal)
