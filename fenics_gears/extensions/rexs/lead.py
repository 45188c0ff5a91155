"""Lead modifications of the loaded flanks: crowning, helix slope and end relief.

A modification's component has amounts at the datum face and at the opposite one, and coordinates from mid-width,
negative towards the datum face. Left and right flank are those that an observer at the datum face sees (ISO 21771). The
scene's +z looks on a pinion that turns counter-clockwise, so that both loaded flanks are left ones from there: the
datum face is the scene's right end where the left flank is loaded, its left end where the right one is.
"""

from math import isclose

from .attributes import Reading, missing, needed, positive
from .model import Component
from .stage import GearParts, Stage
from .values import SAME, Value, ValueProblem, computed, place, value_of, word_of

CROWNING, SLOPE, DATUM, OPPOSITE = "helix_crowning", "helix_slope", "end_relief_datum_face", "end_relief_non_datum_face"
LEAD_TYPES = (CROWNING, SLOPE, DATUM, OPPOSITE)
SHAPES = ("linear", "parabolic")
# Of these a scene has no like: where the file has another value than nothing, the modification is refused.
NO_PLACE = {
    CROWNING: ("helix_highest_point",),
    SLOPE: (),
    DATUM: ("specify_tangential_transition",),
    OPPOSITE: ("specify_tangential_transition",),
}
NOTHING = ("0", "0.0", "-0.0", "false", "False")


def lead_sections(
    reading: Reading, stage: Stage, gears: dict[str, dict[str, Value | None]]
) -> dict[str, dict[str, Value | None]]:
    """``[lead_modifications.pinion]`` and its like, of the gears that have one."""
    found = {}
    for part, name in zip(stage.gears, ("pinion", "wheel")):
        width = gears[f"gears.{name}"].get("face_width") or gears["gears"].get("face_width")
        own = (
            reading.attempt(_lead, part, width)
            if any(each.type in LEAD_TYPES for side in part.loaded_sides for each in part.modifications[side])
            else None
        )
        if own:
            found[f"lead_modifications.{name}"] = own
    return found


def _of_side(part: GearParts, side: str) -> dict[str, Component]:
    """The components that modify a flank along the face, by their type. Raises ValueProblem where there are two of a
    type."""
    found: dict[str, Component] = {}
    for each in part.modifications[side]:
        if each.type in found:
            raise ValueProblem(
                f"{part.flanks[side]}: two components {each.type}, {found[each.type].id} and {each.id}; a scene has"
                " one."
            )
        if each.type in LEAD_TYPES:
            found[each.type] = each
    return found


def _lead(part: GearParts, width: Value) -> dict[str, Value | None]:
    """The fields of a gear's modifications, alike on all flanks that may be loaded."""
    own = needed(part, "face_width")
    if not isclose(own.number, width.number, rel_tol=SAME):
        raise ValueProblem(
            f"{part.gear}: lead modifications over its face of {own.words}, but common_face_width is {width.words}."
            " Allowed beside lead modifications: no common_face_width, or that of the gear."
        )
    one, *others = [_fields(part, side, width.number) for side in part.loaded_sides]
    for other in others:
        if {name: value.written for name, value in one.items()} != {
            name: value.written for name, value in other.items()
        }:
            raise ValueProblem(
                f"{part.gear}: the ends or amounts of its lead modifications differ by the flank that is loaded, and"
                " the file does not say which one is. Allowed: loaded_tooth_flank (left or right) in the gear's stage"
                " data."
            )
    return one


def _fields(part: GearParts, side: str, width: float) -> dict[str, Value]:
    components, right_end = _of_side(part, side), DATUM if side == "left" else OPPOSITE
    for component in components.values():
        for name in NO_PLACE[component.type]:
            if name in component.attributes and word_of(component, name) not in NOTHING:
                raise ValueProblem(
                    f"{place(component, name)} = {word_of(component, name)}. Allowed: 0 or false, for a scene has no"
                    " other."
                )
    found = {}
    if CROWNING in components:
        found["crowning"] = _crowning(components[CROWNING], width)
    if SLOPE in components:
        found["helix_slope"] = _slope(components[SLOPE], width, 1.0 if right_end == OPPOSITE else -1.0)
    reliefs = {
        ("right" if kind == right_end else "left"): _end_relief(components[kind], width)
        for kind in (DATUM, OPPOSITE)
        if kind in components
    }
    if reliefs:
        found["end_relief"] = _both_ends(reliefs)
    return {name: value for name, value in found.items() if value.number != 0.0}


