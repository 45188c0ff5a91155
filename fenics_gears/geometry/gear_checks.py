"""Checks of a single gear: one that no rack can cut is refused, with what is wrong, the value, the limit, and the field
to change.
"""

from math import cos, floor, isfinite, pi, sin
from typing import NoReturn

import numpy as np

from fenics_gears.errors import GeometryError

from .gear import Gear
from .outline import fillet_point

# Lengths (mm) below which a backlash, clearance or arc counts as exactly zero.
ROUNDING = 1e-6
# Of a share of the face width.
SHARE_ROUNDING = 1e-12
# Thinnest rim between bore and root circle, in modules, that leaves room for a mesh.
LEAST_RIM = 0.2
# Thinnest neck of an undercut tooth, in modules.
LEAST_NECK, NECK_SAMPLES = 0.1, 401
# Parts of a module to which a tip radius is rounded down.
STEPS_OF_TIP_RADIUS = 10_000


def check_gear(gear: Gear, name: str) -> None:
    """Refuse a gear (``name`` is its section of the scene) that no rack can cut; raises GeometryError."""
    _check_numbers(gear, name)
    _check_circles(gear, name)
    _check_web(gear, name)
    _check_rack(gear, name)
    _check_undercut(gear, name)
    _check_tip(gear, name)


def refuse(name: str, message: str) -> NoReturn:
    """Raise the GeometryError; ``name`` is "pinion", "wheel" or "pair"."""
    raise GeometryError(f"{name}: {message}")


def tip_radius_with_room(gear: Gear) -> float:
    """Tip radius, in modules, that the rack's tip has room for, rounded down so that both roundings fit; 0 where the
    rack ends in a point.
    """
    return max(
        0.0,
        floor((gear.largest_rack_tip_radius / gear.normal_module - 1e-9) * STEPS_OF_TIP_RADIUS) / STEPS_OF_TIP_RADIUS,
    )


def _check_numbers(gear: Gear, name: str) -> None:
    positive = {
        "gears.module": gear.normal_module,
        f"gears.{name}.tip_diameter": 2.0 * gear.tip_radius,
        f"gears.{name}.root_diameter": 2.0 * gear.root_radius,
        f"gears.{name}.bore_diameter": 2.0 * gear.bore_radius,
    }
    for field, value in positive.items():
        if not (isfinite(value) and value > 0.0):
            refuse(name, f"{field} must be a positive length, not {value:.6g} mm")
    if gear.teeth != int(gear.teeth) or gear.teeth < 3:
        refuse(name, f"{gear.teeth} teeth; at least 3 are needed: change gears.{name}.teeth")
    if not 0.0 < gear.pressure_angle < 0.25 * pi:
        refuse(
            name, f"gears.pressure_angle = {in_degrees(gear.normal_pressure_angle)}; it must lie between 0 and 45 deg"
        )
    if not isfinite(gear.profile_shift):
        refuse(name, f"gears.{name}.profile_shift must be a finite number, not {gear.profile_shift}")
    if not (isfinite(gear.rack_tip_radius) and gear.rack_tip_radius >= 0.0):
        refuse(
            name,
            f"gears.{name}.rack_tip_radius must be zero or a positive number, not"
            f" {gear.rack_tip_radius / gear.normal_module:.4g}",
        )


def _check_circles(gear: Gear, name: str) -> None:
    tip, root, bore, base = (
        2.0 * radius for radius in (gear.tip_radius, gear.root_radius, gear.bore_radius, gear.base_radius)
    )
    if tip <= root:
        refuse(
            name,
            f"no teeth: tip diameter {tip:.6g} mm, root diameter {root:.6g} mm; the tip must lie outside the root: "
            f"change gears.{name}.tip_diameter or gears.{name}.root_diameter",
        )
    if tip <= base:
        refuse(
            name,
            f"no flank: tip diameter {tip:.6g} mm, base circle {base:.6g} mm, and the involute exists outside the base "
            f"circle only: raise gears.{name}.tip_diameter, or check gears.module and gears.{name}.teeth",
        )
    largest_bore = root - 2.0 * LEAST_RIM * gear.normal_module
    if bore > largest_bore:
        refuse(
            name,
            f"no rim: bore diameter {bore:.6g} mm, root diameter {root:.6g} mm; with a rim of {LEAST_RIM} modules the"
            f" bore may be {largest_bore:.6g} mm: lower gears.{name}.bore_diameter",
        )


def _check_web(gear: Gear, name: str) -> None:
    if gear.web is None:
        return
    web, largest = gear.web, 2.0 * (gear.root_radius - LEAST_RIM * gear.normal_module)
    bore, hub, rim = (2.0 * radius for radius in (gear.bore_radius, web.hub_radius, web.rim_radius))
    if not bore <= hub < rim <= largest:
        refuse(
            name,
            f"no web: gears.{name}.web.hub_diameter = {hub:.6g} mm, rim_inner_diameter = {rim:.6g} mm; from the bore"
            f" on, {bore:.6g} mm, they must rise, and with a rim of {LEAST_RIM} modules the rim may begin at"
            f" {largest:.6g} mm: change hub_diameter or rim_inner_diameter",
        )
    if not 0.0 < web.share <= 1.0:
        refuse(
            name,
            f"gears.{name}.web.width is {web.share:.4g} of the face width; it must be more than none and no more than"
            " all of it: lower it",
        )
    if abs(web.offset) + 0.5 * web.share > 0.5 + SHARE_ROUNDING:
        refuse(
            name,
            f"gears.{name}.web.axial_offset is {web.offset:.4g} of the face width, and the web is {web.share:.4g} of it"
            f" wide: it would stand beyond the face. Allowed: up to {0.5 - 0.5 * web.share:.4g} of the face width to"
            " either side",
        )


