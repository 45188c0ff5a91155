"""Gears and pairs that cannot be, named as what they are.

Every message says what is wrong, on which gear, the value, the limit, and the field of the scene to change.
"""

from __future__ import annotations

from math import cos, isfinite, pi, sin
from typing import TYPE_CHECKING

from ..errors import GeometryError
from .gear import Gear

if TYPE_CHECKING:
    from .pair import GearPair

ROUNDING = 1e-6
"""Lengths (mm) below which a backlash, clearance or arc counts as exactly zero."""
LEAST_RIM = 0.2
"""Thinnest rim between bore and root circle, in modules, that leaves room for a mesh."""
THIN_TIP = 0.2
"""Tip thickness in modules below which design practice calls a tooth pointed."""


def check_gear(gear: Gear, name: str) -> None:
    """Refuse a gear (``name`` is its section of the scene) that no rack can cut; raises GeometryError."""
    _check_numbers(gear, name)
    _check_circles(gear, name)
    _check_rack(gear, name)
    _check_undercut(gear, name)
    _check_tip(gear, name)


def check_pair(pair: GearPair) -> None:
    """Refuse a pair that cannot run; raises GeometryError."""
    _check_centres(pair)
    _check_backlash(pair)
    _check_tip_clearance(pair)
    _check_contact_ratio(pair)
    _check_interference(pair)


def warnings(pair: GearPair) -> list[str]:
    """Sentences on what can be computed but is unusual design."""
    found = []
    for name, gear in (("pinion", pair.pinion), ("wheel", pair.wheel)):
        if gear.tip_thickness < THIN_TIP * gear.module:
            found.append(
                f"{name}: thin tip: {gear.tip_thickness:.4g} mm at the tip circle, less than {THIN_TIP} modules "
                f"= {THIN_TIP * gear.module:.4g} mm; lower gears.{name}.tip_diameter or profile_shift"
            )
    return found


def _refuse(name: str, message: str) -> None:
    raise GeometryError(f"{name}: {message}")


def _check_numbers(gear: Gear, name: str) -> None:
    positive = {
        "gears.module": gear.module,
        f"gears.{name}.tip_diameter": gear.tip_radius,
        f"gears.{name}.root_diameter": gear.root_radius,
        f"gears.{name}.bore_diameter": gear.bore_radius,
    }
    for field, value in positive.items():
        if not (isfinite(value) and value > 0.0):
            _refuse(name, f"{field} must be a positive length, not {value}")
    if gear.teeth != int(gear.teeth) or gear.teeth < 3:
        _refuse(name, f"{gear.teeth} teeth; at least 3 are needed: change gears.{name}.teeth")
    if not 0.0 < gear.pressure_angle < 0.25 * pi:
        _refuse(name, f"gears.pressure_angle = {_degrees(gear.pressure_angle)}; it must lie between 0 and 45 deg")
    if not isfinite(gear.profile_shift):
        _refuse(name, f"gears.{name}.profile_shift must be a finite number, not {gear.profile_shift}")
    if not (isfinite(gear.rack_tip_radius) and gear.rack_tip_radius >= 0.0):
        _refuse(name, f"gears.{name}.rack_tip_radius must be zero or a positive number, not {gear.rack_tip_radius}")


def _check_circles(gear: Gear, name: str) -> None:
    tip, root, bore, base = (2.0 * r for r in (gear.tip_radius, gear.root_radius, gear.bore_radius, gear.base_radius))
    if tip <= root:
        _refuse(
            name,
            f"no teeth: tip diameter {tip:.6g} mm, root diameter {root:.6g} mm; the tip must lie outside the root: "
            f"change gears.{name}.tip_diameter or gears.{name}.root_diameter",
        )
    if tip <= base:
        _refuse(
            name,
            f"no flank: tip diameter {tip:.6g} mm, base circle {base:.6g} mm, and the involute exists outside the base circle only: "
            f"raise gears.{name}.tip_diameter, or check gears.module and gears.{name}.teeth",
        )
    largest_bore = root - 2.0 * LEAST_RIM * gear.module
    if bore > largest_bore:
        _refuse(
            name,
            f"no rim: bore diameter {bore:.6g} mm, root diameter {root:.6g} mm; with a rim of {LEAST_RIM} modules the bore "
            f"may be {largest_bore:.6g} mm: lower gears.{name}.bore_diameter",
        )


def _check_rack(gear: Gear, name: str) -> None:
    shifted_pitch = 2.0 * (gear.root_radius + gear.dedendum)
    if gear.dedendum <= 0.0 or gear.rack_depth <= 0.0:
        limit = min(shifted_pitch, 2.0 * gear.reference_radius)
        _refuse(
            name,
            f"no dedendum: root diameter {2.0 * gear.root_radius:.6g} mm, but {gear.teeth} teeth with profile shift "
            f"{gear.profile_shift:.4g} need a root below {limit:.6g} mm: lower gears.{name}.root_diameter, or check "
            f"gears.{name}.teeth, gears.{name}.profile_shift and gears.module",
        )
    if gear.largest_rack_tip_radius < 0.0:
        _refuse(
            name,
            f"dedendum too deep: {gear.dedendum / gear.module:.4g} modules, but the rack's tooth ends in a point at "
            f"{_deepest_dedendum(gear):.4g} modules: raise gears.{name}.root_diameter or lower gears.{name}.profile_shift",
        )
    if gear.rack_tip_centre[0] < -ROUNDING:
        _refuse(
            name,
            f"fillets of neighbouring teeth overlap: rack tip radius {gear.rack_tip_radius / gear.module:.4g} modules, but the rack's "
            f"tip has room for {gear.largest_rack_tip_radius / gear.module:.4g} (full radius) at this dedendum of "
            f"{gear.dedendum / gear.module:.4g} modules: lower gears.{name}.rack_tip_radius or raise gears.{name}.root_diameter",
        )


