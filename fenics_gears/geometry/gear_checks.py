"""Checks of a single gear: one that no rack can cut is refused, with the value, the limit and the field to change."""

from collections.abc import Callable, Iterable, Iterator
from math import floor, isfinite, pi, tan
from typing import NoReturn

import numpy as np

from fenics_gears.errors import GeometryError

from .gear import Gear
from .gear_data import LEAST_RIM, ROUNDING
from .outline import fillet_point

# "raise" or "lower", and the field: of the pair ("centre_distance") or of a gear ("pinion.tip_diameter", without its
# name in the checks of one gear).
Remedy = tuple[str, str]
# What is wrong, and what may mend it; nothing where the words say what to do.
Mistakes = Iterator[tuple[str, tuple[Remedy, ...]]]

# In normal modules: of a shorter chamfer round-off leaves no direction.
LEAST_CHAMFER = 1e-6
# Of a share of the face width.
SHARE_ROUNDING = 1e-12
# Thinnest neck of an undercut tooth, in modules.
LEAST_NECK = 0.1
NECK_SAMPLES = 401
# Parts of a module to which a tip radius is rounded down.
STEPS_OF_TIP_RADIUS = 10_000


class Impossible(GeometryError):
    """Gears that cannot run, and what may mend them (not tried yet)."""

    def __init__(self, message: str, remedies: Iterable[Remedy]) -> None:
        super().__init__(message)
        self.remedies = tuple(remedies)


def check_gear(gear: Gear, name: str) -> None:
    """Refuse a gear (``name`` is its section of the scene) that no rack can cut; raises Impossible."""
    numbers: tuple[Callable, ...] = (_numbers, _web)
    rules: tuple[Callable, ...] = (_circles, _rack, _undercut, _tip)
    if gear.internal:
        from .ring_checks import NUMBERS_OF_RING, RULES_OF_RING

        numbers = NUMBERS_OF_RING
        rules = RULES_OF_RING
    for check in numbers:
        for problem in check(gear, f"gears.{name}"):
            refuse(name, problem)
    for tried in rules:
        for words, remedies in tried(gear, f"gears.{name}"):
            raise Impossible(f"{name}: {words}", [(how, f"{name}.{field}") for how, field in remedies])


def refuse(name: str, message: str) -> NoReturn:
    """Raise the GeometryError; ``name`` is "pinion", "wheel" or "pair"."""
    raise GeometryError(f"{name}: {message}")


def tip_radius_with_room(gear: Gear) -> float:
    """Tip radius, in modules, that the rack's tip has room for, rounded down so that both roundings fit; 0 where the
    rack ends in a point.
    """
    steps = floor((gear.largest_rack_tip_radius / gear.normal_module - 1e-9) * STEPS_OF_TIP_RADIUS)
    return max(0.0, steps / STEPS_OF_TIP_RADIUS)


def _numbers(gear: Gear, section: str) -> Iterator[str]:
    positive = {
        "gears.module": gear.normal_module,
        f"{section}.tip_diameter": 2.0 * gear.tip_radius,
        f"{section}.root_diameter": 2.0 * gear.root_radius,
        f"{section}.bore_diameter": 2.0 * gear.bore_radius,
    }
    for field, value in positive.items():
        if not (isfinite(value) and value > 0.0):
            yield f"{field} must be a positive length, not {value:.6g} mm"
    if gear.teeth != int(gear.teeth) or gear.teeth < 3:
        yield f"{gear.teeth} teeth; at least 3 are needed: change {section}.teeth"
    if not 0.0 < gear.pressure_angle < 0.25 * pi:
        yield f"gears.pressure_angle = {in_degrees(gear.normal_pressure_angle)}; it must lie between 0 and 45 deg"
    if not isfinite(gear.profile_shift):
        yield f"{section}.profile_shift must be a finite number, not {gear.profile_shift}"
    tip_radius = gear.rack_tip_radius / gear.normal_module
    if not (isfinite(tip_radius) and tip_radius >= 0.0):
        yield f"{section}.rack_tip_radius must be zero or a positive number, not {tip_radius:.4g}"


def _circles(gear: Gear, section: str) -> Mistakes:
    radii = gear.tip_radius, gear.root_radius, gear.bore_radius, gear.base_radius
    tip, root, bore, base = (2.0 * radius for radius in radii)
    if tip <= root:
        yield (
            f"no teeth: tip diameter {tip:.6g} mm must exceed root diameter {root:.6g} mm",
            (("raise", "tip_diameter"), ("lower", "root_diameter")),
        )
    if tip <= base:
        yield (
            f"no flank: tip diameter {tip:.6g} mm, but the involute begins at the base circle of {base:.6g} mm",
            (("raise", "tip_diameter"),),
        )
    largest_bore = root - 2.0 * LEAST_RIM * gear.normal_module
    if bore > largest_bore:
        yield (
            f"no rim: bore diameter {bore:.6g} mm, root diameter {root:.6g} mm; with a rim of {LEAST_RIM} modules the"
            f" bore may be {largest_bore:.6g} mm: lower {section}.bore_diameter",
            (),
        )


