"""From the validated ``[gears]`` and ``[load]`` to their data, with what a drawing leaves out derived: diameters,
centre distance, tip radius of the rack, tooth thickness.

ISO 21771 (DIN 3960), in normal modules: d_a = d + 2 m_n (x + h_aP + k), d_f = d + 2 m_n (x_E - h_fP), inv(alpha_wt) =
inv(alpha_t) + 2 (x1 + x2) tan(alpha_n)/(z1 + z2). x is the profile shift of the drawing. x_E is that of the thickness,
at which the rack cuts flanks and root. They differ by the allowance where a thickness or a backlash is given as well as
x. k shortens the tips, so that their clearance stays the rack's when a is less than a_d + (x1 + x2) m_n.
"""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from itertools import chain
from math import cos, pi, tan
from types import ModuleType

from fenics_gears.effects.tooth_elasticity import material_of
from fenics_gears.errors import GeometryError
from fenics_gears.geometry.gear import DECIMALS_IN_MODULES
from fenics_gears.geometry.gear_checks import refuse, tip_radius_with_room
from fenics_gears.geometry.gear_data import RACKS, ROUNDING, USUAL_BORE, GearData, GearPairData
from fenics_gears.geometry.involute import sum_of_profile_shifts
from fenics_gears.geometry.pair import GearPair
from fenics_gears.inputs.tree import GEARS, MODULES, PRESSURE_ANGLES, in_normal_section

from .gear_parts import of_rack, protuberance
from .gear_schema import Gears, GearText
from .schema import Derived

# Overlap of teeth, in modules, that a rounded centre distance hardly leaves.
NOTABLE_OVERLAP = 0.01
TOOTH_HEIGHT = sum(RACKS["ISO 53 A"][:2])  # Modules.
SIGNED = ", an internal gear's diameters and teeth being negative"


def gear_pair_data(gears: Gears) -> tuple[GearPairData, list[Derived]]:
    """The pair, and what was derived. Raises GeometryError for a figure that cannot be."""
    gears, of_section = _in_normal_section(gears)
    gears, of_shifts = _with_profile_shifts(gears)
    both = (gears.pinion, gears.wheel)
    distance, drawn, derived = completed(gears)
    widths = [own.face_width or gears.face_width for own in both]
    offsets = tuple(float(own.axial_offset or 0.0) for own in both)
    # Without offset the smaller width is the common one, to the last digit.
    apart = abs(offsets[0] - offsets[1])
    common = min(*widths, 0.5 * (widths[0] + widths[1]) - apart) if apart else min(widths)
    alike = widths[0] == widths[1] == common
    bores, of_bores = zip(*(_inner_diameter(*each) for each in zip(GEARS, both, drawn)))
    pinion, wheel = (
        replace(
            gear,
            bore_diameter=bore,
            face_width=None if alike else width,
            material=material_of(own.material, gears.material),
            web=own.web and own.web.data(bore, width),
        )
        for gear, own, width, bore in zip(drawn, both, widths, bores)
    )
    data = GearPairData(
        module=gears.module,
        pressure_angle=gears.pressure_angle,
        centre_distance=distance,
        face_width=common,
        pinion=pinion,
        wheel=wheel,
        material=material_of(gears.material),
        helix_angle=gears.helix_angle or 0.0,
        pinion_hand=gears.pinion_hand or "right",
        axial_offsets=offsets,
    )
    return data, [*of_section, *of_shifts, *derived, *chain(*of_bores)]


def _with_profile_shifts(gears: Gears) -> tuple[Gears, list[Derived]]:
    """The section with a profile shift, or a measure, of both gears, and what was derived."""
    if any(gear.profile_shift is None and gear.measure is None for gear in (gears.pinion, gears.wheel)):
        # Hardly a drawing leaves them out.
        from . import unstated_shift

        return unstated_shift.with_profile_shifts(gears)
    return gears, []


def _inner_diameter(name: str, own: GearText, drawn: GearData) -> tuple[float, list[Derived]]:
    """Where the body of a gear ends: at its bore, or at the outer circle of an internal one, whose diameters are
    negative."""
    if own.teeth < 0:
        return -float(own.outer_diameter), []
    if own.bore_diameter is not None:
        return float(own.bore_diameter), []
    bore = USUAL_BORE * drawn.root_diameter
    return bore, [Derived(f"{name} bore diameter", bore, "mm", f"{USUAL_BORE} d_f; the bore is a rigid ring")]


