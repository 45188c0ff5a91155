"""What is wrong between the fields of ``[flank_errors]``. Not an effect by itself."""

from fenics_gears.geometry.flank_errors import CURVES, LISTS
from fenics_gears.inputs.problem import Broken
from fenics_gears.inputs.tree import GEARS, Tree, module_in, quantity_in, table, teeth_in

# Pitches of a measuring sheet are rounded to 0.1 um: their sum is off by at most half of that for each tooth.
PITCH_ROUNDING = 0.05e-3
# Reference diameters and modules (mm) that the tolerances of ISO 1328-1:2013 are for.
DIAMETERS = (5.0, 15e3)
MODULES = (0.5, 70.0)


def errors_fit_the_gears(tree: Tree) -> Broken:
    """There are errors; lists have a value for each tooth; pitches close over a turn; the tolerance class is for gears
    of this size."""
    errors = table(tree, "flank_errors")
    if errors is None:
        return
    if "seed" in errors and "tolerance_class" not in errors:
        message = "is missing. Allowed: a class from 1 to 11; without one the seed draws nothing."
        yield ("flank_errors", "tolerance_class"), message
    if "tolerance_class" in errors:
        yield from _class_is_for_the_gears(tree)
    elif not any(table(errors, gear) for gear in GEARS):
        message = "has no errors. Add a tolerance_class or [flank_errors.pinion], or leave the section out."
        yield ("flank_errors",), message
    for gear in GEARS:
        own = table(errors, gear) or {}
        yield from _lists_fit_the_teeth(own, teeth_in(tree, gear), gear)
        if "anchor" in own and not any(name in own for name in CURVES):
            message = f"has no curves to hold. Allowed: with {' or '.join(CURVES)}; leave anchor out."
            yield ("flank_errors", gear, "anchor"), message


def _lists_fit_the_teeth(errors: Tree, teeth: int | None, gear: str) -> Broken:
    for name in LISTS:
        values = errors.get(name)
        if not isinstance(values, list) or teeth is None or not values:
            continue
        path = ("flank_errors", gear, name)
        if len(values) != teeth:
            message = f"has {len(values)} values, but the {gear} has {teeth} teeth. Allowed: a value for each tooth."
            yield path, message
        elif name == "pitch":
            yield from _pitches_close(values, path)


def _pitches_close(values: list, path: tuple[str, ...]) -> Broken:
    numbers = [quantity_in(value) for value in values]
    if None in numbers:
        return
    total = sum(numbers)
    if not abs(total) <= PITCH_ROUNDING * len(numbers):
        yield path, not_closed(total)


def not_closed(total: float) -> str:
    return (
        f"sums to {1e3 * total:.4g} um over the whole turn. Allowed: pitch deviations that sum to zero, rounding to 0.1"
        " um apart."
    )


def _class_is_for_the_gears(tree: Tree) -> Broken:
    module = module_in(tree)
    if module is None:
        return
    diameters = [module * (teeth_in(tree, gear) or 100) for gear in GEARS]
    sizes = [("modules from 0.5 to 70 mm", module, MODULES)]
    sizes += [("reference diameters from 5 mm to 15 m", each, DIAMETERS) for each in diameters]
    for words, size, (least, most) in sizes:
        if not least <= size <= most:
            message = f"is for {words} (ISO 1328-1), not {size:g} mm. Allowed: lists of errors instead."
            yield ("flank_errors", "tolerance_class"), message
