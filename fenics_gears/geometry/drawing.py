"""What a drawing leaves out: diameters, centre distance, tip radius of the rack and tooth thickness, from module, teeth, profile shifts and rack.

ISO 21771 (DIN 3960), in normal modules: d_a = d + 2 m_n (x + h_aP + k), d_f = d + 2 m_n (x_E - h_fP), inv(alpha_wt) = inv(alpha_t) + 2 (x1 + x2)
tan(alpha_n)/(z1 + z2). x is the profile shift of the drawing and x_E that of the thickness, at which the rack cuts flanks and root; they differ by the
allowance where a thickness or a backlash is given beside x. k shortens the tips, so that their clearance stays the rack's when a is less than a_d + (x1 + x2) m_n.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import cos, floor, sqrt, tan

from fenics_gears.geometry import tooth_thickness
from fenics_gears.geometry.gear import Gear, transverse_gear
from fenics_gears.geometry.gear_checks import refuse
from fenics_gears.geometry.gear_data import GearData
from fenics_gears.geometry.involute import inverse_involute, involute_function

# ISO 53:1998, Annex A, in modules: addendum, dedendum, tip radius of the rack. The same as types A to D of GOST 13755-2015; A is also the rack of DIN 867.
RACKS = {"ISO 53 A": (1.0, 1.25, 0.38), "ISO 53 B": (1.0, 1.25, 0.3), "ISO 53 C": (1.0, 1.25, 0.25), "ISO 53 D": (1.0, 1.4, 0.39)}
# A derived tip radius is rounded down to so many parts of a module, so that both roundings of the rack's tip fit.
STEPS_OF_TIP_RADIUS = 10_000
# Largest difference, in modules, of the profile shift of a thickness from that of the drawing: more is another number of spanned teeth or another gear.
LARGEST_ALLOWANCE = 0.5
# Largest profile shift that a thickness alone may stand for: one spanned tooth more or less is a shift of pi/(2 tan(alpha_n)), 4.3 at 20 deg.
LARGEST_SHIFT = 2.0
NAMES = ("pinion", "wheel")
FIXED_POINT_STEPS = 100


@dataclass(frozen=True)
class Derived:
    """A figure that a scene leaves out: what `gears check` calls it, its value and unit, and the formula that it comes from."""

    name: str
    value: object
    unit: str
    formula: str


@dataclass(frozen=True)
class Rack:
    """The rack in normal modules; `tip_radius` is None where the scene gives none: `standard_tip_radius`, or what has room."""

    addendum: float
    dedendum: float
    tip_radius: float | None
    standard_tip_radius: float


@dataclass(frozen=True)
class DrawnGear:
    """What is known of a gear; None is not given. At most one of the measures of its thickness, all in mm. `protuberance`: its amount beyond the finished flank, mm, and its angle, rad."""

    teeth: int
    rack: Rack
    profile_shift: float | None = None
    tip_diameter: float | None = None
    root_diameter: float | None = None
    tooth_thickness: float | None = None
    base_tangent_length: float | None = None
    spanned_teeth: int | None = None
    dimension_over_balls: float | None = None
    ball_diameter: float | None = None
    protuberance: tuple[float, float] = (0.0, 0.0)

    @property
    def measured(self) -> bool:
        """Whether its thickness is given."""
        return (self.tooth_thickness, self.base_tangent_length, self.dimension_over_balls) != (None, None, None)


@dataclass(frozen=True)
class DrawnPair:
    """What both gears share, mm and rad; `backlash`: circumferential, at the pitch circle; `tip_shortening` -k in modules."""

    module: float
    pressure_angle: float
    helix_angle: float
    centre_distance: float | None
    backlash: float | None
    tip_shortening: float | None


def completed(pair: DrawnPair, drawn: tuple[DrawnGear, DrawnGear]) -> tuple[float, tuple[GearData, GearData], list[Derived]]:
    """Centre distance, mm, both gears (without bore, face width and material), and what was derived. Raises GeometryError for an impossible figure."""
    found: list[Derived] = []
    cut = [_cut(pair, gear, name, found) for gear, name in zip(drawn, NAMES)]
    shifts = [gear.profile_shift if gear.profile_shift is not None else own for gear, own in zip(drawn, cut)]
    distance = _centre_distance(pair, drawn, shifts, cut, found)
    if pair.backlash is not None and not drawn[0].measured:
        cut = _thinned(pair, drawn, cut, distance, found)
    shortening = _tip_shortening(pair, drawn, shifts, distance, found)
    gears = tuple(_gear_data(pair, *each, shortening, found) for each in zip(drawn, NAMES, shifts, cut))
    found += [figure for each in zip(drawn, NAMES, cut) for figure in _asked_measures(pair, *each)]
    return distance, gears, found


def rack_gear(pair: DrawnPair, teeth: int, shift: float, root_diameter: float = 0.0) -> Gear:
    """The transverse section of a gear of which only rack, teeth and profile shift (normal modules) are known, and perhaps the root."""
    return transverse_gear(GearData(teeth, shift, 0.0, root_diameter, 0.0, 0.0), pair.module, pair.pressure_angle, pair.helix_angle)


def _cut(pair: DrawnPair, drawn: DrawnGear, name: str, found: list[Derived]) -> float:
    """The profile shift of the gear's thickness."""
    gear = rack_gear(pair, drawn.teeth, 0.0)
    if drawn.tooth_thickness is not None:
        field, formula = "tooth_thickness", "s_n = m_n (pi/2 + 2 x tan(alpha_n))"
        shift = tooth_thickness.shift_of_normal_thickness(gear, drawn.tooth_thickness)
    elif drawn.base_tangent_length is not None:
        field, formula = "base_tangent_length", f"of the base tangent length W_{drawn.spanned_teeth}"
        shift = tooth_thickness.shift_of_base_tangent_length(gear, drawn.base_tangent_length, drawn.spanned_teeth)
    elif drawn.dimension_over_balls is not None:
        field, formula = "dimension_over_balls", f"of the dimension over balls of {drawn.ball_diameter:g} mm"
        shift = tooth_thickness.shift_of_dimension_over_balls(gear, drawn.dimension_over_balls, drawn.ball_diameter)
    else:
        return drawn.profile_shift
    _check_shift(drawn, name, field, shift)
    beside = drawn.profile_shift is not None
    words = "profile shift of its tooth thickness" if beside else "profile shift"
    found.append(Derived(f"{name} {words}", shift, "modules", formula))
    return shift


