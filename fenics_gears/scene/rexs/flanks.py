"""What a file says of the loaded flanks beyond the involute: reliefs and tolerances that a scene has, and the rest that is left out."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, isclose, sqrt

from fenics_gears.scene.rexs.gears import GearValues, PairValues
from fenics_gears.scene.rexs.model import Component
from fenics_gears.scene.rexs.reading import SAME, Reading, first_quantity, given, needed, positive, together
from fenics_gears.scene.rexs.stage import GearParts, Stage
from fenics_gears.scene.rexs.values import Value, ValueProblem, computed, place, quantity_of, unquoted, word_of

POWERS = {"linear": 1, "parabolic": 2}
TIP, ROOT = "tip_relief", "root_relief"
TOLERANCE_CLASSES = ("tolerance_class_according_to_iso_1328_2013", "global_tolerance_class_iso_1328_2013")
CLASSES = range(1, 12)
# What a gear or its flanks and tools can say that no scene has.
UNUSED = (
    "din_3967_deviation_tolerance_series", "tooth_thickness_deviation_tolerance_series_din_3967_1978",
    "tooth_tip_chamfer", "remaining_protuberance", "protuberance_amount", "protuberance_amount_factor", "single_pitch_deviation",
    "profile_form_deviation", "runout_tolerance", "upper_backlash_allowance_referenced_to_span", "lower_backlash_allowance_referenced_to_span",
    "upper_backlash_allowance_balls_or_pins", "lower_backlash_allowance_balls_or_pins",
)  # fmt: skip


@dataclass(frozen=True)
class ReliefValues:
    """The fields of ``[tip_relief.pinion]`` and its like."""

    depth: Value
    start: Value
    shape: Value

    def same_as(self, other: ReliefValues) -> bool:
        """Whether both remove the same."""
        pairs = ((self.depth.number, other.depth.number), (self.start.number, other.start.number))
        return self.shape.written == other.shape.written and all(isclose(*pair, rel_tol=SAME) for pair in pairs)


def reliefs(reading: Reading, stage: Stage, pair: PairValues, kind: str) -> tuple[ReliefValues | None, ReliefValues | None]:
    """Tip or root relief of the driving and the driven gear; None for a gear that has none."""
    angle, module = pair.pressure_angle, pair.module
    return tuple(reading.attempt(_relief, part, values, module, angle, kind) for part, values in zip(stage.gears, (pair.pinion, pair.wheel)))


def tolerance_class(reading: Reading, stage: Stage) -> Value | None:
    """The flank tolerance class of ISO 1328-1:2013 of both gears, the coarser one where they differ."""
    found = [Value(number, str(number), f"{name} of component {part.gear.identifier}") for part in stage.gears for name, number in _classes(reading, part)]
    if not found:
        return None
    coarse = max(found, key=lambda value: value.number)
    if len({value.number for value in found}) > 1:
        return Value(coarse.number, coarse.written, f"{coarse.origin}, the coarser of the two gears")
    origin = together(value.origin for value in found)
    return Value(coarse.number, coarse.written, origin if len(found) == 2 else f"{origin}, of this gear only", assumed=len(found) < 2)


def note_what_is_left_out(reading: Reading, stage: Stage) -> None:
    """Add what the file says of the gears and no scene has to what is left out."""
    for part in stage.gears:
        for side in _loaded_sides(part):
            for modification in part.modifications[side]:
                if modification.type not in (TIP, ROOT):
                    reading.left_out.append(f"{modification} of the {side} flank of component {part.gear.identifier}")
        holders = [part.gear, *(part.flanks[side] for side in _loaded_sides(part)), *part.tools[:1]]
        for component, name in given((holder, name) for holder in holders for name in UNUSED):
            attribute = component.attributes[name]
            if attribute.text != "false" and not _is_zero(attribute.text):
                reading.left_out.append(f"{component}: {name} = {attribute.text} {attribute.unit}".removesuffix(" none").rstrip())


def _is_zero(text: str | None) -> bool:
    try:
        return float(text or "nan") == 0.0
    except ValueError:
        return False


def _classes(reading: Reading, part: GearParts) -> list[tuple[str, int]]:
    found = []
    for component, name in given((part.gear, name) for name in TOLERANCE_CLASSES):
        text = word_of(component, name)
        if text in map(str, CLASSES):
            found.append((name, int(text)))
        else:
            reading.left_out.append(f"{place(component, name)} = {text}, which ISO 1328-1:2013 does not have (1 to 11)")
    return found[:1]


def _loaded_sides(part: GearParts) -> list[str]:
    """The side of the teeth that is loaded, both where the file does not say which."""
    said = [word_of(*each) for each in given((data, "loaded_tooth_flank") for data in part.stage_data)]
    return [side for side in part.flanks if not said or side == said[0]]


def _relief(part: GearParts, gear: GearValues, module: Value, pressure_angle: Value, kind: str) -> ReliefValues | None:
    by_side = {}
    for side in _loaded_sides(part):
        found = [each for each in part.modifications[side] if each.type == kind]
        if len(found) > 1:
            raise ValueProblem(f"{part.flanks[side]}: two components {kind}, {found[0].identifier} and {found[1].identifier}; a scene has one.")
        by_side[side] = _relief_of(found[0], kind, gear, module, pressure_angle) if found else None
    first, *others = by_side.values() or (None,)
    if any((first is None) != (other is None) or (first and other and not first.same_as(other)) for other in others):
        raise ValueProblem(
            f"{part.gear}: its left and its right flank have different {kind}, and the file does not say which one is loaded. "
            "Allowed: loaded_tooth_flank (left or right) in the gear's stage data."
        )
    return first


def _relief_of(relief: Component, kind: str, gear: GearValues, module: Value, pressure_angle: Value) -> ReliefValues | None:
    depth_name, start_name = f"{kind}_depth", f"{kind}_datum_diameter"
    depth = needed(first_quantity([(relief, depth_name)], "um"), [(relief, depth_name)])
    if depth.number == 0.0:
        return None
    positive(depth, relief, depth_name)
    remedy = f" {kind}_datum_length does not stand in for it."
    start = positive(needed(first_quantity([(relief, start_name)], "mm"), [(relief, start_name)], remedy), relief, start_name)
    shape = _shape(relief)
    if kind == TIP and gear.tip_diameter is not None and gear.teeth is not None:
        base = module.number * gear.teeth.number * cos(pressure_angle.number)
        depth = _at_the_tip(relief, depth, start, int(shape.number), base, gear.tip_diameter.number)
    return ReliefValues(depth, start, shape)


def _shape(relief: Component) -> Value:
    """The shape, with its power of the roll angle as the number."""
    name = "shape_of_relief"
    if name not in relief.attributes:
        return Value(1, '"linear"', f"no {name} of component {relief.identifier}", assumed=True)
    shape = word_of(relief, name)
    if shape not in POWERS:
        raise ValueProblem(f"{place(relief, name)} = {shape}. Allowed: {' or '.join(POWERS)}, which a scene has.")
    return Value(POWERS[shape], f'"{shape}"', f"{name} of component {relief.identifier}")


def _at_the_tip(relief: Component, depth: Value, start: Value, power: int, base: float, tip: float) -> Value:
    """The depth at the tip where the file gives it at another diameter: reliefs grow with the roll angle."""
    name = "tip_relief_evaluation_reference"
    for component, stated in given([(relief, name)]):
        evaluated = quantity_of(component, stated, "mm")
        if not base <= start.number < evaluated.number:
            raise ValueProblem(f"{place(relief, name)} = {unquoted(evaluated)} does not lie outside the start of the relief, {unquoted(start)}.")
        if not isclose(evaluated.number, tip, rel_tol=SAME):
            begin, there, end = (sqrt(diameter**2 - base**2) for diameter in (start.number, evaluated.number, max(tip, base)))
            number = depth.number * ((end - begin) / (there - begin)) ** power
            return computed(number, 1e-3, "um", f"{depth.origin}, {unquoted(depth)} at diameter {unquoted(evaluated)}, at the tip")
    return depth