def _in_normal_section(gears: Gears) -> tuple[Gears, list[Derived]]:
    """The section with module and pressure angle, whatever they are given by, and what was derived."""
    normal: dict[str, float | None] = {}
    derived = []
    for names, unit, size in ((MODULES, "mm", 1.0), (PRESSURE_ANGLES, "deg", pi / 180.0)):
        own, *others = names
        name = next(each for each in names if getattr(gears, each) is not None)
        if name != own:
            number = in_normal_section(name, getattr(gears, name), gears.helix_angle or 0.0)
            normal |= {own: number, **dict.fromkeys(others)}
            words = f"from {name}, in the normal section" if gears.helix_angle else f"from {name}"
            derived.append(Derived(own.replace("_", " "), number / size, unit, words))
    return replace(gears, **normal), derived


def completed(pair: Gears) -> tuple[float, tuple[GearData, GearData], list[Derived]]:
    """Centre distance, mm, both gears (without bore, face width and material), and what was derived. Raises
    GeometryError for an impossible figure."""
    drawn = pair.pinion, pair.wheel
    cut, of_thickness = zip(*(_shift(pair, gear, name) for gear, name in zip(drawn, GEARS)))
    shifts = [gear.profile_shift if gear.profile_shift is not None else own for gear, own in zip(drawn, cut)]
    distance, of_distance = _centre_distance(pair, shifts, cut)
    thinned, of_backlash = _thinned(pair, cut, distance)
    shortening, of_tips = _tip_shortening(pair, drawn, shifts, distance)
    gears, of_gears = zip(*(_gear_data(pair, *each, shortening) for each in zip(drawn, GEARS, shifts, thinned)))
    if pair.wheel.teeth < 0 and pair.wheel.tip_diameter is None:
        ring, clearing = ring_drawing().clear_of_the_pinion(pair, gears, distance)
        gears = gears[0], ring
        of_gears = (*of_gears, [] if clearing is None else [clearing])
    asked = (_asked_measures(pair, *each) for each in zip(drawn, GEARS, thinned))
    return distance, gears, [*chain(*of_thickness, of_distance, of_backlash, of_tips, *of_gears, *asked)]


def _thickness() -> ModuleType:
    """Measured tooth thicknesses, which few drawings give."""
    from . import thickness

    return thickness


def _unusual() -> ModuleType:
    """Remarks on figures that are derived."""
    from . import unusual

    return unusual


def _shift(pair: Gears, drawn: GearText, name: str) -> tuple[float, list[Derived]]:
    """The profile shift of the tooth's thickness."""
    if drawn.measure is None:
        return drawn.profile_shift, []
    return _thickness().shift_of_thickness(pair, drawn, name)


def _asked_measures(pair: Gears, drawn: GearText, name: str, cut: float) -> Iterable[Derived]:
    if drawn.spanned_teeth is None and drawn.ball_diameter is None:
        return ()
    return _thickness().asked_measures(pair, drawn, name, cut)


def _rack_pair(pair: Gears, shifts: list[float], distance: float) -> GearPair:
    pinion, wheel = (pair.rack_gear(gear.teeth, shift) for gear, shift in zip((pair.pinion, pair.wheel), shifts))
    return GearPair(pinion, wheel, distance, 1.0)


def _centre_distance(pair: Gears, shifts: Sequence[float], cut: Sequence[float]) -> tuple[float, list[Derived]]:
    """As given, or that of the profile shifts without backlash, or of both measured thicknesses with the given
    backlash."""
    if pair.centre_distance is not None:
        return float(pair.centre_distance) * (1.0 if pair.wheel.teeth > 0 else -1.0), []
    opened = pair.backlash is not None and pair.pinion.measure is not None
    rack_pair = _rack_pair(pair, cut if opened else shifts, 1.0)
    distance = rack_pair.centre_distance_without_backlash
    if abs(distance) <= abs(sum(rack_pair.base_radii)):
        _refuse_shifts(pair, shifts, rack_pair)
    words = "inv(alpha_wt) = inv(alpha_t) + 2 (x1 + x2) tan(alpha_n)/(z1 + z2), without backlash"
    if opened:
        # Imported here: hardly a scene needs it.
        from scipy.optimize import brentq

        def missing(at: float) -> float:
            return pair.backlash - replace(rack_pair, centre_distance=at).circumferential_backlash

        words = "both tooth thicknesses and the backlash"
        if missing(distance) > 0.0:
            distance = brentq(missing, distance, distance + 10.0 * pair.backlash + pair.module)
    return distance, [Derived("centre distance", abs(distance), "mm", words)]