def _web(gear: Gear, section: str) -> Iterator[str]:
    web = gear.web
    if web is None:
        return
    largest = 2.0 * (gear.root_radius - LEAST_RIM * gear.normal_module)
    bore, hub, rim = (2.0 * radius for radius in (gear.bore_radius, web.hub_radius, web.rim_radius))
    if not bore <= hub < rim <= largest:
        yield (
            f"no web: {section}.web.hub_diameter = {hub:.6g} mm, rim_inner_diameter = {rim:.6g} mm; they must rise from"
            f" the bore, {bore:.6g} mm, and with a rim of {LEAST_RIM} modules the rim may begin at {largest:.6g} mm"
        )
    if not 0.0 < web.share <= 1.0:
        yield f"{section}.web.width is {web.share:.4g} of the face width; it must be above 0 and at most 1"
    if abs(web.offset) + 0.5 * web.share > 0.5 + SHARE_ROUNDING:
        yield (
            f"{section}.web.axial_offset is {web.offset:.4g} of the face width, and the web is {web.share:.4g} of it"
            f" wide: it would stand out of the face. Allowed: {0.5 - 0.5 * web.share:.4g} of the face width either way"
        )


def _rack(gear: Gear, section: str) -> Mistakes:
    module = gear.normal_module
    dedendum = gear.dedendum / gear.normal_module
    if gear.dedendum <= 0.0 or gear.rack_depth <= 0.0:
        limit = 2.0 * min(gear.root_radius + gear.dedendum, gear.reference_radius)
        yield (
            f"no dedendum: root diameter {2.0 * gear.root_radius:.6g} mm, but {gear.teeth} teeth with profile shift"
            f" {gear.profile_shift * gear.rack_stretch:.4g} ({section}.profile_shift) need a root below {limit:.6g} mm",
            (("lower", "root_diameter"), ("lower", "profile_shift")),
        )
    if gear.largest_rack_tip_radius < 0.0:
        deepest = 0.25 * pi / tan(gear.normal_pressure_angle)
        yield (
            f"dedendum too deep: {dedendum:.4g} modules, but the rack's tooth ends in a point at {deepest:.4g} modules",
            (("raise", "root_diameter"),),
        )
    if gear.rack_tip_centre[0] < -ROUNDING:
        yield (
            f"fillets of neighbouring teeth overlap: rack tip radius {gear.rack_tip_radius / module:.4g} modules, but"
            f" at this dedendum of {dedendum:.4g} modules there is room for {tip_radius_with_room(gear):.4g}",
            (("lower", "rack_tip_radius"), ("raise", "root_diameter")),
        )


def _undercut(gear: Gear, section: str) -> Mistakes:
    if not gear.undercut:
        return
    x, y = fillet_point(gear, np.linspace(0.0, gear.fillet_end, NECK_SAMPLES)).T
    # Negative where the fillets overlap.
    neck = float(2.0 * np.min(np.hypot(x, y) * np.sin(gear.tooth_half_angle_at_base + np.arctan2(x, -y))))
    if neck < LEAST_NECK * gear.normal_module:
        yield (
            f"undercut: cut down to root diameter {2.0 * gear.root_radius:.6g} mm, the fillets leave a tooth"
            f" {max(neck, 0.0):.4g} mm thick at its neck; it must have {LEAST_NECK} modules",
            (("raise", "root_diameter"), ("raise", "profile_shift"), ("raise", "teeth")),
        )


def _tip(gear: Gear, section: str) -> Mistakes:
    above_form = gear.tip_radius - gear.form_radius
    if above_form <= 0.0:
        cuts, change = (" cuts off the involute", "raise") if gear.undercut else (" reaches", "lower")
        yield (
            f"no involute: tip diameter {2.0 * gear.tip_radius:.6g} mm, but the fillet{cuts} up to"
            f" {2.0 * gear.form_radius:.6g} mm",
            (("raise", "tip_diameter"), (change, "root_diameter")),
        )
    least = LEAST_CHAMFER * gear.normal_module
    if gear.tip_chamfer != 0.0 and not least <= gear.tip_chamfer < above_form:
        yield (
            f"{section}.tip_chamfer = {gear.tip_chamfer:.4g} mm; it must be 0 mm, or at least {least:.4g} mm and, as"
            f" involute must be left above the form circle, less than {above_form:.4g} mm",
            (),
        )
    if gear.tip_thickness > ROUNDING:
        return
    if gear.tip_chamfer:
        yield (
            f"pointed tip: the chamfers of {section}.tip_chamfer = {gear.tip_chamfer:.4g} mm take"
            f" {gear.chamfered_arc:.4g} mm off either side of the tip circle, where the tooth is"
            f" {gear.tip_thickness + 2.0 * gear.chamfered_arc:.4g} mm thick: lower {section}.tip_chamfer or"
            f" {section}.tip_diameter",
            (),
        )
    yield (
        f"pointed tip: the flanks of a tooth meet at diameter {2.0 * gear.pointed_radius:.6g} mm, below the tip"
        f" diameter {2.0 * gear.tip_radius:.6g} mm",
        (("lower", "tip_diameter"), ("lower", "profile_shift")),
    )


def in_degrees(angle: float) -> str:
    """An angle in rad as text in deg."""
    return f"{angle * 180.0 / pi:.4g} deg"
