"""Circles of a gear: tip, root, bore or rim, given by the file, computed from it, or the standard's; and its cutter."""

from __future__ import annotations

from dataclasses import replace
from math import copysign, cos

from fenics_gears import RACKS, USUAL_BORE

from .attributes import Reading, every, first, given, needed
from .shaft_parts import diameter_at
from .stage import GearParts, internal_gear
from .values import Value, ValueProblem, agreed, computed, place

STANDARD = "ISO 53 A"
ADDENDUM, DEDENDUM, _ = RACKS[STANDARD]
# A shaft that is thicker, over the root diameter, is one piece with the gear.
THICK_SHAFT = 0.7
# Thickness of a ring's rim, in modules, where the file has none.
USUAL_RIM = 3.5
# Rounding that is allowed where the file repeats module, teeth or shifts, in modules.
ROUNDED = 1e-3


def gear_section(
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
    fields = {
        "teeth": teeth,
        "profile_shift": shift,
        "tip_diameter": reading.attempt(_length, tip),
        "root_diameter": reading.attempt(_length, root),
        **({"rack_tip_radius": radius} if radius is not None else {}),
    }
    if internal_gear(part.gear):
        why = "the file has no stiffness of what is around the ring; rigid at its outer circle"
        outer = reading.attempt(_outer_diameter, part, module, root)
        return {**fields, "outer_diameter": outer, "support": Value(0.0, '"held"', why, assumed=True)}
    return {**fields, "bore_diameter": reading.attempt(_bore_diameter, part, root)}


def _length(signed: Value) -> Value:
    """A diameter without sign: those of internal gears are negative (ISO 21771)."""
    return (
        signed if signed.number >= 0.0 else computed(-signed.number, 1.0, "mm", signed.origin, assumed=signed.assumed)
    )


def _outer_diameter(part: GearParts, module: Value, root: Value) -> Value:
    """Of the rim of an internal gear: the file's, or that of the shaft around it, or a rim of the usual thickness."""
    inner = abs(root.number)
    outer = first(part, "outer_diameter")
    if outer is not None:
        return outer
    shaft = diameter_at(part.gear, part.shafts[0], part.on_shafts) if part.shafts else None
    if shaft is not None and shaft.number > inner:
        return replace(shaft, origin=f"no outer_diameter; {shaft.origin}, the shaft around it", assumed=True)
    why = f"no outer_diameter; a rim of {USUAL_RIM} modules"
    return computed(inner + 2.0 * USUAL_RIM * module.number, 1.0, "mm", why, assumed=True)


def _tip_diameter(part: GearParts, beta: float, module: Value, teeth: Value, shift: Value) -> Value:
    """The tip diameter, negative of an internal gear (ISO 21771)."""
    stated = first(part, "tip_diameter")
    sign = copysign(1.0, teeth.number)
    shifted = teeth.number / cos(beta) + 2.0 * shift.number
    # Programs write numbers such as 1 mm where they have none.
    beside = module.number * (abs(shifted) - sign * 2.0 * DEDENDUM)
    usable = stated is not None and (
        stated.number > beside or sign < 0.0 and 0.5 * beside < abs(stated.number) < beside
    )
    if stated is not None and usable:
        return replace(stated, number=sign * abs(stated.number)) if sign < 0.0 else stated
    addendum = first(part, "addendum")
    modules, source = _or_standard(addendum, "addendum", ADDENDUM)
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


def check_reference_diameter(part: GearParts, beta: float, module: Value, teeth: Value) -> None:
    diameter = module.number * abs(teeth.number) / cos(beta)
    for stated, where in zip(every(part, "reference_diameter"), given(part, "reference_diameter")):
        if abs(abs(stated.number) - diameter) > ROUNDED * module.number:
            raise ValueProblem(
                f"{place(*where[:2])} = {stated.words} contradicts its module and its {abs(teeth.number)} teeth, "
                f"which give {diameter:.6g} mm."
            )


def cutter(part: GearParts) -> dict[str, Value | None]:
    """The shaper cutter of an internal gear; empty where the file has none."""
    teeth = first(part, "cutter_teeth")
    shift = first(part, "cutter_shift")
    if teeth is None:
        return {}
    return {"teeth": teeth, **({} if shift is None else {"profile_shift": shift})}


def without_derived_tip(gears: dict[str, dict[str, Value | None]]) -> None:
    """Take the tip diameter of an internal gear out of its section where the file has none: a scene derives it so that
    it clears its mate's fillets."""
    for fields in gears.values():
        tip = fields.get("tip_diameter")
        if "outer_diameter" in fields and tip is not None and tip.assumed:
            del fields["tip_diameter"]
