"""The gears of a stage: teeth, circles and material, given by the file, computed from it, or the standard's."""

from dataclasses import replace
from functools import partial
from math import acos, atan, cos, isclose, tan

from fenics_gears import centre_distance_of_shifts, sum_of_profile_shifts

from .attributes import Reading, every, first, given, missing, needed, places
from .circles import ROUNDED, STANDARD, check_reference_diameter, cutter, gear_section
from .placing import distance_of_positions, offset_of_wheel
from .stage import GearParts, Stage, internal_gear
from .values import NUMBER, SAME, Value, ValueProblem, agreed, bare, computed, place, together

# By the section of a scene ("gears.pinion"), its fields; None for what was not found, which is among the reading's
# problems.
Sections = dict[str, dict[str, Value | None]]
MATERIAL = ("youngs_modulus", "poissons_ratio")
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
    teeth = [reading.attempt(_signed_teeth, part) for part in parts]
    shifts = _profile_shifts(reading, stage, module, angle, distance, teeth, beta)
    if distance is None and not given(stage, "centre_distance"):
        distance = reading.attempt(distance_of_shifts, beta, module, angle, *teeth, *shifts)
    gears = [gear_section(reading, part, beta, module, *own) for part, *own in zip(parts, teeth, shifts)]
    for part, count in zip(parts, teeth):
        reading.attempt(check_reference_diameter, part, beta, module, count)
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
    outside = {f"gears.{name}" for name, part in stage.named.items() if not internal_gear(part.gear)}
    racks = {f"{name}.rack": rack for name in named if name in outside and "rack_tip_radius" not in named[name]}
    tool = reading.attempt(cutter, stage.wheel) if internal_gear(stage.wheel.gear) else None
    cutters = {"gears.wheel.cutter": tool} if tool else {}
    return {"gears": pair, **named, **racks, **cutters, **(reading.attempt(_materials, stage) or {})}


def _signed_teeth(part: GearParts) -> Value:
    """The number of teeth, negative of an internal gear (ISO 21771), whichever sign a program gives it."""
    teeth = needed(part, "teeth")
    if not internal_gear(part.gear):
        return teeth
    count = abs(int(teeth.number))
    return replace(teeth, number=-count, written=str(-count))


def _module(stage: Stage) -> Value:
    return agreed([needed(part, "module") for part in stage.named.values()], "The gears have different modules")


def _helix(stage: Stage) -> dict[str, Value | None]:
    """Helix angle and hand of the pinion; empty for spur gears. A positive angle is a right-hand helix (ISO 21771)."""
    pinion, wheel = (first(part, "helix_angle") for part in stage.named.values())
    there = [angle for angle in (pinion, wheel) if angle is not None]
    if not any(abs(angle.number) > NO_HELIX for angle in there):
        return {}
    inside = internal_gear(stage.wheel.gear)
    if len(there) == 2 and abs(pinion.number + (-1.0 if inside else 1.0) * wheel.number) > ROUNDED * abs(pinion.number):
        signs = "one sign of an internal pair" if inside else "opposite signs"
        raise ValueProblem(
            f"{stage.stage}: {pinion.origin} is {pinion.words}, {wheel.origin} is {wheel.words}. Allowed on parallel"
            f" axes: the same angle with {signs}."
        )
    angle = there[0]
    origin = together(each.origin for each in there)
    hand = "right" if (angle.number > 0.0) == (pinion is not None or inside) else "left"
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
    if len(unsaid) == 2 and _without_shifts(beta, module, distance, teeth):
        why = f"no addendum_modification_coefficient; {distance.origin} is that of the teeth without shifts"
        return [bare(0.0, why, assumed=True)] * 2
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


def _without_shifts(beta: float, module: Value | None, distance: Value | None, teeth: list[Value | None]) -> bool:
    """Whether a centre distance is that of the reference circles."""
    if module is None or distance is None or None in teeth:
        return False
    reference = 0.5 * module.number * abs(sum(each.number for each in teeth if each is not None)) / cos(beta)
    return abs(abs(distance.number) - reference) < SAME * module.number


def _distance(stage: Stage) -> Value | None:
    """The centre distance that is stated, or that of the places of both gears."""
    return first(stage, "centre_distance") or distance_of_positions(stage)


def distance_of_shifts(beta: float, module: Value, angle: Value, *teeth_and_shifts: Value) -> Value:
    """The centre distance at which both profile shifts leave no backlash (ISO 21771)."""
    teeth, shifts = (sum(each.number for each in both) for both in (teeth_and_shifts[:2], teeth_and_shifts[2:]))
    distance = centre_distance_of_shifts(teeth, shifts, module.number, angle.number, beta)
    why = "no center_distance; from teeth, module and both profile shifts, without backlash"
    return computed(distance, 1.0, "mm", why, assumed=True)


def _stated_shift(part: GearParts, module: Value | None) -> Value | None:
    """The shift that the tooth's thickness follows from; the sides of a tooth have one each, which must agree."""
    return agreed(every(part, "profile_shift", module), f"{part.gear} has contradictory profile shifts")


def _remaining_shift(
    stage: Stage, beta: float, known: Value, module: Value, angle: Value, distance: Value, *teeth: Value
) -> Value:
    """What is left of the sum of both shifts that leaves no backlash (ISO 21771)."""
    count = sum(each.number for each in teeth)
    transverse = transverse_angle(angle.number, beta)
    cosine = 0.5 * module.number * abs(count) * cos(transverse) / cos(beta) / abs(distance.number)
    if not cosine < 1.0:
        name = place(stage.stage, "center_distance")
        raise ValueProblem(
            f"{name} = {distance.number:.6g} mm is too small for {abs(count):g} teeth of module {module.number:g} mm."
        )
    total = sum_of_profile_shifts(count, acos(cosine), transverse, angle.number)
    why = "no addendum_modification_coefficient; what that of the other gear and the centre distance leave it"
    return bare(round(total - known.number, 9) + 0.0, why, assumed=True)


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


def _check_sum_of_shifts(stage: Stage, pinion: Value, wheel: Value) -> None:
    for stated, where in zip(every(stage, "sum_of_shifts"), given(stage, "sum_of_shifts")):
        if abs(stated.number - pinion.number - wheel.number) > ROUNDED:
            raise ValueProblem(
                f"{place(*where[:2])} = {stated.written} contradicts the profile shifts of its gears, "
                f"{pinion.written} and {wheel.written}."
            )
