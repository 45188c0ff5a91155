"""Lead modifications of the loaded flanks: crowning, helix slope and end relief.

A modification's component has amounts at the datum face and at the opposite one, and coordinates from mid-width,
negative towards the datum face. Left and right flank are those that an observer at the datum face sees (ISO 21771).
From the scene's +z the pinion turns counter-clockwise, so that both loaded flanks are left ones from there. The datum
face is the scene's right end where the left flank is loaded, its left end where the right one is.
"""

from math import isclose

from .attributes import Reading, needed, positive, required, stated
from .gears import Sections
from .model import Component
from .stage import Fields, GearParts, Stage
from .values import SAME, Value, ValueProblem, computed, place, word_of

CROWNING = "helix_crowning"
SLOPE = "helix_slope"
DATUM = "end_relief_datum_face"
OPPOSITE = "end_relief_non_datum_face"
LEAD_TYPES = (CROWNING, SLOPE, DATUM, OPPOSITE)
SHAPE = "shape_of_relief"
# Of the roll angle, or of the distance from where an end relief begins.
POWERS = {"linear": 1, "parabolic": 2}
# Of these a scene has no like: where the file has another value than nothing, the modification is refused.
NO_PLACE = {
    CROWNING: ("helix_highest_point",),
    SLOPE: (),
    DATUM: ("specify_tangential_transition",),
    OPPOSITE: ("specify_tangential_transition",),
}
NOTHING = ("0", "0.0", "-0.0", "false", "False")


def lead_sections(reading: Reading, stage: Stage, gears: Sections) -> Sections:
    """``[lead_modifications.pinion]`` and its like, of the gears that have one."""
    sections = {}
    for name, part in stage.named.items():
        width = gears[f"gears.{name}"].get("face_width") or gears["gears"].get("face_width")
        if own := reading.attempt(_lead, part, width):
            sections[f"lead_modifications.{name}"] = own
    return sections


def _lead(part: GearParts, width: Value) -> Fields:
    """The fields of a gear's modifications, alike on all flanks that may be loaded."""
    if not any(each.type in LEAD_TYPES for side in part.loaded_sides for each in part.modifications[side]):
        return {}
    own = needed(part, "face_width")
    if not isclose(own.number, width.number, rel_tol=SAME):
        raise ValueProblem(
            f"{part.gear}: lead modifications over its face of {own.words}, but common_face_width is {width.words} and"
            " the file does not say at which ends. Allowed with lead modifications: no common_face_width, or"
            " the width of the narrower gear."
        )
    return part.of_loaded_sides(
        lambda side: _fields(part, side, width.number),
        lambda one, other: one.written == other.written,
        "ends or amounts of lead modifications",
    )


def _fields(part: GearParts, side: str, width: float) -> Fields:
    right_end = DATUM if side == "left" else OPPOSITE
    components = {kind: own for kind in LEAD_TYPES if (own := part.modification(side, kind)) is not None}
    for component in components.values():
        for name in NO_PLACE[component.type]:
            if name in component.attributes and (word := word_of(component, name)) not in NOTHING:
                raise ValueProblem(f"{place(component, name)} = {word}. Allowed: 0 or false, for a scene has no other.")
    fields = {}
    if CROWNING in components:
        fields["crowning"] = _crowning(components[CROWNING], width)
    if SLOPE in components:
        fields["helix_slope"] = _slope(components[SLOPE], width, 1.0 if right_end == OPPOSITE else -1.0)
    reliefs = {
        ("right" if kind == right_end else "left"): _end_relief(components[kind], width)
        for kind in (DATUM, OPPOSITE)
        if kind in components
    }
    if reliefs:
        fields["end_relief"] = _both_ends(reliefs)
    return {name: value for name, value in fields.items() if value.number != 0.0}


def _crowning(component: Component, width: float) -> Value:
    """The height at the ends, by the parabola through what is given at equal distances from mid-width."""
    faces = ("datum_face", "non_datum_face")
    amounts = [required(component, f"helix_crowning_amount_{face}", "um") for face in faces]
    coordinates = (f"coordinate_where_helix_crowning_is_specified_{face}" for face in faces)
    places = [abs(_coordinate(component, name, 0.5 * width)) for name in coordinates]
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
    why = f"{amounts[0].origin}, {amounts[0].words} {places[0]:g} mm from mid-width"
    return computed(amounts[0].number * (0.5 * width / places[0]) ** 2, 1e-3, "um", why)