def _check_rack(gear: Gear, name: str) -> None:
    shifted_pitch = 2.0 * (gear.root_radius + gear.dedendum)
    if gear.dedendum <= 0.0 or gear.rack_depth <= 0.0:
        limit = min(shifted_pitch, 2.0 * gear.reference_radius)
        refuse(
            name,
            f"no dedendum: root diameter {2.0 * gear.root_radius:.6g} mm, but {gear.teeth} teeth with profile shift"
            f" {gear.profile_shift * gear.rack_stretch:.4g} need a root below {limit:.6g} mm: lower"
            f" gears.{name}.root_diameter, or check gears.{name}.teeth, gears.{name}.profile_shift and gears.module",
        )
    if gear.largest_rack_tip_radius < 0.0:
        refuse(
            name,
            f"dedendum too deep: {gear.dedendum / gear.normal_module:.4g} modules, but the rack's tooth ends in a point"
            f" at {_deepest_dedendum(gear):.4g} modules: raise gears.{name}.root_diameter or lower"
            f" gears.{name}.profile_shift",
        )
    if gear.rack_tip_centre[0] < -ROUNDING:
        refuse(
            name,
            f"fillets of neighbouring teeth overlap: rack tip radius {gear.rack_tip_radius / gear.normal_module:.4g}"
            f" modules, but the rack's tip has room for {tip_radius_with_room(gear):.4g} (full radius) at this dedendum"
            f" of {gear.dedendum / gear.normal_module:.4g} modules: lower gears.{name}.rack_tip_radius or raise"
            f" gears.{name}.root_diameter",
        )


def _check_undercut(gear: Gear, name: str) -> None:
    if gear.undercut and (neck := neck_thickness(gear)) < LEAST_NECK * gear.normal_module:
        refuse(
            name,
            f"undercut: cut down to root diameter {2.0 * gear.root_radius:.6g} mm, the fillets leave a tooth"
            f" {max(neck, 0.0):.4g} mm thick at its neck; it must have {LEAST_NECK} modules: raise"
            f" gears.{name}.root_diameter together with gears.{name}.profile_shift, or gears.{name}.teeth",
        )


def neck_thickness(gear: Gear) -> float:
    """Thickness (mm) of a tooth where its two fillets are nearest; negative where they overlap."""
    x, y = fillet_point(gear, np.linspace(0.0, gear.fillet_end, NECK_SAMPLES)).T
    return float(2.0 * np.min(np.hypot(x, y) * np.sin(gear.tooth_half_angle_at_base + np.arctan2(x, -y))))


def _check_tip(gear: Gear, name: str) -> None:
    if not 0.0 <= gear.tip_chamfer < gear.tip_radius - gear.form_radius and gear.tip_radius > gear.form_radius:
        refuse(
            name,
            f"gears.{name}.tip_chamfer = {gear.tip_chamfer:.4g} mm; between the form circle and the tip circle are"
            f" {gear.tip_radius - gear.form_radius:.4g} mm, and involute must be left: lower it to 0 mm or more, but"
            " less than that",
        )
    if gear.tip_radius <= gear.form_radius:
        refuse(
            name,
            f"no involute: tip diameter {2.0 * gear.tip_radius:.6g} mm, but the"
            f" fillet{' cuts off the involute' if gear.undercut else ' reaches'} up to {2.0 * gear.form_radius:.6g} mm:"
            f" raise gears.{name}.tip_diameter or {'raise' if gear.undercut else 'lower'} gears.{name}.root_diameter",
        )
    if gear.tip_chamfer and gear.tip_thickness <= ROUNDING:
        refuse(
            name,
            f"pointed tip: the chamfers of gears.{name}.tip_chamfer = {gear.tip_chamfer:.4g} mm take"
            f" {gear.chamfered_arc:.4g} mm off either side of the tip circle, where the tooth is"
            f" {gear.tip_thickness + 2.0 * gear.chamfered_arc:.4g} mm thick: lower gears.{name}.tip_chamfer or"
            f" gears.{name}.tip_diameter",
        )
    if gear.tip_thickness <= ROUNDING:
        refuse(
            name,
            f"pointed tip: the flanks of a tooth meet at diameter {2.0 * gear.pointed_radius:.6g} mm, below the tip"
            f" diameter {2.0 * gear.tip_radius:.6g} mm (tip thickness {gear.tip_thickness:.4g} mm, must be positive):"
            f" lower gears.{name}.tip_diameter or gears.{name}.profile_shift",
        )


def _deepest_dedendum(gear: Gear) -> float:
    return 0.25 * pi * cos(gear.normal_pressure_angle) / sin(gear.normal_pressure_angle)


def in_degrees(angle: float) -> str:
    """An angle in rad as text in deg."""
    return f"{angle * 180.0 / pi:.4g} deg"
