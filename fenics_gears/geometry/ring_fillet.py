"""The fillet between root circle and involute of an internal gear: cut by the rounded tip of a shaper cutter, or a
plain arc.

Complex numbers u + i w are points of the ring's section, mm, seen from the middle of a tooth space: u outwards, w
towards the tooth. Sizes are positive here, whatever sign the ring's numbers have (`Gear`).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from math import acos, atan, atan2, cos, nan, pi, sin, sqrt
from typing import TYPE_CHECKING

import numpy as np

from .involute import inverse_involute

if TYPE_CHECKING:
    from .gear import Gear


# Places on the path of a corner.
SAMPLES = 2000


@dataclass(frozen=True)
class PlainFillet:
    """An arc of `rounding` (mm) that touches the root circle and the flank of a ring with these base and root radii
    (mm)."""

    base: float
    root: float
    rounding: float

    @cached_property
    def tangent_length(self) -> float:
        """Distance (mm) of the arc's centre from the base circle, along the tangent; not a number where it lies within
        it."""
        square = (self.root - self.rounding) ** 2 - self.base**2
        return sqrt(square) if square >= 0.0 else nan

    @property
    def form_roll_angle(self) -> float:
        """Roll angle (rad) where the arc touches the flank: a curve parallel to an involute is an involute."""
        return (self.tangent_length + self.rounding) / self.base

    @property
    def begins_at(self) -> float:
        """Polar angle (rad) of the arc's centre, from where the involute begins."""
        return atan(self.tangent_length / self.base) - self.form_roll_angle

    @property
    def end(self) -> float:
        """Parameter (rad) at the flank: angle of the arc from the root circle on."""
        return 0.5 * pi - atan(self.tangent_length / self.base)

    def point(self, parameter, aside: float):
        """Points at parameters, their slopes by it; `aside` (rad): of the involute's begin from the middle of the
        space."""
        turned = np.exp(1j * (aside + self.begins_at))
        arc = self.rounding * np.exp(1j * np.asarray(parameter, dtype=float))
        return turned * (self.root - self.rounding + arc), turned * 1j * arc


