"""Rules of what a drawing may leave out: of alternatives one is given, and what belongs together is there."""

from collections.abc import Mapping
from math import degrees

from fenics_gears.inputs import units
from fenics_gears.inputs.problem import Broken
from fenics_gears.inputs.section import allowed_in
from fenics_gears.inputs.tree import (
    GEARS,
    LOADS,
    MODULES,
    PRESSURE_ANGLES,
    Tree,
    in_normal_section,
    pressure_angle_in,
    quantity_at,
    table,
    with_gears,
)

from .gear_schema import MEASURES, Gear, Gears
from .schema import LoadText


def _teeth_have_a_size(tree: Tree) -> Broken:
    gears = table(tree, "gears")
    helix_angle = quantity_at(tree, "gears", "helix_angle") or 0.0
    for names in (MODULES, PRESSURE_ANGLES) if gears is not None else ():
        allowed = allowed_in(Gears, names[0])
        name = next((each for each in names if each in gears), None)
        number = quantity_at(tree, "gears", name) if name is not None else None
        if name is None:
            others = ", ".join(names[1:-1]) + " or " * (len(names) > 2) + names[-1]
            yield ("gears", names[0]), f"is missing. Allowed: {allowed.description}; or {others}."
        elif name != names[0] and number:
            found = in_normal_section(name, number, helix_angle)
            if not allowed.lowest <= found <= allowed.highest:
                words = f"{found / units.quantity(f'1 {allowed.unit}')[0]:.4g} {allowed.unit}"
                message = f"makes {names[0]} = {words} in the normal section. Allowed of that: {allowed.description}."
                yield ("gears", name), message


# Names by which an internal gear is asked for.
INTERNAL = ("internal", "internal_gear", "internal_teeth", "ring", "ring_gear")


def _gears_are_external(tree: Tree) -> Broken:
    for path, section in with_gears(tree, "gears").items():
        for name in (each for each in INTERNAL if each in section):
            message = "is not known: internal gears are not computed yet. Allowed: two external gears. Leave it out."
            yield (*path, name), message


def _thickness_is_given_once(tree: Tree) -> Broken:
    gears = table(tree, "gears") or {}
    for gear in GEARS:
        own = table(gears, gear)
        if own is None:
            continue
        measures = [name for name in MEASURES if name in own]
        if not measures and "profile_shift" not in own:
            allowed = allowed_in(Gear, "profile_shift").description
            yield ("gears", gear, "profile_shift"), f"is missing. Allowed: {allowed}; or one of {', '.join(MEASURES)}."
        for name in measures:
            beside = MEASURES[name]
            if beside is not None and beside not in own:
                allowed = allowed_in(Gear, beside).description
                yield ("gears", gear, beside), f"is missing. Allowed: {allowed}; {name} has no meaning without it."


def _backlash_has_its_place(tree: Tree) -> Broken:
    """A backlash is made by thinner teeth of both gears, or by the centre distance of measured ones."""
    gears = table(tree, "gears") or {}
    if "backlash" not in gears:
        return
    measured = [f"gears.{gear}.{name}" for gear in GEARS for name in MEASURES if name in (table(gears, gear) or {})]
    if measured and (len({name.split(".")[1] for name in measured}) == 1 or "centre_distance" in gears):
        beside = measured[0] if "centre_distance" not in gears else f"{measured[0]} and gears.centre_distance"
        message = (
            f"stands beside {beside}, of which it follows. Allowed: profile shifts of both gears alone, or measured"
            " tooth thicknesses of both without centre_distance."
        )
        yield ("gears", "backlash"), message


def _no_figure_is_given_twice(tree: Tree) -> Broken:
    gears = table(tree, "gears") or {}
    if "tip_shortening" in gears and all("tip_diameter" in (table(gears, gear) or {}) for gear in GEARS):
        message = "stands beside the tip diameters of both gears, which say the same. Leave it out, or a tip diameter."
        yield ("gears", "tip_shortening"), message
    for gear in GEARS:
        own = table(gears, gear) or {}
        rack = table(own, "rack") or {}
        for name, diameter in (
            ("addendum", "tip_diameter"),
            ("dedendum", "root_diameter"),
            ("tip_radius", "rack_tip_radius"),
        ):
            if name in rack and diameter in own:
                message = f"stands beside gears.{gear}.{diameter}, which says the same. Leave one of the two out."
                yield ("gears", gear, "rack", name), message


def _protuberance_is_more_than_the_stock(tree: Tree) -> Broken:
    """Finishing takes no more than the protuberance has cut free, or it leaves a step in the root."""
    gears = table(tree, "gears") or {}
    found = {}
    pressure_angle = pressure_angle_in(tree)
    for gear in GEARS:
        amount, stock, angle = (
            _of_rack(gears, gear, name) for name in ("protuberance", "finishing_stock", "protuberance_angle")
        )
        cut = amount[1] if amount else 0.0
        if stock and stock[1] > cut:
            why = f"is more than the protuberance of the {gear}'s rack: finishing would leave a step in the root"
            found[stock[0]] = f"{why}. Allowed: up to {cut:.4g} mm."
        if angle and not cut:
            found[angle[0]] = "has no meaning without a protuberance. Give protuberance, or leave both out."
        elif angle and pressure_angle and angle[1] >= pressure_angle:
            found[angle[0]] = f"must be less than the pressure angle, {degrees(pressure_angle):.6g} deg. Lower it."
    yield from found.items()


def _of_rack(gears: Tree, gear: str, figure: str) -> tuple[tuple[str, ...], float] | None:
    """Where a quantity of a gear's rack is written, its own section first, and its number."""
    for path in ((gear, "rack", figure), ("rack", figure)):
        number = quantity_at(gears, *path)
        if number is not None:
            return ("gears", *path), number
    return None


def _load_is_given_once(tree: Tree) -> Broken:
    load = table(tree, "load")
    motion = tree.get("motion", {})
    if load is None:
        return
    given = [name for name in LOADS if name in load]
    if not given:
        message = f"is missing. Allowed: {allowed_in(LoadText, 'wheel_torque').description}; or pinion_torque or power."
        yield ("load", "wheel_torque"), message
    if "power" not in given:
        return
    if isinstance(motion, Mapping) and not {"mesh_frequency", "pinion_speed"} & set(motion):
        message = 'needs a speed. Add motion.pinion_speed, such as "1500 rpm", or mesh_frequency, or give a torque.'
        yield ("load", "power"), message
    if "speed_ramp" in tree:
        yield ("load", "power"), "has no one torque beside [speed_ramp]. Give wheel_torque or pinion_torque."


DRAWING_RULES = (
    _teeth_have_a_size,
    _gears_are_external,
    _thickness_is_given_once,
    _backlash_has_its_place,
    _no_figure_is_given_twice,
    _protuberance_is_more_than_the_stock,
    _load_is_given_once,
)
