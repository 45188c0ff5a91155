"""The gears of a stage: their teeth, circles and material, as the file gives them, as they follow from it, or as the standard has them."""

from __future__ import annotations

from dataclasses import dataclass
from math import isclose

from fenics_gears.scene.rexs.model import Component
from fenics_gears.scene.rexs.reading import Place, Reading, agreed, first_number, first_quantity, given, needed, positive
from fenics_gears.scene.rexs.shifts import profile_shifts
from fenics_gears.scene.rexs.stage import GearParts, Stage
from fenics_gears.scene.rexs.values import Value, ValueProblem, bare, computed, number_of, place, quantity_of, unquoted, whole_number_of

# ISO 53, basic rack A: addendum, dedendum and tip radius of the rack's tooth, in modules.
ADDENDUM, DEDENDUM, RACK_TIP_RADIUS = 1.0, 1.25, 0.38
# A gear without a known bore: the rim is thick enough not to matter.
BORE = 0.4
# ISO 6336-1: Young's modulus (N/mm^2) and Poisson's ratio of steel.
STEEL = (206e3, 0.3)
# A diameter that repeats module and teeth may be rounded, in modules.
ROUNDED = 1e-3


@dataclass(frozen=True)
class GearValues:
    """The fields of ``[gears.pinion]`` or ``[gears.wheel]``."""

    teeth: Value | None
    profile_shift: Value | None
    tip_diameter: Value | None
    root_diameter: Value | None
    bore_diameter: Value | None
    rack_tip_radius: Value | None


@dataclass(frozen=True)
class PairValues:
    """The fields of ``[gears]``, with those of either gear and of the material."""

    module: Value | None
    pressure_angle: Value | None
    centre_distance: Value | None
    face_width: Value | None
    pinion: GearValues
    wheel: GearValues
    youngs_modulus: Value | None
    poissons_ratio: Value | None


def pair_values(reading: Reading, stage: Stage) -> PairValues:
    """The gears of a stage; None for what could not be found, which the reading's problems then tell."""
    for part in stage.gears:
        reading.attempt(_check_spur, part.gear)
    module, angle = reading.attempt(_module, stage), reading.attempt(_pressure_angle, stage)
    distance = reading.attempt(_length, stage.stage, "center_distance")
    teeth = [reading.attempt(_teeth, part.gear) for part in stage.gears]
    shifts = profile_shifts(reading, stage, module, angle, distance, teeth)
    gears = [_gear_values(reading, part, module, *own) for part, *own in zip(stage.gears, teeth, shifts)]
    for part, values in zip(stage.gears, gears):
        reading.attempt(_check_reference_diameter, part.gear, module, values.teeth)
    reading.attempt(_check_sum_of_shifts, stage, *shifts)
    modulus, ratio = reading.attempt(_material, stage) or (None, None)
    return PairValues(module, angle, distance, reading.attempt(_face_width, stage), *gears, modulus, ratio)


def _length(component: Component, name: str) -> Value:
    return positive(needed(first_quantity([(component, name)], "mm"), [(component, name)]), component, name)


def _module(stage: Stage) -> Value:
    modules = [_length(part.gear, "normal_module") for part in stage.gears]
    return agreed(modules, "The gears have different modules")


def _check_spur(gear: Component) -> None:
    for component, name in given([(gear, "helix_angle_reference_diameter")]):
        angle = quantity_of(component, name, "deg")
        if abs(angle.number) > 1e-9:
            raise ValueProblem(f"{place(gear, name)} = {unquoted(angle)}: a helical gear. Spur gears are computed only, whose helix angle is 0.")


def _flank_places(part: GearParts, *names: str) -> list[Place]:
    return [(flank, name) for flank in part.flanks.values() for name in names]


def _pressure_angle(stage: Stage) -> Value:
    angles = []
    for part in stage.gears:
        places = _flank_places(part, "normal_pressure_angle") or [(part.gear, "normal_pressure_angle")]
        places += [(tool, "normal_pressure_angle") for tool in part.tools]
        own = agreed([quantity_of(*each, "deg") for each in given(places)], "The flanks and tools of a gear have different pressure angles")
        angles.append(needed(own, places))
    return agreed(angles, "The gears have different pressure angles")


def _face_width(stage: Stage) -> Value:
    common = first_quantity([(stage.stage, "common_face_width")], "mm")
    if common is not None:
        return positive(common, stage.stage, "common_face_width")
    widths = [_length(part.gear, "face_width") for part in stage.gears]
    narrow = min(widths, key=lambda width: width.number)
    if isclose(widths[0].number, widths[1].number):
        return agreed(widths, "")
    return Value(narrow.number, narrow.written, f"{narrow.origin}, the narrower gear")


def _gear_values(reading: Reading, part: GearParts, module: Value | None, teeth: Value | None, shift: Value | None) -> GearValues:
    gear = part.gear
    tip_stated, root_stated = (name in gear.attributes for name in ("tip_diameter", "root_diameter"))
    tip = reading.attempt(_length, gear, "tip_diameter") if tip_stated else reading.attempt(_tip_diameter, part, module, teeth, shift)
    root = reading.attempt(_length, gear, "root_diameter") if root_stated else reading.attempt(_root_diameter, part, module, teeth, shift, tip)
    return GearValues(teeth, shift, tip, root, reading.attempt(_bore_diameter, part, root), reading.attempt(_rack_tip_radius, part, module))


def _teeth(gear: Component) -> Value:
    places = [(gear, "number_of_teeth")]
    return positive(needed(next((whole_number_of(*each) for each in given(places)), None), places), gear, "number_of_teeth")


