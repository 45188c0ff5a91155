"""Checks of an internal gear: one that cannot be cut, or cannot run with its pinion, is refused; and whether the pinion
can be put in radially."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from math import inf, isfinite, isnan, pi, sin
from typing import TYPE_CHECKING

from .gear_data import LEAST_RIM, ROUNDING
from .ring_fillet import CutFillet, room_beside

if TYPE_CHECKING:
    from .gear import Gear
    from .gear_checks import Mistakes
    from .pair import GearPair

# Steps of halving for the largest rounding that has room.
HALVINGS = 40
# In modules, of radii that are tried.
LARGEST_ROUNDING = 1.5


def ring_numbers(gear: Gear, section: str) -> Iterator[str]:
    """Sizes that no ring has."""
    sizes = {"tip_diameter": gear.tip_radius, "root_diameter": gear.root_radius, "outer_diameter": gear.bore_radius}
    for field, radius in sizes.items():
        if not (isfinite(radius) and radius < 0.0):
            yield f"{section}.{field} must be a positive length, not {-2.0 * radius:.6g} mm"
    if not isfinite(gear.profile_shift):
        yield f"{section}.profile_shift must be a finite number, not {gear.profile_shift}"
    if gear.web is not None:
        yield f"{section}.web: the rim of an internal gear has no web in this program: leave it out"
    if gear.protuberance:
        yield f"{section}.rack.protuberance: an internal gear is not cut by a rack: leave it out"


def ring_circles(gear: Gear, section: str) -> Mistakes:
    """Circles out of order."""
    tip, root, outer, base = (
        -2.0 * radius for radius in (gear.tip_radius, gear.root_radius, gear.bore_radius, gear.base_radius)
    )
    if tip >= root:
        yield (
            f"no teeth: tip diameter {tip:.6g} mm of an internal gear must be less than its root diameter"
            f" {root:.6g} mm",
            (("lower", "tip_diameter"), ("lower", "root_diameter")),
        )
    if tip < base:
        yield (
            f"no flank at the tip: tip diameter {tip:.6g} mm, but the involute begins at the base circle of"
            f" {base:.6g} mm",
            (("lower", "tip_diameter"), ("raise", "profile_shift")),
        )
    least = root + 2.0 * LEAST_RIM * gear.normal_module
    if outer < least:
        yield (
            f"no rim: outer diameter {outer:.6g} mm, root diameter {root:.6g} mm; with a rim of {LEAST_RIM} modules the"
            f" outer diameter must be at least {least:.6g} mm: raise {section}.outer_diameter",
            (),
        )


def ring_cutting(gear: Gear, section: str) -> Mistakes:
    """A ring that its cutter cannot cut, or fillets that do not fit."""
    fillet = gear.ring_fillet
    rounding = gear.rack_tip_radius / gear.normal_module
    if isinstance(fillet, CutFillet):
        teeth = gear.tooth_count
        if fillet.teeth >= teeth or isnan(fillet.pressure_angle):
            yield (
                f"cutter: a cutter of {fillet.teeth} teeth cannot cut {teeth} internal teeth with these profile shifts:"
                f" change {section}.cutter.teeth or {section}.cutter.profile_shift",
                (),
            )
            return
        if not fillet.tip > fillet.cutter_base + gear.rack_tip_radius:
            yield (
                f"cutter: its tip radius would be {fillet.tip:.6g} mm, from the root diameter of"
                f" {2.0 * fillet.root:.6g} mm, but its base circle has {fillet.cutter_base:.6g} mm",
                (("lower", "root_diameter"),),
            )
            return
        if gear.tip_roll_angle < fillet.lowest_roll_angle - 1e-12:
            # At this roll angle the involute of the cutter begins.
            least = -2.0 * float(gear.radius(fillet.lowest_roll_angle))
            yield (
                f"undercut at the tip: the cutter's involute ends at its base circle, so that it cuts off the ring's"
                f" flank inside of diameter {least:.6g} mm, but its tip diameter is {-2.0 * gear.tip_radius:.6g} mm",
                (("lower", "tip_diameter"),),
            )
        elif (clearance := _corner_clearance(gear)) < -ROUNDING:
            yield (
                f"cutter: its teeth would cut {-clearance:.4g} mm off the tips of the ring's teeth, off the line of"
                f" action: {_fewer_teeth(gear, section)}",
                (),
            )
    room = room_beside(gear)
    if not room >= -ROUNDING / abs(gear.root_radius):
        yield (
            f"fillets of neighbouring teeth overlap: their radius is {rounding:.4g} modules, but there is room for"
            f" {ring_tip_radius_with_room(gear):.4g}",
            (("lower", "rack_tip_radius"),),
        )


def _corner_clearance(gear: Gear) -> float:
    """Least arc (mm) between the cutter's teeth and the paths of the tip corners of the ring's; infinite without a
    cutter that could be."""
    fillet = gear.ring_fillet
    if not isinstance(fillet, CutFillet) or isnan(fillet.pressure_angle) or isnan(fillet.tangent_length):
        return inf
    half_space = 0.5 * abs(gear.angular_pitch) - 0.5 * gear.tip_thickness / abs(gear.tip_radius)
    return fillet.corner_clearance(abs(gear.tip_radius), half_space)


def _fewer_teeth(gear: Gear, section: str) -> str:
    """The most teeth of a cutter that cuts the whole ring, in words."""
    cutter = gear.cutter
    for teeth in range(cutter.teeth - 1, 4, -1) if cutter else ():
        cut = replace(gear, cutter=replace(cutter, teeth=teeth))
        if not any(ring_cutting(cut, section)):
            return f"lower {section}.cutter.teeth to {teeth}"
    return f"lower {section}.cutter.teeth, or raise {section}.tip_diameter"


def ring_tip(gear: Gear, section: str) -> Mistakes:
    """No involute, or a tooth without a tip."""
    if gear.tip_form_radius - gear.form_radius <= 0.0:
        yield (
            f"no involute: tip diameter {-2.0 * gear.tip_radius:.6g} mm, but the fillet begins at"
            f" {-2.0 * gear.form_radius:.6g} mm",
            (("raise", "tip_diameter"), ("lower", "root_diameter")),
        )
    elif gear.tip_thickness <= ROUNDING:
        yield (
            f"pointed tip: the flanks of a tooth meet outside of the tip diameter {-2.0 * gear.tip_radius:.6g} mm",
            (("lower", "tip_diameter"),),
        )


NUMBERS_OF_RING = (ring_numbers,)
RULES_OF_RING = (ring_circles, ring_cutting, ring_tip)


def ring_tip_radius_with_room(gear: Gear) -> float:
    """Largest radius of the fillet's rounding, in modules, that leaves room for both, rounded down."""

    def fits(radius: float) -> bool:
        tried = replace(gear, rack_tip_radius=radius * gear.normal_module)
        return room_beside(tried) >= 0.0 and tried.form_radius < tried.tip_form_radius

    low = 0.0
    high = LARGEST_ROUNDING
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if fits(middle) else (low, middle)
    return int(1e4 * low) / 1e4


