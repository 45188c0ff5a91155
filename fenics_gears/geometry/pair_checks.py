"""Checks of a gear pair: one that cannot run is refused, with the value, the limit and the field to change."""

from __future__ import annotations

from collections.abc import Iterator
from math import acos, atan, isfinite, pi
from typing import TYPE_CHECKING

import numpy as np

from .gear import Gear
from .gear_checks import Impossible, Mistakes, Remedy, in_degrees
from .gear_data import ROUNDING
from .involute import involute_function
from .outline import fillet_point

if TYPE_CHECKING:
    from .pair import GearPair


# Tip thickness in modules below which design practice calls a tooth pointed.
THIN_TIP = 0.2
# Each gear and its mate.
NAMES = (("pinion", "wheel"), ("wheel", "pinion"))
# Overlap, in modules, that four printed decimals of both profile shifts leave in a pair without backlash.
PRINTED_DIGITS = 1e-4
# Of the path of a tip's corner and of the fillet, where their clearance is sampled; the error is of second order.
SAMPLES = 1001


def check_pair(pair: GearPair) -> None:
    """Refuse a pair that cannot run; raises Impossible."""
    for check in (_centres, _backlash, _tip_clearance, _contact_ratio, _interference, _fillet_clearance):
        for words, remedies in check(pair):
            raise Impossible(words, remedies)


def design_warnings(pair: GearPair) -> list[str]:
    """Warnings of unusual design that can be computed all the same."""
    sentences = []
    for name, _ in NAMES:
        gear = getattr(pair, name)
        if gear.tip_thickness < THIN_TIP * gear.normal_module:
            sentences.append(
                f"{name}: thin tip: {gear.tip_thickness:.4g} mm at the tip circle, less than {THIN_TIP} modules "
                f"= {THIN_TIP * gear.normal_module:.4g} mm; lower gears.{name}.tip_diameter, or profile_shift with it"
            )
    if pair.wheel.internal:
        from .ring_checks import assembly_warnings

        sentences += assembly_warnings(pair)
    whole = (pair.tip_positions[1] - pair.tip_positions[0]) / pair.base_pitch
    for name, other, lowest in _shortened(pair):
        sentences.append(
            f"{name}: undercut: the {other}'s tip would be in contact down to roll angle {in_degrees(lowest)}, but the"
            f" involute is cut away below {in_degrees(getattr(pair, name).form_roll_angle)} (form circle): contact"
            f" ratio {pair.contact_ratio:.4g} instead of {whole:.4g}; {_less_undercut(pair, name)}"
        )
    return sentences


def _centres(pair: GearPair) -> Mistakes:
    if pair.wheel.internal:
        from .ring_checks import ring_centres

        yield from ring_centres(pair)
        return
    bases = pair.pinion.base_radius + pair.wheel.base_radius
    if not (isfinite(pair.centre_distance) and pair.centre_distance > bases):
        yield (
            f"pair: centre distance {pair.centre_distance:.6g} mm, but the base circles overlap below {bases:.6g} mm",
            (("raise", "centre_distance"),) if isfinite(pair.centre_distance) else (),
        )
    if pair.axial_offsets != (0.0, 0.0) and pair.face_width <= 0.0:
        first, second = pair.axial_offsets
        widths = pair.face_widths
        yield (
            f"pair: the gears do not overlap axially: pinion {widths[0]:.6g} mm wide at axial offset {first:.6g} mm,"
            f" wheel {widths[1]:.6g} mm wide at {second:.6g} mm; their middles may be less than"
            f" {0.5 * sum(widths):.6g} mm apart: change gears.pinion.axial_offset or gears.wheel.axial_offset",
            (),
        )
    if not (isfinite(pair.face_width) and pair.face_width > 0.0):
        yield f"pair: gears.face_width must be a positive length, not {pair.face_width}", ()


def _backlash(pair: GearPair) -> Mistakes:
    if pair.backlash < -PRINTED_DIGITS * pair.pinion.module:
        fits = abs(pair.centre_distance_without_backlash)
        where = f"from {fits:.6g} mm {'down' if pair.wheel.internal else 'up'} (gears.centre_distance), or"
        if pair.wheel.internal and fits <= abs(sum(pair.base_radii)) * (1.0 + 1e-9):
            # Nearer to each other the base circles have no common tangent.
            where = "at no centre distance, but"
        yield (
            f"pair: no backlash: the teeth overlap by {-pair.backlash:.4g} mm along the line of action at centre"
            f" distance {abs(pair.centre_distance):.6g} mm; they fit {where} with smaller profile shifts of both gears",
            (),
        )