def _check_shift(drawn: DrawnGear, name: str, field: str, shift: float | None) -> None:
    """A measured thickness is that of a tooth and, beside a profile shift, of the same gear."""
    given = f"gears.{name}.{field} = {getattr(drawn, field):.6g} mm"
    if shift is None:
        refuse(name, f"{given} with balls of {drawn.ball_diameter:g} mm: their centres would lie within the base circle: check gears.{name}.ball_diameter and the teeth")
    check = {"base_tangent_length": f", gears.{name}.spanned_teeth", "dimension_over_balls": f", gears.{name}.ball_diameter"}.get(field, "")
    if drawn.profile_shift is None and abs(shift) > LARGEST_SHIFT:
        refuse(name, f"{given} is that of a profile shift of {shift:.4g}, allowed are {LARGEST_SHIFT:g} modules either way: check it{check} and gears.module")
    if drawn.profile_shift is not None and abs(shift - drawn.profile_shift) > LARGEST_ALLOWANCE:
        refuse(
            name,
            f"{given} is that of a profile shift of {shift:.4g}, but gears.{name}.profile_shift is {drawn.profile_shift:g}; allowed for the allowance of the "
            f"thickness are up to {LARGEST_ALLOWANCE} modules: check it{check}, or leave profile_shift out",
        )


def _centre_distance(pair: DrawnPair, drawn: tuple[DrawnGear, DrawnGear], shifts: list[float], cut: list[float], found: list[Derived]) -> float:
    """As given, or that of the profile shifts without backlash, or of both measured thicknesses with the given backlash."""
    if pair.centre_distance is not None:
        return pair.centre_distance
    opened = pair.backlash is not None and drawn[0].measured
    gears = [rack_gear(pair, gear.teeth, shift) for gear, shift in zip(drawn, cut if opened else shifts)]
    bases = gears[0].base_radius + gears[1].base_radius
    both_teeth = sum(gear.base_radius * gear.tooth_half_angle_at_base for gear in gears) - 0.5 * gears[0].base_pitch
    roll = 0.0
    for _ in range(FIXED_POINT_STEPS if opened else 1):
        # A gap j_wt at the pitch circles is one of j_wt cos(alpha_wt) along the line of action.
        gap = (pair.backlash or 0.0) / sqrt(1.0 + roll**2) if opened else 0.0
        last, roll = roll, inverse_involute((both_teeth + 0.5 * gap) / bases)
        if roll == 0.0:
            refuse("pair", "no centre distance: the teeth are so thin that the base circles would overlap: raise gears.pinion.profile_shift or gears.wheel.profile_shift")
        if abs(roll - last) < 1e-15:
            break
    distance = bases * sqrt(1.0 + roll**2)
    words = "both tooth thicknesses and the backlash" if opened else "inv(alpha_wt) = inv(alpha_t) + 2 (x1 + x2) tan(alpha_n)/(z1 + z2), without backlash"
    found.append(Derived("centre distance", distance, "mm", words))
    return distance


