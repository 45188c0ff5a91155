"""The gears of a stage: teeth, circles and material, given by the file, computed from it, or the standard's."""

from dataclasses import replace
from functools import partial
from math import acos, atan, cos, hypot, isclose, tan

from fenics_gears import RACKS, USUAL_BORE, inverse_involute, involute_function, sum_of_profile_shifts

from .attributes import Reading, every, first, given, missing, needed, places
from .placing import distance_of_positions, offset_of_wheel
from .shaft_parts import diameter_at
from .stage import GearParts, Stage
from .values import NUMBER, SAME, Value, ValueProblem, agreed, bare, computed, place, together

# By the section of a scene ("gears.pinion"), its fields; None for what was not found, which is among the reading's
# problems.
Sections = dict[str, dict[str, Value | None]]
STANDARD = "ISO 53 A"
ADDENDUM, DEDENDUM, _ = RACKS[STANDARD]
MATERIAL = ("youngs_modulus", "poissons_ratio")
# A shaft that is thicker, over the root diameter, is one piece with the gear.
THICK_SHAFT = 0.7
# Rounding that is allowed where the file repeats module, teeth or shifts, in modules.
ROUNDED = 1e-3
# Helix angle, rad, of gears that are spur.
NO_HELIX = 1e-9


def gear_sections(reading: Reading, stage: Stage) -> Sections:
    """``[gears]`` and the sections below it."""
    helix = reading.attempt(_helix, stage) or {}
    beta = helix["helix_angle"].number if helix else 0.0
    module = reading.attempt(_module, stage)
    angle = reading.attempt(_pressure_angle, stage)
    distance = reading.attempt(_distance, stage)
    parts = stage.named.values()
    teeth = [reading.attempt(needed, part, "teeth") for part in parts]
    shifts = _profile_shifts(reading, stage, module, angle, distance, teeth, beta)
    if distance is None and not given(stage, "centre_distance"):
        distance = reading.attempt(distance_of_shifts, beta, module, angle, *teeth, *shifts)
    gears = [_gear_section(reading, part, beta, module, *own) for part, *own in zip(parts, teeth, shifts)]
    for part, count in zip(parts, teeth):
        reading.attempt(_check_reference_diameter, part, beta, module, count)
    reading.attempt(_check_sum_of_shifts, stage, *shifts)
    pair = {"module": module, "pressure_angle": angle, **helix, "centre_distance": distance}
    widths = reading.attempt(_face_widths, stage) or [None]
    if len(widths) == 1:
        pair["face_width"] = widths[0]
    else:
        gears = [{**gear, "face_width": width} for gear, width in zip(gears, widths)]
    if widths[-1] is not None and (offset := reading.attempt(_offset, stage, widths)) is not None:
        gears[1]["axial_offset"] = offset
    why = "no tip radius of the tool; that of ISO 53, or what has room on the rack's tip"
    rack = {"profile": Value(0.0, f'"{STANDARD}"', why, assumed=True)}
    named = {f"gears.{name}": gear for name, gear in zip(stage.named, gears)}
    racks = {f"{name}.rack": rack for name, gear in named.items() if "rack_tip_radius" not in gear}
    return {"gears": pair, **named, **racks, **(reading.attempt(_materials, stage) or {})}


def _module(stage: Stage) -> Value:
    return agreed([needed(part, "module") for part in stage.named.values()], "The gears have different modules")


def _helix(stage: Stage) -> dict[str, Value | None]:
    """Helix angle and hand of the pinion; empty for spur gears. A positive angle is a right-hand helix (ISO 21771)."""
    pinion, wheel = (first(part, "helix_angle") for part in stage.named.values())
    there = [angle for angle in (pinion, wheel) if angle is not None]
    if not any(abs(angle.number) > NO_HELIX for angle in there):
        return {}
    if len(there) == 2 and abs(pinion.number + wheel.number) > ROUNDED * abs(pinion.number):
        raise ValueProblem(
            f"{stage.stage}: {pinion.origin} is {pinion.words}, {wheel.origin} is {wheel.words}. Allowed on parallel"
            " axes: the same angle with opposite signs."
        )
    angle = there[0]
    origin = together(each.origin for each in there)
    hand = "right" if (angle.number > 0.0) == (pinion is not None) else "left"
    return {
        "helix_angle": Value(abs(angle.number), angle.written.replace('"-', '"'), origin),
        "pinion_hand": Value(0.0, f'"{hand}"', f"the sign of {origin}"),
    }


def transverse_angle(angle: float, beta: float) -> float:
    """Pressure angle (rad) of the transverse section: tan(alpha_t) = tan(alpha_n)/cos(beta)."""
    return atan(tan(angle) / cos(beta)) if beta else angle


def _pressure_angle(stage: Stage) -> Value:
    angles = []
    for part in stage.named.values():
        own = agreed(every(part, "pressure_angle"), "The flanks and tools of a gear have different pressure angles")
        angles.append(own or needed(part, "pressure_angle"))
    return agreed(angles, "The gears have different pressure angles")