def _check_undercut(gear: Gear, name: str) -> None:
    if gear.form_roll_angle < 0.0:
        sine = sin(gear.pressure_angle)
        lowest_root = 2.0 * (gear.reference_radius * cos(gear.pressure_angle) ** 2 - gear.rack_tip_radius * (1.0 - sine))
        _refuse(
            name,
            f"undercut: cut down to root diameter {2.0 * gear.root_radius:.6g} mm the rack removes involute near the base "
            f"circle; {gear.teeth} teeth with a rack tip radius of {gear.rack_tip_radius / gear.module:.4g} modules are free of "
            f"undercut from root diameter {lowest_root:.6g} mm up: raise gears.{name}.root_diameter together with "
            f"gears.{name}.profile_shift, or gears.{name}.teeth",
        )


def _check_tip(gear: Gear, name: str) -> None:
    if gear.tip_radius <= gear.form_radius:
        _refuse(
            name,
            f"no involute: tip diameter {2.0 * gear.tip_radius:.6g} mm, but the fillet reaches up to "
            f"{2.0 * gear.form_radius:.6g} mm: raise gears.{name}.tip_diameter or lower gears.{name}.root_diameter",
        )
    if gear.tip_thickness <= ROUNDING:
        _refuse(
            name,
            f"pointed tip: the flanks of a tooth meet at diameter {2.0 * gear.pointed_radius:.6g} mm, below the tip diameter "
            f"{2.0 * gear.tip_radius:.6g} mm (tip thickness {gear.tip_thickness:.4g} mm, must be positive): lower "
            f"gears.{name}.tip_diameter or gears.{name}.profile_shift",
        )


def _check_centres(pair: GearPair) -> None:
    bases = pair.pinion.base_radius + pair.wheel.base_radius
    if not (isfinite(pair.centre_distance) and pair.centre_distance > bases):
        _refuse(
            "pair",
            f"centre distance {pair.centre_distance:.6g} mm, but the base circles overlap below {bases:.6g} mm: "
            "raise gears.centre_distance, or check gears.module and the teeth",
        )
    if not (isfinite(pair.face_width) and pair.face_width > 0.0):
        _refuse("pair", f"gears.face_width must be a positive length, not {pair.face_width}")


def _check_backlash(pair: GearPair) -> None:
    if pair.backlash < -ROUNDING:
        _refuse(
            "pair",
            f"no backlash: the teeth overlap by {-pair.backlash:.4g} mm along the line of action at centre distance "
            f"{pair.centre_distance:.6g} mm; they fit from {pair.centre_distance_without_backlash:.6g} mm up: raise "
            "gears.centre_distance or lower gears.pinion.profile_shift or gears.wheel.profile_shift",
        )


def _check_tip_clearance(pair: GearPair) -> None:
    for name, other, clearance in (
        ("pinion", "wheel", pair.pinion_tip_clearance),
        ("wheel", "pinion", pair.wheel_tip_clearance),
    ):
        if clearance < -ROUNDING:
            _refuse(
                name,
                f"no tip clearance: its tip circle reaches {-clearance:.4g} mm into the {other}'s root circle: lower "
                f"gears.{name}.tip_diameter or gears.{other}.root_diameter, or raise gears.centre_distance",
            )


def _check_contact_ratio(pair: GearPair) -> None:
    if pair.contact_ratio < 1.0:
        _refuse(
            "pair",
            f"contact ratio {pair.contact_ratio:.4g}, must be at least 1, otherwise a tooth pair leaves before the next one "
            f"enters: raise gears.pinion.tip_diameter or gears.wheel.tip_diameter, or lower gears.centre_distance "
            f"({pair.centre_distance:.6g} mm)",
        )


def _check_interference(pair: GearPair) -> None:
    for name, other, gear, lowest in (
        ("pinion", "wheel", pair.pinion, pair.pinion_sap_roll_angle),
        ("wheel", "pinion", pair.wheel, pair.wheel_sap_roll_angle),
    ):
        if lowest * gear.base_radius < gear.form_roll_angle * gear.base_radius - ROUNDING:
            largest_tip = 2.0 * _largest_mating_tip_radius(pair, other, gear)
            _refuse(
                name,
                f"interference: the {other}'s tip reaches its fillet: contact down to roll angle {_degrees(lowest)}, but the "
                f"involute begins at {_degrees(gear.form_roll_angle)}: lower gears.{other}.tip_diameter to {largest_tip:.6g} mm "
                f"or less, or lower gears.{name}.root_diameter or gears.{name}.rack_tip_radius",
            )


def _largest_mating_tip_radius(pair: GearPair, other: str, gear: Gear) -> float:
    mate = pair.wheel if other == "wheel" else pair.pinion
    roll = (pair.line_of_action_length - gear.form_roll_angle * gear.base_radius) / mate.base_radius
    return float(mate.radius(roll))


def _deepest_dedendum(gear: Gear) -> float:
    return 0.25 * pi * cos(gear.pressure_angle) / sin(gear.pressure_angle)


def _degrees(angle: float) -> str:
    return f"{angle * 180.0 / pi:.4g} deg"