def _crowning(component: Component, width: float) -> Value:
    """The height at the ends, by the parabola through what is given at equal distances from mid-width."""
    amounts = [_needed(component, f"helix_crowning_amount_{face}", "um") for face in ("datum_face", "non_datum_face")]
    places = [
        abs(_stated(component, f"coordinate_where_helix_crowning_is_specified_{face}", 0.5 * width))
        for face in ("datum_face", "non_datum_face")
    ]
    if (
        not (isclose(amounts[0].number, amounts[1].number, rel_tol=SAME) and isclose(*places, rel_tol=SAME))
        or places[0] == 0.0
    ):
        raise ValueProblem(
            f"{place(component, 'helix_crowning_amount_datum_face')} = {amounts[0].words} at {places[0]:g} mm,"
            f" {amounts[1].words} at {places[1]:g} mm at the other end. Allowed: the same amount at both, for a scene"
            " has a parabola about mid-width."
        )
    if isclose(places[0], 0.5 * width, rel_tol=SAME):
        return amounts[0]
    return computed(
        amounts[0].number * (0.5 * width / places[0]) ** 2,
        1e-3,
        "um",
        f"{amounts[0].origin}, {amounts[0].words} {places[0]:g} mm from mid-width",
    )


def _slope(component: Component, width: float, sign: float) -> Value:
    """Over the whole face width; a positive amount is taken to be removed towards the face opposite the datum face."""
    stated = _needed(component, "helix_slope", "um")
    ends = [
        _stated(component, f"helix_evaluation_{end}", at) for end, at in (("start", -0.5 * width), ("end", 0.5 * width))
    ]
    length = abs(ends[1] - ends[0])
    if length == 0.0:
        raise ValueProblem(
            f"{place(component, 'helix_evaluation_end')} is where helix_evaluation_start is. Allowed: another place on"
            " the face."
        )
    why = (
        f"{stated.origin}, {stated.words} over {length:g} mm; taken as removed towards the face opposite the datum face"
    )
    return computed(sign * stated.number * width / length, 1e-3, "um", why, assumed=stated.number != 0.0)


def _end_relief(component: Component, width: float) -> tuple[Value, Value, str]:
    face = component.type.removeprefix("end_relief_")
    depth, length = (
        _needed(component, f"end_relief_depth_{face}", "um"),
        _needed(component, f"end_relief_length_{face}", "mm"),
    )
    if depth.number < 0.0:
        raise ValueProblem(f"{place(component, f'end_relief_depth_{face}')} = {depth.words} is negative.")
    positive(length, (component, f"end_relief_length_{face}", "mm"))
    shape = word_of(component, "shape_of_relief") if "shape_of_relief" in component.attributes else SHAPES[0]
    if shape not in SHAPES:
        raise ValueProblem(
            f"{place(component, 'shape_of_relief')} = {shape}. Allowed: {' or '.join(SHAPES)}, which a scene has."
        )
    at = abs(_stated(component, f"end_relief_evaluation_reference_{face}", 0.5 * width))
    if not isclose(at, 0.5 * width, rel_tol=SAME):
        where = place(component, f"end_relief_evaluation_reference_{face}")
        raise ValueProblem(f"{where} is {at:g} mm from mid-width. Allowed: the end of the face, {0.5 * width:g} mm.")
    return depth, length, shape


def _both_ends(reliefs: dict[str, tuple[Value, Value, str]]) -> Value:
    """One end's relief, or that of both ends where they are alike, as a scene's inline table. Its number is the
    depth."""
    (side, (depth, length, shape)), *others = reliefs.items()
    for _, other in others:
        if not (
            isclose(other[0].number, depth.number, rel_tol=SAME)
            and isclose(other[1].number, length.number, rel_tol=SAME)
            and other[2] == shape
        ):
            raise ValueProblem(
                f"{depth.origin} is {depth.words}, {other[0].origin} is {other[0].words}, or lengths or shapes differ. "
                "Allowed: ends alike, or one end relieved."
            )
    sides = "both" if others else side
    written = f'{{ depth = {depth.written}, length = {length.written}, sides = "{sides}", shape = "{shape}" }}'
    return Value(depth.number, written, f"{depth.origin} and {length.origin}")


def _needed(component: Component, name: str, unit: str) -> Value:
    if name not in component.attributes:
        raise missing((component, name, unit))
    return value_of(component, name, unit)


def _stated(component: Component, name: str, otherwise: float) -> float:
    """A coordinate (mm), from mid-width."""
    return value_of(component, name, "mm").number if name in component.attributes else otherwise
