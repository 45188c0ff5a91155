"""The profile shifts of a stage: as the file gives them, or as the centre distance leaves one gear of them."""

from __future__ import annotations

from functools import partial
from math import acos, cos, tan

from fenics_gears.scene.rexs.reading import Place, Reading, agreed, given
from fenics_gears.scene.rexs.stage import GearParts, Stage
from fenics_gears.scene.rexs.values import Value, ValueProblem, bare, number_of, place, quantity_of

SHIFT, LENGTH = "addendum_modification_coefficient", "addendum_modification"
NAMES = (SHIFT, "profile_shift_coefficient", LENGTH)


def profile_shifts(
    reading: Reading, stage: Stage, module: Value | None, angle: Value | None, distance: Value | None, teeth: list[Value | None]
) -> list[Value | None]:
    """The shift of the driving and of the driven gear; None for one that could not be found, which the reading's problems then tell."""
    places = [_places(part) for part in stage.gears]
    shifts = [reading.attempt(partial(_stated, part, where, module)) for part, where in zip(stage.gears, places)]
    missing = [number for number, where in enumerate(places) if not where]
    if len(missing) == 2:
        reading.attempt(_refuse_both_missing, stage)
    elif missing:
        shifts[missing[0]] = reading.attempt(_remaining, stage, shifts[1 - missing[0]], module, angle, distance, *teeth)
    return shifts


def _places(part: GearParts) -> list[Place]:
    return given((holder, name) for holder in (*part.flanks.values(), part.gear) for name in NAMES)


def _stated(part: GearParts, places: list[Place], module: Value | None) -> Value | None:
    """The shift that the tooth's thickness follows from; the sides of a tooth have one each, which must agree."""
    shifts = []
    for component, name in places:
        if name != LENGTH:
            shifts.append(number_of(component, name))
        elif module is not None:
            length = quantity_of(component, name, "mm")
            shifts.append(Value(length.number / module.number, bare(length.number / module.number), f"{length.origin}, over the module"))
    return agreed(shifts, f"{part.gear} has contradictory profile shifts")


def _refuse_both_missing(stage: Stage) -> None:
    first, second = (part.gear for part in stage.gears)
    raise ValueProblem(f"{place(first, SHIFT)} is missing, for its flanks too, and so is that of component {second.identifier}.")


def _remaining(stage: Stage, known: Value, module: Value, angle: Value, distance: Value, *teeth: Value) -> Value:
    """What is left of the sum of both shifts that leaves no backlash (ISO 21771)."""
    count = sum(each.number for each in teeth)
    cosine = 0.5 * module.number * count * cos(angle.number) / distance.number
    if not cosine < 1.0:
        name = place(stage.stage, "center_distance")
        raise ValueProblem(f"{name} = {distance.number:.6g} mm is too small for {count:g} teeth of module {module.number:g} mm.")
    operating = acos(cosine)
    total = 0.5 * count * (tan(operating) - operating - tan(angle.number) + angle.number) / tan(angle.number)
    number = round(total - known.number, 9)
    return Value(number, bare(number), f"no {SHIFT}; what that of the other gear and the centre distance leave it, without backlash", assumed=True)
