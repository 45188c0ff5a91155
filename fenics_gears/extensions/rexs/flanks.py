"""Reliefs and tolerances of the loaded flanks, and what a file says of flanks that a scene has no field for."""

from dataclasses import replace
from math import copysign, cos, inf, isclose, sqrt

from .attributes import NO_PLACE, NO_PLACE_OF_RELIEFS, Reading, given, missing, positive, required, stated
from .circles import ROUNDED
from .gears import Sections, transverse_angle
from .lead import LEAD_TYPES, shape_of
from .model import Component
from .stage import Fields, GearParts, Stage
from .values import SAME, Value, ValueProblem, computed, in_words, place, together, word_of

TIP = "tip_relief"
ROOT = "root_relief"
CLASSES = range(1, 12)


def relief_sections(reading: Reading, stage: Stage, gears: Sections) -> Sections:
    """``[tip_relief.pinion]`` and its like, of the flanks that have one."""
    sections = {}
    beta = gears["gears"]["helix_angle"].number if "helix_angle" in gears["gears"] else 0.0
    for kind in (TIP, ROOT):
        for name, part in stage.named.items():
            circles = gears[f"gears.{name}"]
            base = reading.attempt(
                _base_diameter, beta, *(gears["gears"][each] for each in ("module", "pressure_angle")), circles["teeth"]
            )
            relief = reading.attempt(_relief, part, kind, base, circles["tip_diameter"])
            if relief:
                sections[f"{kind}.{name}"] = relief
    return sections


def loaded_flanks(stage: Stage) -> list[str]:
    """Which flanks are taken to be loaded by the signs of torques, where they are modified and the file does not say
    it."""
    return [
        f"loaded flank of component {part.gear.id}: {part.by_torque}, by the sign of its torque and its"
        " datum_face_orientation"
        for part in stage.named.values()
        if part.by_torque is not None and part.said_side is None and any(part.modifications.values())
    ]


def tolerance_class(reading: Reading, stage: Stage) -> Value | None:
    """The flank tolerance class of ISO 1328-1:2013 of both gears, the coarser one where they differ."""
    classes = [value for part in stage.named.values() for value in _classes(reading, part)]
    if not classes:
        return None
    coarse = max(classes, key=lambda value: value.number)
    origin = together(value.origin for value in classes)
    if len({value.number for value in classes}) > 1:
        origin = f"{coarse.origin}, the coarser of the two gears"
    elif len(classes) == 1:
        origin = f"{origin}, of this gear only"
    return replace(coarse, origin=origin, assumed=len(classes) == 1)


def note_what_is_left_out(reading: Reading, stage: Stage) -> None:
    """Add what the file says of the gears and no scene has to what is left out."""
    for part in stage.named.values():
        modifications = {side: part.modifications[side] for side in part.loaded_sides}
        for side, components in modifications.items():
            others = (each for each in components if each.type not in (TIP, ROOT, *LEAD_TYPES))
            reading.left_out += [f"{each} of the {side} flank of component {part.gear.id}" for each in others]
        reliefs = {
            each.id: each for components in modifications.values() for each in components if each.type in (TIP, ROOT)
        }
        places = [
            (holder, name)
            for holder in (part.gear, *(part.flanks[side] for side in part.loaded_sides), *part.tool)
            for name in NO_PLACE
        ]
        places += [(relief, f"{relief.type}_{name}") for relief in reliefs.values() for name in NO_PLACE_OF_RELIEFS]
        for component, name in places:
            if name in component.attributes:
                reading.attempt(_note, reading, component, name)


def _note(reading: Reading, component: Component, name: str) -> None:
    words = in_words(component, name)
    if words != "false" and not _is_zero(words):
        reading.left_out.append(f"{place(component, name)} = {words}")


def _is_zero(words: str) -> bool:
    try:
        return float(words.partition(" ")[0]) == 0.0
    except ValueError:
        return False


def _classes(reading: Reading, part: GearParts) -> list[Value]:
    classes = []
    for component, name, _ in given(part, "tolerance_class"):
        text = word_of(component, name)
        if text in map(str, CLASSES):
            classes.append(Value(int(text), text, f"{name} of component {component.id}"))
        else:
            reading.left_out.append(f"{place(component, name)} = {text}, which ISO 1328-1:2013 does not have (1 to 11)")
    return classes[:1]