def _face_widths(stage: Stage) -> list[Value]:
    """One for both gears, or one of each. Where the common width is less than both, the file does not say at which ends
    they are wider, and the common width holds for both."""
    common = first(stage, "common_face_width")
    own = [first(part, "face_width") for part in stage.named.values()]
    widths = [width for width in own if width is not None]
    if common is not None and len(widths) < 2:
        return [common]
    if len(widths) < 2:
        widths = [needed(part, "face_width") for part in stage.named.values()]
    if common is not None and not isclose(common.number, min(width.number for width in widths), rel_tol=SAME):
        return [common]
    return [agreed(widths, "")] if isclose(widths[0].number, widths[1].number, rel_tol=SAME) else widths


def _offset(stage: Stage, widths: list[Value]) -> Value | None:
    """The offset of the wheel; None where only the width that both have in common is taken."""
    own = [first(part, "face_width") for part in stage.named.values()]
    taken = widths * (3 - len(widths))
    if any(each is None or not isclose(each.number, width.number, rel_tol=SAME) for each, width in zip(own, taken)):
        return None
    return offset_of_wheel(stage, min(width.number for width in widths))


def _profile_shifts(
    reading: Reading, stage: Stage, module, angle, distance, teeth: list[Value | None], beta: float
) -> list[Value | None]:
    """The shift of both gears, as the file gives them, or as the centre distance leaves one of them."""
    parts = stage.named.values()
    shifts = [reading.attempt(partial(_stated_shift, part, module)) for part in parts]
    unsaid = [number for number, part in enumerate(parts) if not given(part, "profile_shift")]
    if len(unsaid) == 2:
        pinion = place(stage.pinion.gear, "addendum_modification_coefficient")
        name = stage.wheel.gear.id
        reading.problems.append(f"{pinion} is missing, for its flanks too, and so is that of component {name}.")
    elif unsaid and distance is None and not given(stage, "centre_distance"):
        shift = (list(parts)[unsaid[0]].gear, "addendum_modification_coefficient", NUMBER)
        reading.problems.append(str(missing(*places(stage, "centre_distance"), shift)))
    elif unsaid:
        known = shifts[1 - unsaid[0]]
        shifts[unsaid[0]] = reading.attempt(_remaining_shift, stage, beta, known, module, angle, distance, *teeth)
    return shifts


def _distance(stage: Stage) -> Value | None:
    """The centre distance that is stated, or that of the places of both gears."""
    return first(stage, "centre_distance") or distance_of_positions(stage)


def distance_of_shifts(beta: float, module: Value, angle: Value, *teeth_and_shifts: Value) -> Value:
    """The centre distance at which both profile shifts leave no backlash (ISO 21771)."""
    teeth, shifts = (sum(each.number for each in both) for both in (teeth_and_shifts[:2], teeth_and_shifts[2:]))
    transverse = transverse_angle(angle.number, beta)
    operating = inverse_involute(involute_function(tan(transverse)) + 2.0 * shifts * tan(angle.number) / teeth)
    bases = 0.5 * module.number * teeth * cos(transverse) / cos(beta)
    why = "no center_distance; from teeth, module and both profile shifts, without backlash"
    return computed(bases * hypot(1.0, operating), 1.0, "mm", why, assumed=True)


def _stated_shift(part: GearParts, module: Value | None) -> Value | None:
    """The shift that the tooth's thickness follows from; the sides of a tooth have one each, which must agree."""
    return agreed(every(part, "profile_shift", module), f"{part.gear} has contradictory profile shifts")


def _remaining_shift(
    stage: Stage, beta: float, known: Value, module: Value, angle: Value, distance: Value, *teeth: Value
) -> Value:
    """What is left of the sum of both shifts that leaves no backlash (ISO 21771)."""
    count = sum(each.number for each in teeth)
    transverse = transverse_angle(angle.number, beta)
    cosine = 0.5 * module.number * count * cos(transverse) / cos(beta) / distance.number
    if not cosine < 1.0:
        name = place(stage.stage, "center_distance")
        raise ValueProblem(
            f"{name} = {distance.number:.6g} mm is too small for {count:g} teeth of module {module.number:g} mm."
        )
    total = sum_of_profile_shifts(count, acos(cosine), transverse, angle.number)
    why = "no addendum_modification_coefficient; what that of the other gear and the centre distance leave it"
    return bare(round(total - known.number, 9), why, assumed=True)


def _gear_section(
    reading: Reading, part: GearParts, beta: float, module: Value | None, teeth: Value | None, shift: Value | None
) -> dict[str, Value | None]:
    def stated_or(asked: str, computed_by, *arguments) -> Value | None:
        if given(part, asked):
            return reading.attempt(needed, part, asked)
        return reading.attempt(computed_by, part, beta, module, teeth, shift, *arguments)

    # A mistake in it is told whatever else is missing.
    reading.attempt(first, part, "tip_diameter")
    tip = reading.attempt(_tip_diameter, part, beta, module, teeth, shift)
    root = stated_or("root_diameter", _root_diameter, tip)
    radius = reading.attempt(_of_tool, part, module, "rack_tip_radius")
    return {
        "teeth": teeth,
        "profile_shift": shift,
        "tip_diameter": tip,
        "root_diameter": root,
        "bore_diameter": reading.attempt(_bore_diameter, part, root),
        **({"rack_tip_radius": radius} if radius is not None else {}),
    }