def _tip_clearance(pair: GearPair) -> Mistakes:
    for (name, other), clearance in zip(NAMES, pair.tip_clearances):
        if clearance < -ROUNDING:
            yield (
                f"{name}: no tip clearance: its tip circle reaches {-clearance:.4g} mm into the {other}'s root circle",
                (("lower", f"{name}.tip_diameter"), ("lower", f"{other}.root_diameter"), ("raise", "centre_distance")),
            )


def _contact_ratio(pair: GearPair) -> Mistakes:
    if pair.contact_ratio < 1.0:
        short = [name for name, *_ in _shortened(pair) if getattr(pair, name).undercut]
        cut = "".join(f", shortened by the undercut {name}" for name in short)
        kind = ""
        why = "otherwise a tooth pair leaves before the next one enters"
        if pair.helix:
            kind = "transverse "
            why = f"pairs that their overlap alone carries (here {pair.overlap_ratio:.4g}) are not simulated"
        yield (
            f"pair: {kind}contact ratio {pair.contact_ratio:.4g}{cut}, must be at least 1, {why}",
            (
                *(("raise", f"{name}.tip_diameter") for name, _ in NAMES),
                ("lower", "centre_distance"),
                *(("raise", f"{name}.{field}") for field in ("profile_shift", "teeth") for name, _ in NAMES),
            ),
        )


def _interference(pair: GearPair) -> Mistakes:
    for name, other, lowest in _shortened(pair):
        gear = getattr(pair, name)
        if not gear.undercut:
            yield (
                f"{name}: interference: the {other}'s tip reaches its fillet: contact down to roll angle"
                f" {in_degrees(lowest)}, but the involute begins at {in_degrees(gear.form_roll_angle)}",
                _off_the_fillet(name, other),
            )


def _fillet_clearance(pair: GearPair) -> Mistakes:
    for name, other in NAMES:
        clearance = fillet_clearance(getattr(pair, name), getattr(pair, other), pair.centre_distance)
        if clearance < -ROUNDING:
            yield (
                f"{name}: interference: the {other}'s tip corner cuts {-clearance:.4g} mm into its"
                f" {'teeth' if pair.wheel.internal else 'fillet'}, off the line of action",
                _off_the_fillet(name, other) if not pair.wheel.internal else _off_the_tips(name, other),
            )


def _off_the_fillet(name: str, other: str) -> tuple[Remedy, ...]:
    return tuple(
        ("lower", field) for field in (f"{other}.tip_diameter", f"{name}.root_diameter", f"{name}.rack_tip_radius")
    )


def _off_the_tips(name: str, other: str) -> tuple[Remedy, ...]:
    """Tips of pinion and ring that meet outside of the path of contact."""
    return *(("lower", f"{each}.tip_diameter") for each in (other, name)), ("raise", "wheel.teeth")


def _shortened(pair: GearPair) -> Iterator[tuple[str, str, float]]:
    """Gears whose involute ends above the mate's tip: name, the mate's name and the roll angle (rad) that its tip
    would reach."""
    start, end = pair.tip_positions
    for (name, other), lowest in zip(NAMES, (pair.pinion_roll_angle(start), pair.wheel_roll_angle(end))):
        gear = getattr(pair, name)
        if (lowest - gear.form_roll_angle) * gear.base_radius < -ROUNDING:
            yield name, other, lowest


def _less_undercut(pair: GearPair, name: str) -> str:
    protuberance = "lower protuberance of its rack, or " if getattr(pair, name).protuberance else ""
    return f"{protuberance}raise gears.{name}.profile_shift together with its diameters, or gears.{name}.teeth"


def fillet_clearance(gear: Gear, mate: Gear, centre_distance: float) -> float:
    """Least radial distance (mm) from the path of the mate's tip corner down to the gear's fillet, drive flanks in
    contact. Infinite where the corner never comes over the fillet, negative where it would cut in. Of an undercut gear
    the least arc."""
    along_circles = gear.undercut or gear.internal or mate.internal
    clearance = _clearance_along_circles if along_circles else _clearance_of_corner
    return min(clearance(gear, mate, centre_distance, corner) for corner in _corners(mate))


