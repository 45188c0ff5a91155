"""What a drawing of an internal gear leaves out: root circle of its cutter, fillet, tip circle. Loaded where a scene
has one.

Diameters are negative here (`geometry.gear`); a scene has them without sign.
"""

from __future__ import annotations

from dataclasses import replace

from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.gear_data import Cutter, GearData, RingSupport
from fenics_gears.geometry.ring_checks import lowest_tip, ring_tip_radius_with_room
from fenics_gears.geometry.ring_fillet import CutFillet

from .gear_schema import Gears, GearText
from .schema import Derived

# In modules, of the path of contact that is left between the ring's tip and the pinion's fillet.
CLEAR_OF_FILLET = 0.1


def cutter_of(drawn: GearText) -> Cutter | None:
    """The cutter of an internal gear, in modules of the normal section; None for plain fillets."""
    return None if drawn.cutter is None else Cutter(drawn.cutter.teeth, float(drawn.cutter.profile_shift or 0.0))


def support_of(drawn: GearText) -> RingSupport | None:
    """What holds the outer circle, where the scene says so."""
    own = drawn.support
    if own is None:
        return None
    stiff = (None if each is None else float(each) for each in (own.radial_stiffness, own.tangential_stiffness))
    return RingSupport(own.kind, *stiff)


def root_of_cutter(pair: Gears, gear: Gear, dedendum: float) -> float | None:
    """Root diameter (mm) that a cutter with an addendum (modules) cuts; None where it cannot cut the ring, or there is
    none."""
    fillet = gear.ring_fillet
    if not isinstance(fillet, CutFillet):
        return None
    cutter_tip = 0.5 * fillet.teeth * gear.module + (gear.cutter.profile_shift * gear.rack_stretch + dedendum) * (
        pair.module
    )
    root = -2.0 * (fillet.centre_distance + cutter_tip)
    return root if root == root else None


def tip_radius_of_fillet(gear: Gear, usual: float) -> tuple[float, str]:
    """Radius (modules) of cutter or plain fillet: the usual one, or what has room; and why."""
    room = ring_tip_radius_with_room(gear)
    if room < usual:
        return room, f"what has room in the tooth space, less than the usual {usual:g}"
    return usual, "that of the rack"


def clear_of_the_pinion(
    pair: Gears, gears: tuple[GearData, GearData], distance: float
) -> tuple[GearData, Derived | None]:
    """The ring with a tip that neither reaches into the pinion's fillet nor within its own base circle, and what was
    changed for it."""
    own = gears[1]
    pinion, ring = (pair.in_rotation(gear) for gear in gears)
    if not abs(distance) > abs(pinion.base_radius + ring.base_radius):
        return own, None
    lowest = lowest_tip(pinion, ring, distance, CLEAR_OF_FILLET * pair.module)
    tip = min(own.tip_diameter, 2.0 * lowest, 2.0 * ring.base_radius)
    if tip == own.tip_diameter:
        return own, None
    words = "so that it clears the pinion's fillets and its own base circle; by the rack it would be"
    return replace(own, tip_diameter=tip), Derived(
        "wheel tip diameter", -tip, "mm", f"{words} {-own.tip_diameter:.6g} mm"
    )