@dataclass(frozen=True)
class CutFillet:
    """What the rounded tip of a cutter (`teeth`, base circle `cutter_base`, half angle `half_angle` of a tooth there,
    `rounding`) cuts into a ring of `ring_teeth` teeth with these base and root radii (mm), at an operating pressure
    angle (rad). Parameter: the angle, at the cutter's centre, of the rounding's centre from the line of centres.

    A point is cut where the normal of the rounding passes through the pitch point.
    """

    teeth: int
    ring_teeth: int
    cutter_base: float
    base: float
    root: float
    rounding: float
    half_angle: float
    pressure_angle: float

    @property
    def centre_distance(self) -> float:
        """Distance (mm) of the axes of ring and cutter."""
        return (self.base - self.cutter_base) / cos(self.pressure_angle)

    @property
    def tip(self) -> float:
        """Tip radius (mm) of the cutter, which cuts the root circle."""
        return self.root - self.centre_distance

    @cached_property
    def tangent_length(self) -> float:
        """Distance (mm) of the rounding's centre from the cutter's base circle, along the tangent; not a number where
        it lies within it."""
        square = (self.tip - self.rounding) ** 2 - self.cutter_base**2
        return sqrt(square) if square >= 0.0 else nan

    @property
    def form_roll_angle(self) -> float:
        """Roll angle (rad) of the ring where the rounding passes into the cutter's flank."""
        return (self.centre_distance * sin(self.pressure_angle) + self.tangent_length + self.rounding) / self.base

    @property
    def lowest_roll_angle(self) -> float:
        """Roll angle (rad) of the ring at which the cutter's involute begins: below it the ring has none."""
        return self.centre_distance * sin(self.pressure_angle) / self.base

    @property
    def corner_angle(self) -> float:
        """Angle (rad) of the rounding's centre from the middle of the cutter's tooth; negative without room for it."""
        along = self.tangent_length / self.cutter_base
        return self.half_angle - (along + self.rounding / self.cutter_base) + atan(along)

    @property
    def end(self) -> float:
        """Parameter (rad) at the form circle."""
        operating = self.cutter_base / cos(self.pressure_angle)
        along = self.tangent_length - operating * sin(self.pressure_angle)
        return atan2(along * cos(self.pressure_angle), operating + along * sin(self.pressure_angle))

    def corner_clearance(self, tip: float, half_space: float) -> float:
        """Least arc (mm) about the cutter's centre from its tooth to the path of the corner of the ring's tooth, at the
        radius `tip` (mm) and the angle `half_space` (rad) from the middle of the space; negative where the cutter cuts
        the corner off."""
        outermost = (tip**2 + self.centre_distance**2 - self.tip**2) / (2.0 * tip * self.centre_distance)
        outermost = acos(max(-1.0, min(1.0, outermost)))
        place = np.linspace(-outermost, outermost, SAMPLES)
        seen = tip * np.exp(1j * place) - self.centre_distance
        seen *= np.exp(-1j * (place - half_space) * self.ring_teeth / self.teeth)
        radius = np.abs(seen)
        roll = np.sqrt(np.maximum((radius / self.cutter_base) ** 2 - 1.0, 0.0))
        involute = self.half_angle - roll + np.arctan(roll)
        middle = self.tip - self.rounding
        cosine = (middle**2 + radius**2 - self.rounding**2) / (2.0 * middle * radius)
        rounded = self.corner_angle + np.arccos(np.minimum(cosine, 1.0))
        on_involute = roll * self.cutter_base < self.tangent_length + self.rounding
        arcs = radius * (np.angle(seen) - np.where(on_involute, involute, rounded))
        return float(np.min(arcs, where=radius < self.tip, initial=np.inf))

    def point(self, parameter, aside: float):
        """As of `PlainFillet`; the cutter's tooth stands in the middle of the space, wherever the involute begins."""
        angle = np.asarray(parameter, dtype=float)
        ratio = self.teeth / self.ring_teeth
        turn = np.exp(1j * angle)
        from_centre = (self.tip - self.rounding) * turn
        from_pitch_point = from_centre - self.cutter_base / cos(self.pressure_angle)
        length = np.abs(from_pitch_point)
        normal = from_pitch_point / length
        cut = self.centre_distance + from_centre + self.rounding * normal
        moved = 1j * from_centre
        turning = (normal.conj() * moved).imag / length
        slope = moved + self.rounding * 1j * normal * turning - 1j * ratio * cut
        back = np.exp(-1j * ratio * (angle - self.corner_angle))
        return cut * back, slope * back


def ring_fillet(gear: Gear) -> PlainFillet | CutFillet:
    """The fillet of an internal gear: of its cutter, or plain where it has none."""
    sizes = abs(gear.base_radius), abs(gear.root_radius), gear.rack_tip_radius
    if gear.cutter is None:
        return PlainFillet(*sizes)
    cutter = replace(gear, teeth=gear.cutter.teeth, profile_shift=gear.cutter.profile_shift, cutter=None)
    # As two gears without backlash, of which the second has negative numbers.
    bases = cutter.base_radius + gear.base_radius
    both = cutter.base_radius * cutter.tooth_half_angle_at_base + gear.base_radius * gear.tooth_half_angle_at_base
    swept = (both - 0.5 * cutter.base_pitch) / bases
    angle = atan(inverse_involute(swept)) if swept > 0.0 else nan
    return CutFillet(cutter.teeth, -gear.teeth, cutter.base_radius, *sizes, cutter.tooth_half_angle_at_base, angle)


def room_beside(gear: Gear) -> float:
    """Angle (rad) between the middle of the tooth space and the fillet; negative where fillets overlap, not a number
    where the rounding does not reach the flank."""
    fillet = gear.ring_fillet
    return fillet.corner_angle if isinstance(fillet, CutFillet) else _aside(gear) + fillet.begins_at


def body_points(gear: Gear, parameter) -> tuple[np.ndarray, np.ndarray]:
    """Points (..., 2), mm, of the fillet in the ring's body frame (see involute.py), and their slopes by the
    parameter (...), from 0 at the root circle on."""
    turned = 1j * np.exp(-1j * _aside(gear))
    points, slopes = (turned * each for each in gear.ring_fillet.point(parameter, _aside(gear)))
    return np.stack([points.real, points.imag], axis=-1), np.stack([slopes.real, slopes.imag], axis=-1)


def _aside(gear: Gear) -> float:
    """Half the angle (rad) of a tooth space at the base circle, where the involute would begin."""
    return gear.tooth_half_angle_at_base - 0.5 * gear.angular_pitch