def _base_diameter(beta: float, module: Value, angle: Value, teeth: Value) -> float:
    """Negative of an internal gear, whose flank begins at its tip and goes outwards."""
    return module.number * teeth.number * cos(transverse_angle(angle.number, beta)) / cos(beta)


def _relief(part: GearParts, kind: str, base: float, tip: Value) -> Fields:
    """Tip or root relief of the loaded flank; empty for a gear that has none."""

    def of_side(side: str) -> Fields:
        component = part.modification(side, kind)
        return {} if component is None else _relief_of(component, base, tip.number)

    return part.of_loaded_sides(of_side, lambda one, other: isclose(one.number, other.number, rel_tol=SAME), kind)


def _relief_of(relief: Component, base: float, tip: float) -> Fields:
    """The fields of a relief; none where it removes nothing. ``base``, ``tip``: diameters, mm."""
    where = (relief, f"{relief.type}_depth", "um")
    depth = required(*where)
    if depth.number == 0.0:
        return {}
    positive(depth, where)
    field, start, diameter = _start(relief, base, tip)
    shape = shape_of(relief)
    if relief.type == TIP:
        depth = _at_the_tip(relief, depth, diameter, int(shape.number), base, tip)
    return {"depth": depth, field: start, "shape": shape}


def _start(relief: Component, base: float, tip: float) -> tuple[str, Value, float | None]:
    """Where a relief starts, as the field that a scene has for it: by the diameter, or by its length of roll (L_C, ISO
    21771). The diameter (mm) of a tip relief's start comes with it: a flank rolls through s = sqrt(d^2 - d_b^2)/2.
    """
    where = (relief, f"{relief.type}_datum_diameter", "mm")
    by_length = (relief, f"{relief.type}_datum_length", "mm")
    start = stated(where)
    length = stated(by_length)
    if start is None and length is None:
        raise missing(where, by_length)
    if start is not None:
        positive(start, where)
    if length is None:
        return "start", start, start.number
    whole = 0.5 * sqrt(max(tip**2 - base**2, 0.0))
    diameter = None
    inwards = copysign(1.0, base)
    if not 0.0 < length.number < (whole if base > 0.0 else inf):
        raise ValueProblem(
            f"{place(*by_length[:2])} = {length.words} is no length of roll of this flank. Allowed: above 0 and below"
            f" {whole:.6g} mm."
        )
    if relief.type == TIP:
        diameter = sqrt(base**2 + 4.0 * (whole - inwards * length.number) ** 2)
        if start is not None and abs(start.number - diameter) > ROUNDED * tip:
            raise ValueProblem(
                f"{place(*where[:2])} = {start.words} contradicts {by_length[1]} = {length.words}, which starts at"
                f" {diameter:.6g} mm."
            )
    return ("length_on_path", length, diameter) if start is None else ("start", start, start.number)


def _at_the_tip(relief: Component, depth: Value, start: float, power: int, base: float, tip: float) -> Value:
    """The depth at the tip where the file gives it at another diameter: reliefs grow with the roll angle."""
    where = (relief, "tip_relief_evaluation_reference", "mm")
    evaluated = stated(where)
    if evaluated is None:
        return depth
    beyond = copysign(1.0, base) * (abs(evaluated.number) - start) > 0.0
    if not (beyond and min(start, abs(evaluated.number)) >= abs(base)):
        side = "outside" if base > 0.0 else "inside"
        raise ValueProblem(
            f"{place(*where[:2])} = {evaluated.words} does not lie {side} the start of the relief, {start:.6g} mm."
        )
    if isclose(abs(evaluated.number), tip, rel_tol=SAME):
        return depth
    ends = start, abs(evaluated.number), max(tip, abs(base))
    begin, there, end = (sqrt(diameter**2 - base**2) for diameter in ends)
    number = depth.number * ((end - begin) / (there - begin)) ** power
    return computed(number, 1e-3, "um", f"{depth.origin}, {depth.words} at diameter {evaluated.words}, at the tip")