def _slope(component: Component, width: float, sign: float) -> Value:
    """Over the whole face width; a positive amount is taken to be removed towards the face opposite the datum face."""
    amount = required(component, "helix_slope", "um")
    start, end = (
        _coordinate(component, f"helix_evaluation_{end}", at)
        for end, at in (("start", -0.5 * width), ("end", 0.5 * width))
    )
    length = abs(end - start)
    if length == 0.0:
        raise ValueProblem(
            f"{place(component, 'helix_evaluation_end')} is where helix_evaluation_start is. Allowed: another place on"
            " the face."
        )
    why = (
        f"{amount.origin}, {amount.words} over {length:g} mm; taken as removed towards the face opposite the datum face"
    )
    return computed(sign * amount.number * width / length, 1e-3, "um", why, assumed=amount.number != 0.0)


def _end_relief(component: Component, width: float) -> tuple[Value, Value, Value]:
    face = component.type.removeprefix("end_relief_")
    depth = required(component, f"end_relief_depth_{face}", "um")
    if depth.number < 0.0:
        raise ValueProblem(f"{place(component, f'end_relief_depth_{face}')} = {depth.words} is negative.")
    where = (component, f"end_relief_length_{face}", "mm")
    length = positive(required(*where), where)
    shape = shape_of(component)
    reference = f"end_relief_evaluation_reference_{face}"
    at = abs(_coordinate(component, reference, 0.5 * width))
    if not isclose(at, 0.5 * width, rel_tol=SAME):
        raise ValueProblem(
            f"{place(component, reference)} is {at:g} mm from mid-width. Allowed: the end of the face,"
            f" {0.5 * width:g} mm."
        )
    return depth, length, shape


def shape_of(relief: Component) -> Value:
    """The shape, with its power of the roll angle, or of the length, as the number: one of POWERS; "linear" where the
    file does not say it. Raises ValueProblem for one that a scene has no like of."""
    origin = f"{SHAPE} of component {relief.id}"
    if SHAPE not in relief.attributes:
        return Value(POWERS["linear"], '"linear"', f"no {origin}", assumed=True)
    shape = word_of(relief, SHAPE)
    if shape == "circular":
        why = f"{origin} is circular; the parabola through the arc's ends differs by less than (depth/length)^2 of it"
        return Value(POWERS["parabolic"], '"parabolic"', why, assumed=True)
    if shape not in POWERS:
        raise ValueProblem(
            f"{place(relief, SHAPE)} = {shape}. Allowed: {', '.join(POWERS)} or circular, for a scene has no other."
        )
    return Value(POWERS[shape], f'"{shape}"', origin)


def _both_ends(reliefs: dict[str, tuple[Value, Value, Value]]) -> Value:
    """One end's relief, or that of both ends where they are alike, as a scene's inline table. Its number is the
    depth."""
    (side, (depth, length, shape)), *others = reliefs.items()
    for _, (other, length_there, shape_there) in others:
        pairs = (other.number, depth.number), (length_there.number, length.number)
        if shape_there.written != shape.written or not all(isclose(*each, rel_tol=SAME) for each in pairs):
            raise ValueProblem(
                f"{depth.origin} is {depth.words}, {other.origin} is {other.words}, or lengths or shapes differ."
                " Allowed: ends alike, or one end relieved."
            )
    sides = "both" if others else side
    written = f'{{ depth = {depth.written}, length = {length.written}, sides = "{sides}", shape = {shape.written} }}'
    return Value(depth.number, written, f"{depth.origin} and {length.origin}; {shape.origin}", assumed=shape.assumed)


def _coordinate(component: Component, name: str, otherwise: float) -> float:
    """A place (mm), from mid-width."""
    coordinate = stated((component, name, "mm"))
    return otherwise if coordinate is None else coordinate.number