def _refuse_shifts(pair: Gears, shifts: Sequence[float], rack_pair: GearPair) -> None:
    """Raise GeometryError: the operating pressure angle of these profile shifts would be less than zero."""
    pinion = rack_pair.pinion
    angles = pinion.pressure_angle, pinion.normal_pressure_angle
    limit = sum_of_profile_shifts(pair.pinion.teeth + pair.wheel.teeth, 0.0, *angles)
    first, second = shifts
    raise GeometryError(
        f"pair: profile shifts of {first:.4g} and {second:.4g} fit at no centre distance: their sum must be"
        f" {'above' if pair.wheel.teeth > 0 else 'below'} {limit:.4g} with these teeth. Change"
        " gears.pinion.profile_shift or gears.wheel.profile_shift"
    )


def _thinned(pair: Gears, cut: Sequence[float], distance: float) -> tuple[Sequence[float], list[Derived]]:
    """Profile shifts of both thicknesses, each lowered by the same amount, so that the pair has its backlash."""
    if pair.backlash is None or pair.pinion.measure is not None:
        return cut, []
    rack_pair = _rack_pair(pair, cut, distance)
    pinion = rack_pair.pinion
    if abs(distance) <= abs(pinion.base_radius + rack_pair.wheel.base_radius):
        return cut, []
    missing = pair.backlash - rack_pair.circumferential_backlash
    if missing < -ROUNDING:
        refuse(
            "pair",
            f"gears.backlash = {pair.backlash:.4g} mm, but teeth with these profile shifts already have"
            f" {rack_pair.circumferential_backlash:.4g} mm at centre distance {abs(distance):.6g} mm:"
            f" {'lower' if distance > 0.0 else 'raise'} gears.centre_distance or raise the profile shifts",
        )
    # Thickness along the line of action, 2 r_b psi_b, per unit of x: 2 m_t cos(alpha_t) tan(alpha_n).
    each = (
        0.5
        * missing
        * cos(rack_pair.operating_pressure_angle)
        / (2.0 * pinion.module * cos(pinion.pressure_angle) * tan(pair.pressure_angle))
    )
    lowered = [shift - each for shift in cut]
    overlap = -rack_pair.circumferential_backlash
    nominal = rack_pair.centre_distance_without_backlash
    thinner = 2.0 * each * pair.module * tan(pair.pressure_angle)
    words = "half of the backlash by each gear"
    if overlap > NOTABLE_OVERLAP * pair.module:
        words = (
            f"half of the backlash by each gear, and half of the {overlap:.4g} mm by which teeth with the given profile"
            " shifts would overlap"
        )
    odd = (_unusual().of_thinning(pair, overlap, distance, nominal, thinner), "")
    return lowered, [
        Derived(f"{name} profile shift of its tooth thickness", shift, "modules", words, remark)
        for name, shift, remark in zip(GEARS, lowered, odd)
    ]


def _tip_shortening(
    pair: Gears, drawn: Iterable[GearText], shifts: Sequence[float], distance: float
) -> tuple[float, list[Derived]]:
    """-k: as given, or what keeps the rack's tip clearance; never negative."""
    if pair.tip_shortening is not None:
        return pair.tip_shortening, []
    if all(gear.tip_diameter is not None for gear in drawn):
        return 0.0, []
    reference = 0.5 * pair.module * sum(gear.teeth for gear in drawn) / cos(pair.helix_angle or 0.0)
    shortening = max(0.0, round(sum(shifts) - (distance - reference) / pair.module, DECIMALS_IN_MODULES))
    if shortening >= TOOTH_HEIGHT:
        refuse(
            "pair",
            f"centre distance {abs(distance):.6g} mm, where the gears without profile shift have"
            f" {abs(reference):.6g} mm: no teeth are left when tips are {shortening:.3g} modules shorter:"
            f" {'raise' if distance > 0.0 else 'lower'} gears.centre_distance, or lower gears.module or the teeth",
        )
    formula = "k m_n = a - a_d - (x1 + x2) m_n, not above 0"
    odd = _unusual().of_shortening(shortening)
    return shortening, [Derived("tip shortening -k", shortening, "modules", formula, odd)]