def _tip_diameter(part: GearParts, module: Value, teeth: Value, shift: Value) -> Value:
    """What the addendum of the flanks gives, or the standard's."""
    addendum = first_number(_flank_places(part, "addendum_coefficient_basic_profile"))
    modules = ADDENDUM if addendum is None else addendum.number
    number = module.number * (teeth.number + 2.0 * (shift.number + modules))
    source = f"the addendum of ISO 53, {modules} modules" if addendum is None else f"{addendum.origin}, {modules} modules"
    return computed(number, 1.0, "mm", f"no tip_diameter; from teeth, profile shift and {source}", assumed=addendum is None)


def _root_diameter(part: GearParts, module: Value, teeth: Value, shift: Value, tip: Value) -> Value:
    """What the depth of the teeth gives, or the tool."""
    depth = first_quantity([(part.gear, "tooth_depth")], "mm")
    if depth is not None:
        return computed(tip.number - 2.0 * depth.number, 1.0, "mm", f"no root_diameter; tip diameter less twice {depth.origin}")
    return _cut_root_diameter(part, module, teeth, shift)


def _cut_root_diameter(part: GearParts, module: Value, teeth: Value, shift: Value) -> Value:
    """What the rack cuts: its addendum deep, at the shift of its generating where that is given."""
    name = "generated_addendum_modification_coefficient"
    generated = first_number([(each, name) for each in part.settings] + _flank_places(part, name))
    at = "profile shift" if generated is None else generated.origin
    addendum = _in_modules(part, module, "addendum_coefficient_reference_profile", "addendum_reference_profile")
    modules = DEDENDUM if addendum is None else addendum.number
    number = module.number * (teeth.number + 2.0 * ((generated or shift).number - modules))
    source = f"the dedendum of ISO 53, {modules} modules" if addendum is None else f"{addendum.origin}, {modules} modules"
    return computed(number, 1.0, "mm", f"no root_diameter; from teeth, {at} and {source}", assumed=addendum is None)


def _rack_tip_radius(part: GearParts, module: Value) -> Value:
    radius = _in_modules(part, module, "tip_radius_factor", "tip_radius")
    # Their names in version 2.
    radius = radius or _in_modules(part, module, "tip_corner_radius_factor_reference_profile", "tip_corner_radius_reference_profile")
    return radius or Value(RACK_TIP_RADIUS, bare(RACK_TIP_RADIUS), "no tip radius of the tool; that of ISO 53", assumed=True)


def _in_modules(part: GearParts, module: Value, coefficient: str, length: str) -> Value | None:
    """A measure of the tool that made the root, the first one that there is, in modules."""
    for tool in part.tools[:1]:
        own = first_quantity([(tool, "normal_module")], "mm")
        if own is not None:
            agreed([module, own], "The tool has another module than the gear")
        factor, millimetres = first_number([(tool, coefficient)]), first_quantity([(tool, length)], "mm")
        relative = millimetres and Value(millimetres.number / module.number, bare(millimetres.number / module.number), f"{millimetres.origin}, over the module")
        return agreed([factor, relative], f"{tool} contradicts itself")
    return None


def _bore_diameter(part: GearParts, root: Value) -> Value:
    places = [(part.gear, "inner_diameter"), *((body, "inner_diameter") for body in part.bodies)]
    bore = first_quantity(places, "mm")
    if bore is not None and bore.number < 0.0:
        raise ValueProblem(f"{place(*given(places)[0])} = {unquoted(bore)} is negative.")
    if bore is not None and bore.number > 0.0:
        return bore
    why = "no inner_diameter" if bore is None else f"{bore.origin} is 0, a solid gear"
    return computed(BORE * root.number, 1.0, "mm", f"{why}; {BORE} of the root diameter, held rigidly", assumed=True)


def _material(stage: Stage) -> tuple[Value, Value]:
    materials = [material for part in stage.gears for material in part.materials[:1]]
    if not materials:
        return (
            computed(STEEL[0], 1e3, "GPa", "no material; that of steel (ISO 6336-1)", assumed=True),
            Value(STEEL[1], bare(STEEL[1]), "no material; that of steel (ISO 6336-1)", assumed=True),
        )
    modulus, ratio = [], []
    for material in materials:
        stiffness = first_quantity([(material, "elastic_modulus")], "MPa")
        modulus.append(positive(needed(stiffness, [(material, "elastic_modulus")]), material, "elastic_modulus"))
        ratio.append(needed(first_number([(material, "poisson_ratio")]), [(material, "poisson_ratio")]))
    different = "The gears have different materials, a scene has one for both"
    return agreed(modulus, different), agreed(ratio, different)


def _check_reference_diameter(gear: Component, module: Value, teeth: Value) -> None:
    """A reference diameter, where the file repeats it, is that of module and teeth."""
    for component, name in given([(gear, "reference_circle_diameter"), (gear, "reference_diameter_cylindrical_gear")]):
        stated = quantity_of(component, name, "mm")
        if abs(stated.number - module.number * teeth.number) > ROUNDED * module.number:
            raise ValueProblem(
                f"{place(gear, name)} = {unquoted(stated)} contradicts its module and its {teeth.number} teeth, "
                f"which give {module.number * teeth.number:.6g} mm."
            )


def _check_sum_of_shifts(stage: Stage, pinion: Value, wheel: Value) -> None:
    for component, name in given([(stage.stage, "sum_of_addendum_modification_coefficients")]):
        stated = number_of(component, name)
        if abs(stated.number - pinion.number - wheel.number) > ROUNDED:
            raise ValueProblem(
                f"{place(component, name)} = {stated.written} contradicts the profile shifts of its gears, "
                f"{pinion.written} and {wheel.written}."
            )