def _tip_diameter(part: GearParts, beta: float, module: Value, teeth: Value, shift: Value) -> Value:
    stated = first(part, "tip_diameter")
    shifted = teeth.number / cos(beta) + 2.0 * shift.number
    if stated is not None and stated.number > module.number * (shifted - 2.0 * DEDENDUM):
        return stated
    addendum = first(part, "addendum")
    modules, source = _or_standard(addendum, "addendum", ADDENDUM)
    # Programs write numbers such as 1 mm where they have none.
    lacking = (
        "no tip_diameter" if stated is None else f"{stated.origin} is {stated.words}, below the roots of its teeth"
    )
    why = f"{lacking}; from teeth, profile shift and {source}"
    number = module.number * (shifted + 2.0 * modules)
    return computed(number, 1.0, "mm", why, assumed=addendum is None or stated is not None)


def _or_standard(stated: Value | None, name: str, standard: float) -> tuple[float, str]:
    """Modules, and where they are from in words."""
    number, origin = (standard, f"the {name} of ISO 53") if stated is None else (stated.number, stated.origin)
    return number, f"{origin}, {number} modules"


def _root_diameter(part: GearParts, beta: float, module: Value, teeth: Value, shift: Value, tip: Value) -> Value:
    """What the depth of the teeth gives, or what the rack cuts at the shift of its generating, if that is given."""
    depth = first(part, "tooth_depth")
    if depth is not None:
        why = f"no root_diameter; tip diameter less twice {depth.origin}"
        return computed(tip.number - 2.0 * depth.number, 1.0, "mm", why)
    generated = first(part, "generated_shift")
    addendum = _of_tool(part, module, "tool_addendum")
    at = "profile shift" if generated is None else generated.origin
    modules, source = _or_standard(addendum, "dedendum", DEDENDUM)
    number = module.number * (teeth.number / cos(beta) + 2.0 * ((generated or shift).number - modules))
    return computed(number, 1.0, "mm", f"no root_diameter; from teeth, {at} and {source}", assumed=addendum is None)


def _of_tool(part: GearParts, module: Value, asked: str) -> Value | None:
    agreed([module, *every(part, "tool_module")], "The tool has another module than the gear")
    return agreed(every(part, asked, module), f"{part.tool[0]} contradicts itself") if part.tool else None


def _bore_diameter(part: GearParts, root: Value) -> Value:
    bore = first(part, "bore_diameter")
    if bore is not None and bore.number < 0.0:
        raise ValueProblem(f"{place(*given(part, 'bore_diameter')[0][:2])} = {bore.words} is negative.")
    if bore is not None and bore.number > 0.0:
        return bore
    why = "no inner_diameter" if bore is None else f"{bore.origin} is 0, a solid gear"
    shaft = diameter_at(part.gear, part.shafts[0], part.on_shafts) if part.shafts else None
    if shaft is not None and shaft.number <= THICK_SHAFT * root.number:
        return replace(shaft, origin=f"{why}; {shaft.origin}, the shaft there", assumed=True)
    why = f"{why}; {USUAL_BORE} of the root diameter, held rigidly"
    return computed(USUAL_BORE * root.number, 1.0, "mm", why, assumed=True)


def _materials(stage: Stage) -> Sections:
    materials = {
        name: {asked: needed(part, asked) for asked in MATERIAL} for name, part in stage.named.items() if part.material
    }
    if not materials:
        why = "no material; that of steel (ISO 6336-1)"
        return {"gears.material": {"name": Value(0.0, '"steel"', why, assumed=True)}}
    try:
        return {
            "gears.material": {asked: agreed([each[asked] for each in materials.values()], "") for asked in MATERIAL}
        }
    except ValueProblem:
        return {f"gears.{name}.material": each for name, each in materials.items()}


def _check_reference_diameter(part: GearParts, beta: float, module: Value, teeth: Value) -> None:
    diameter = module.number * teeth.number / cos(beta)
    for stated, where in zip(every(part, "reference_diameter"), given(part, "reference_diameter")):
        if abs(stated.number - diameter) > ROUNDED * module.number:
            raise ValueProblem(
                f"{place(*where[:2])} = {stated.words} contradicts its module and its {teeth.number} teeth, "
                f"which give {diameter:.6g} mm."
            )


def _check_sum_of_shifts(stage: Stage, pinion: Value, wheel: Value) -> None:
    for stated, where in zip(every(stage, "sum_of_shifts"), given(stage, "sum_of_shifts")):
        if abs(stated.number - pinion.number - wheel.number) > ROUNDED:
            raise ValueProblem(
                f"{place(*where[:2])} = {stated.written} contradicts the profile shifts of its gears, "
                f"{pinion.written} and {wheel.written}."
            )