def _clearance_of_corner(gear: Gear, mate: Gear, centre_distance: float, corner: tuple[float, float]) -> float:
    at_contact = atan(mate.tip_roll_angle) - _operating_angle(gear, mate, centre_distance)
    radius, angle = _tip_corner_path(gear, mate, centre_distance, np.linspace(at_contact, 0.0, SAMPLES), corner)
    fillet = fillet_point(gear, np.linspace(gear.fillet_end, 0.0, SAMPLES))
    fillet_radius = np.hypot(fillet[:, 0], fillet[:, 1])
    # From straight down, as that of the path.
    fillet_angle = np.arctan2(fillet[:, 1], fillet[:, 0]) + 0.5 * pi
    over_fillet = (angle >= fillet_angle[0]) & (angle <= fillet_angle[-1])
    if not over_fillet.any():
        return np.inf
    return float(np.min(radius[over_fillet] - np.interp(angle[over_fillet], fillet_angle, fillet_radius)))


def _corners(gear: Gear) -> list[tuple[float, float]]:
    """Radius (mm) of each corner of a tip's drive side, two of a chamfer, and angle (rad) behind the end of the
    involute."""
    if not gear.tip_chamfer:
        return [(gear.tip_radius, 0.0)]
    behind = (
        gear.tooth_half_angle_at_base
        - involute_function(gear.tip_roll_angle)
        - 0.5 * gear.tip_thickness / gear.tip_radius
    )
    return [(gear.tip_form_radius, 0.0), (gear.tip_radius, float(behind))]


def _clearance_along_circles(gear: Gear, mate: Gear, centre_distance: float, corner: tuple[float, float]) -> float:
    """Least arc (mm) about the gear's centre from its fillet and involute to the path of the mate's tip corner below
    the gear's tip. Arcs are taken at a radius, since an undercut fillet has up to two points at one polar angle."""
    above = acos((centre_distance**2 + corner[0] ** 2 - gear.tip_radius**2) / (2.0 * centre_distance * corner[0]))
    radius, angle = _tip_corner_path(
        gear, mate, centre_distance, np.linspace(above + corner[1], corner[1], SAMPLES), corner
    )
    fillet = fillet_point(gear, np.linspace(0.0, gear.fillet_end, SAMPLES))
    involute = -involute_function(gear.roll_angle(np.maximum(radius, gear.form_radius)))
    x, y = gear.sign * fillet.T
    cut = np.interp(radius, gear.sign * np.hypot(x, y), np.arctan2(x, -y))
    arcs = radius * (angle - np.where(radius < gear.form_radius, cut, involute))
    return float(np.min(arcs, where=radius > gear.root_radius, initial=np.inf))


def _operating_angle(gear: Gear, mate: Gear, centre_distance: float) -> float:
    return float(np.arccos((gear.base_radius + mate.base_radius) / centre_distance))


def _tip_corner_path(
    gear: Gear, mate: Gear, centre_distance: float, mate_angle: np.ndarray, corner: tuple[float, float]
) -> tuple[np.ndarray, np.ndarray]:
    """Radius (mm) and polar angle from straight down (rad) of a corner of the mate's tip in the gear's tooth frame.

    ``mate_angle`` (n,), rad: of the end of the mate's involute from the line of centres, about the mate's centre.
    """
    operating = _operating_angle(gear, mate, centre_distance)
    contact_roll = np.tan(operating) * (1.0 + mate.base_radius / gear.base_radius)
    contact_roll -= mate.base_radius * mate.tip_roll_angle / gear.base_radius
    at_contact = atan(mate.tip_roll_angle) - operating

    def seen(radius, turned):
        return radius * np.sin(turned), centre_distance - radius * np.cos(turned)

    across, along = seen(corner[0], mate_angle - corner[1])
    if gear.internal:
        across = -across
        along = -along
    start = seen(mate.tip_form_radius, at_contact)
    gear_angle = np.arctan2(gear.sign * start[0], gear.sign * start[1]) - np.arctan2(across, along)
    gear_rotation = mate.teeth / gear.teeth * (at_contact - mate_angle)
    return gear.sign * np.hypot(across, along), -involute_function(contact_roll) + gear_angle - gear_rotation
