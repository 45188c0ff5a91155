"""The tooth thickness of a gear as a drawing has it, measured by caliper, span or balls. Loaded where a drawing has a
measure."""

from collections.abc import Iterator

from fenics_gears.geometry import tooth_thickness
from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.gear_checks import refuse
from fenics_gears.geometry.gear_data import ROUNDING

from . import unusual
from .gear_schema import MEASURES, Gears, GearText
from .schema import Derived

# Largest difference, in modules, of the profile shift of a thickness from that of the drawing, and largest profile
# shift that a thickness alone may mean. One spanned tooth more or less is a shift of 4.3 at 20 deg.
LARGEST_ALLOWANCE = 0.5
LARGEST_SHIFT = 2.0


def shift_of_thickness(pair: Gears, drawn: GearText, name: str) -> tuple[float, list[Derived]]:
    """The profile shift of the gear's measured thickness, and what was derived."""
    gear = pair.rack_gear(drawn.teeth, 0.0)
    measure = drawn.measure
    beside = MEASURES[measure]
    written = f"gears.{name}.{measure} = {getattr(drawn, measure):.6g} mm" + (
        f" with {beside} {getattr(drawn, beside):g}" if beside else ""
    )
    if measure == "tooth_thickness":
        shift = tooth_thickness.shift_of_normal_thickness(gear, drawn.tooth_thickness)
    elif measure == "base_tangent_length":
        shift = tooth_thickness.shift_of_base_tangent_length(gear, drawn.base_tangent_length, drawn.spanned_teeth)
    else:
        shift = tooth_thickness.shift_of_dimension_over_balls(gear, drawn.dimension_over_balls, drawn.ball_diameter)
    if shift is None:
        refuse(name, f"{written}: the centres of the balls would lie within the base circle: check both, and the teeth")
    nominal, allowed = (0.0, LARGEST_SHIFT) if drawn.profile_shift is None else (drawn.profile_shift, LARGEST_ALLOWANCE)
    if abs(shift - nominal) > allowed:
        than = f"profile_shift = {nominal:g}" if nominal else "none"
        refuse(
            name,
            f"{written} is that of a profile shift of {shift:.4g}; allowed are {allowed:g} modules more or less than"
            f" {than}: check both, and gears.module",
        )
    if drawn.profile_shift is None:
        words = "profile shift"
        odd = unusual.of_profile_shift(name, shift)
    else:
        words = "profile shift of its tooth thickness"
        odd = unusual.of_allowance(pair, name, shift - nominal, pair.centre_distance or 0.0)
    return shift, [Derived(f"{name} {words}", shift, "modules", f"of its {measure.replace('_', ' ')}", odd)]


def check_measure(drawn: GearText, name: str, gear: Gear) -> None:
    """Caliper and balls touch the involute, and balls protrude from the tip circle and clear the root."""
    lowest = gear.form_radius
    measure = drawn.measure
    if measure == "tooth_thickness":
        return
    if measure == "base_tangent_length":
        touched = tooth_thickness.tangent_contact_radius(gear, drawn.base_tangent_length)
        better = f"{tooth_thickness.spanned_teeth(gear)}"
    else:
        touched = tooth_thickness.ball_contact_radius(gear, drawn.ball_diameter)
        better = f"about {tooth_thickness.ball_diameter(gear):.4g} mm"
        centre = tooth_thickness.ball_centre(gear, drawn.ball_diameter)
        radius = 0.5 * drawn.ball_diameter
        if centre + radius < gear.tip_radius:
            refuse(
                name,
                f"gears.{name}.ball_diameter = {drawn.ball_diameter:g} mm: the balls lie within the tip circle of"
                f" {2.0 * gear.tip_radius:.6g} mm: take {better}",
            )
    if not lowest - ROUNDING <= touched <= gear.tip_form_radius + ROUNDING:
        refuse(
            name,
            f"gears.{name}.{measure} = {getattr(drawn, measure):.6g} mm would be measured at diameter"
            f" {2.0 * touched:.6g} mm, off the involute, which goes from {2.0 * lowest:.6g} to"
            f" {2.0 * gear.tip_form_radius:.6g} mm: measure with gears.{name}.{MEASURES[measure]} {better}",
        )


def asked_measures(pair: Gears, drawn: GearText, name: str, cut: float) -> Iterator[Derived]:
    """What a caliper reads over the teeth, and over the balls, that a drawing names without the measure."""
    gear = pair.rack_gear(drawn.teeth, cut)
    if drawn.spanned_teeth is not None and drawn.base_tangent_length is None:
        length = tooth_thickness.base_tangent_length(gear, drawn.spanned_teeth)
        formula = "W_k = m_n cos(alpha_n) [pi (k - 1/2) + z inv(alpha_t) + 2 x tan(alpha_n)]"
        yield Derived(f"{name} base tangent length over {drawn.spanned_teeth} teeth", length, "mm", formula)
    if drawn.ball_diameter is not None and drawn.dimension_over_balls is None:
        dimension = tooth_thickness.dimension_over_balls(gear, drawn.ball_diameter)
        formula = "M_d by inv(alpha_K) = D_M/(d_b cos(beta_b)) + psi_b - pi/z"
        yield Derived(f"{name} dimension over balls of {drawn.ball_diameter:g} mm", dimension, "mm", formula)