def _gear_data(
    pair: Gears, drawn: GearText, name: str, shift: float, cut: float, shortening: float
) -> tuple[GearData, list[Derived]]:
    derived = []
    reference = pair.module * drawn.teeth / cos(pair.helix_angle or 0.0)
    standard = RACKS[of_rack(pair, drawn, "profile") or "ISO 53 A"]
    addendum, dedendum, radius = (of_rack(pair, drawn, figure) for figure in ("addendum", "dedendum", "tip_radius"))
    internal = drawn.teeth < 0
    sign = -1.0 if internal else 1.0
    signed = SIGNED if internal else ""
    tip = drawn.tip_diameter and sign * drawn.tip_diameter
    root = drawn.root_diameter and sign * drawn.root_diameter
    radius = radius if drawn.rack_tip_radius is None else drawn.rack_tip_radius
    if tip is None:
        tip = reference + 2.0 * pair.module * (shift + (standard[0] if addendum is None else addendum) - shortening)
        derived.append(Derived(f"{name} tip diameter", sign * tip, "mm", f"d_a = d + 2 m_n (x + h_aP + k){signed}"))
    if root is None:
        root, words = _root(pair, drawn, cut, standard[1] if dedendum is None else dedendum)
        derived.append(Derived(f"{name} root diameter", sign * root, "mm", words))
    beyond, angle = protuberance(pair, drawn)
    cutter = ring_drawing().cutter_of(drawn) if internal else None
    if radius is None and internal:
        gear = replace(pair.rack_gear(drawn.teeth, cut, root, cutter), tip_radius=0.5 * tip)
        radius, why = ring_drawing().tip_radius_of_fillet(gear, standard[2])
        derived.append(Derived(f"{name} tip radius of the {'cutter' if cutter else 'fillet'}", radius, "modules", why))
    elif radius is None:
        room = tip_radius_with_room(replace(pair.rack_gear(drawn.teeth, cut, root), protuberance=beyond))
        less = f"what has room on the rack's tip, less than the usual {standard[2]:g}"
        why = less if room < standard[2] else "that of the rack"
        radius = min(standard[2], room)
        derived.append(Derived(f"{name} tip radius of the rack", radius, "modules", why))
    # Bare numbers leave their spelling behind.
    data = GearData(
        drawn.teeth, float(cut), float(tip), float(root), 0.0, float(radius),
        tip_chamfer=float(drawn.tip_chamfer or 0.0), protuberance=beyond, protuberance_angle=angle,
        nominal_profile_shift=None if shift == cut else float(shift), cutter=cutter,
        support=ring_drawing().support_of(drawn) if internal else None,
    )  # fmt: skip
    if drawn.measure is not None:
        _thickness().check_measure(drawn, name, pair.in_rotation(data))
    return data, derived


def _root(pair: Gears, drawn: GearText, cut: float, dedendum: float) -> tuple[float, str]:
    """Root diameter, mm, of rack or cutter, and how it follows."""
    reference = pair.module * drawn.teeth / cos(pair.helix_angle or 0.0)
    by_rack = reference + 2.0 * pair.module * (cut - dedendum)
    if drawn.teeth > 0 or drawn.cutter is None:
        return by_rack, "d_f = d + 2 m_n (x_E - h_fP)" + ("" if drawn.teeth > 0 else SIGNED)
    gear = pair.rack_gear(drawn.teeth, cut, by_rack, ring_drawing().cutter_of(drawn))
    root = ring_drawing().root_of_cutter(pair, gear, dedendum)
    return (by_rack, "by the rack") if root is None else (root, "d_f = 2 a_0 + d_a0 of the cutter")


def ring_drawing() -> ModuleType:
    """What only internal gears need."""
    from . import ring_drawing

    return ring_drawing