def _thinned(pair: DrawnPair, drawn: tuple[DrawnGear, DrawnGear], cut: list[float], distance: float, found: list[Derived]) -> list[float]:
    """Profile shifts of both thicknesses, each lowered by the same amount, so that the pair has its backlash."""
    gears = [rack_gear(pair, gear.teeth, shift) for gear, shift in zip(drawn, cut)]
    cosine = (gears[0].base_radius + gears[1].base_radius) / distance
    if cosine >= 1.0:
        return cut
    swept = float(involute_function(sqrt(1.0 / cosine**2 - 1.0)))
    gap = gears[0].base_pitch - 2.0 * sum(gear.base_radius * (gear.tooth_half_angle_at_base - swept) for gear in gears)
    # Thickness 2 r_b psi_b along the line of action, per unit of x: 2 m_t cos(alpha_t) tan(alpha_n).
    each = 0.5 * (pair.backlash * cosine - gap) / (2.0 * gears[0].module * cos(gears[0].pressure_angle) * tan(pair.pressure_angle))
    if each < -1e-9:
        refuse(
            "pair",
            f"gears.backlash = {pair.backlash:.4g} mm, but teeth with these profile shifts already have {gap / cosine:.4g} mm at centre distance {distance:.6g} mm, and "
            "backlash is made by thinner teeth: lower gears.centre_distance or raise the profile shifts",
        )
    lowered = [shift - max(each, 0.0) for shift in cut]
    found += [Derived(f"{name} profile shift of its tooth thickness", shift, "modules", "half of the backlash by each gear") for name, shift in zip(NAMES, lowered)]
    return lowered


def _tip_shortening(pair: DrawnPair, drawn: tuple[DrawnGear, DrawnGear], shifts: list[float], distance: float, found: list[Derived]) -> float:
    """-k: as given, or what keeps the rack's tip clearance; never negative."""
    if pair.tip_shortening is not None:
        return pair.tip_shortening
    if all(gear.tip_diameter is not None for gear in drawn):
        return 0.0
    reference = 0.5 * pair.module * sum(gear.teeth for gear in drawn) / cos(pair.helix_angle)
    shortening = max(0.0, sum(shifts) - (distance - reference) / pair.module)
    found.append(Derived("tip shortening -k", shortening, "modules", "k m_n = a - a_d - (x1 + x2) m_n, where negative"))
    return shortening


def _gear_data(pair: DrawnPair, drawn: DrawnGear, name: str, shift: float, cut: float, shortening: float, found: list[Derived]) -> GearData:
    reference, rack = pair.module * drawn.teeth / cos(pair.helix_angle), drawn.rack
    tip, root = drawn.tip_diameter, drawn.root_diameter
    if tip is None:
        tip = reference + 2.0 * pair.module * (shift + rack.addendum - shortening)
        found.append(Derived(f"{name} tip diameter", tip, "mm", "d_a = d + 2 m_n (x + h_aP + k)"))
    if root is None:
        root = reference + 2.0 * pair.module * (cut - rack.dedendum)
        found.append(Derived(f"{name} root diameter", root, "mm", "d_f = d + 2 m_n (x_E - h_fP)"))
    radius = rack.tip_radius
    if radius is None:
        room = replace(rack_gear(pair, drawn.teeth, cut, root), protuberance=drawn.protuberance[0]).largest_rack_tip_radius / pair.module
        radius = min(rack.standard_tip_radius, max(0.0, floor((room - 1e-9) * STEPS_OF_TIP_RADIUS) / STEPS_OF_TIP_RADIUS))
        why = f"what has room on the rack's tip, less than the usual {rack.standard_tip_radius:g}" if radius < rack.standard_tip_radius else "that of the rack"
        found.append(Derived(f"{name} tip radius of the rack", radius, "modules", why))
    return GearData(drawn.teeth, cut, tip, root, 0.0, radius, protuberance=drawn.protuberance[0], protuberance_angle=drawn.protuberance[1])


def _asked_measures(pair: DrawnPair, drawn: DrawnGear, name: str, cut: float) -> Iterator[Derived]:
    """What a caliper reads over the teeth, and over the balls, that a drawing names without the measure."""
    gear = rack_gear(pair, drawn.teeth, cut)
    if drawn.spanned_teeth is not None and drawn.base_tangent_length is None:
        length = tooth_thickness.base_tangent_length(gear, drawn.spanned_teeth)
        yield Derived(f"{name} base tangent length over {drawn.spanned_teeth} teeth", length, "mm", "W_k = m_n cos(alpha_n) [pi (k - 1/2) + z inv(alpha_t) + 2 x tan(alpha_n)]")
    if drawn.ball_diameter is not None and drawn.dimension_over_balls is None:
        dimension = tooth_thickness.dimension_over_balls(gear, drawn.ball_diameter)
        yield Derived(f"{name} dimension over balls of {drawn.ball_diameter:g} mm", dimension, "mm", "M_d by inv(alpha_K) = D_M/(d_b cos(beta_b)) + psi_b - pi/z")