def ring_centres(pair: GearPair) -> Mistakes:
    """Axes at which the ring does not go around its pinion."""
    bases = abs(pair.pinion.base_radius + pair.wheel.base_radius)
    if pair.pinion.tooth_count >= pair.wheel.tooth_count:
        yield (
            f"pair: an internal gear of {pair.wheel.tooth_count} teeth cannot go around a pinion of"
            f" {pair.pinion.tooth_count}: raise the teeth of the wheel",
            (),
        )
    elif not (isfinite(pair.centre_distance) and -pair.centre_distance > bases):
        yield (
            f"pair: centre distance {abs(pair.centre_distance):.6g} mm, but the base circles of pinion and internal"
            f" gear have no common tangent below {bases:.6g} mm",
            (("lower", "centre_distance"),) if isfinite(pair.centre_distance) else (),
        )
    if pair.axial_offsets != (0.0, 0.0) and pair.face_width <= 0.0:
        yield "pair: the gears do not overlap axially: change gears.wheel.axial_offset", ()


def goes_in_radially(pair: GearPair) -> bool:
    """Whether the pinion can be moved out of the ring towards its centre, without turning: no tip's corner may be
    farther from the line of centres than the corner of the ring's tooth beyond it, a tooth or a space of the pinion
    being on that line."""
    pinion, ring = pair.pinion, pair.wheel
    half_tooth = 0.5 * pinion.tip_thickness / pinion.tip_radius
    # Half the space of the ring at its tip, an angle without sign.
    half_space = 0.5 * abs(ring.angular_pitch) - 0.5 * ring.tip_thickness / abs(ring.tip_radius)
    for first in (0.0, 0.5):
        for number in range(pinion.tooth_count):
            corner = (number + first) * pinion.angular_pitch + half_tooth
            if corner > 0.5 * pi:
                break
            beyond = (number + first) * abs(ring.angular_pitch) + half_space
            if pinion.tip_radius * sin(corner) > abs(ring.tip_radius) * sin(beyond) + ROUNDING:
                return False
    return True


def assembly_warnings(pair: GearPair) -> list[str]:
    """A sentence on a pinion that goes in along the axis alone."""
    if goes_in_radially(pair):
        return []
    return [
        "pair: the pinion cannot be put into the internal gear radially, only along the axis: its tip corners would hit"
        " the ring's"
    ]


def lowest_tip(pinion: Gear, ring: Gear, distance: float, clear: float) -> float:
    """Radius (mm, negative as the ring's) of its tip that reaches the pinion's involute where it begins, but for a part
    `clear` (mm) of the path of contact, at a signed centre distance."""
    bases = pinion.base_radius + ring.base_radius
    length = -((distance**2 - bases**2) ** 0.5)
    begins = pinion.base_radius * max(pinion.form_roll_angle, 0.0) + clear
    return float(ring.radius((length - begins) / ring.base_radius))
