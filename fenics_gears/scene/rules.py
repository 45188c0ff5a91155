"""Rules between the fields of a scene, and of what a drawing may leave out. Rules of one effect are in its own module,
rules of speed and accuracy in ``accuracy_rules``.

They read the parsed TOML file, so that they apply even where some field is wrong; a value that they cannot read is
reported elsewhere.
"""

from collections.abc import Iterable, Mapping
from itertools import chain
from math import degrees

from fenics_gears import effects
from fenics_gears.inputs import units
from fenics_gears.inputs.problem import Broken, Problem, meant, nearest
from fenics_gears.inputs.section import allowed_in, given, names_in
from fenics_gears.inputs.tree import (
    GEARS,
    INTERNAL,
    LARGEST_ERROR,
    LOADS,
    MODULES,
    NOT_IN_THE_PLANE,
    OF_INTERNAL,
    PRESSURE_ANGLES,
    Tree,
    given_for,
    in_normal_section,
    is_internal,
    load_in,
    material_sections,
    module_in,
    over_the_face,
    pressure_angle_in,
    quantity_at,
    quantity_in,
    table,
    value_at,
    with_gears,
)
from fenics_gears.inputs.written import as_written

from .accuracy_rules import (
    ACCURACY_RULES,
    EVERY_STEP,
    a_speed_where_time_matters,
    contact_fields_are_of_cycles_that_run,
    recorded_cycles_are_run,
    settling_is_of_vibrations,
)
from .gear_schema import MEASURES, Gears, GearText
from .schema import LoadText, scene_text

TEETH = "tooth_elasticity"


def broken_rules(tree: Tree) -> list[Problem]:
    """All rules that the parsed file breaks, with what is written there."""
    named = (effects.effect_named(each) for each in effects.SECTIONS if each in (TEETH, *tree))
    rules = (*_RULES, *(effect.rules for effect in named if effect.rules is not None))
    return _problems(tree, chain.from_iterable(rule(tree) for rule in rules))


def broken_by_numbers(tree: Tree, sections: Iterable[str]) -> list[Problem]:
    """Of those rules the ones that other numbers in the sections of some effects can break, where each of these
    effects acts by itself."""
    named = [name for name in sections if name in tree]
    of_teeth = {name: value_at(tree, "gears", name) for name in (*MODULES, "helix_angle")}
    small = _errors_are_small({"gears": of_teeth} | {name: tree[name] for name in named})
    rules = (rules for name in named if (rules := effects.effect_named(name).rules) is not None)
    return _problems(tree, chain(small, *(rule(tree) for rule in rules)))


def _problems(tree: Tree, broken: Broken) -> list[Problem]:
    wrong = ((path, value_at(tree, *path), message) for path, message in broken)
    return [Problem(path, None if value is None else as_written(value), message) for path, value, message in wrong]


def _effects_fit_together(tree: Tree) -> Broken:
    known = effects.AT_THE_TOP
    always = names_in(scene_text(()))
    # A misspelt section is another problem.
    sections = {name if name in always else nearest(name, known) or meant((), name, known) or name for name in tree}
    # Without [gears] the teeth are unknown.
    if table(tree, "gears") is None or material_sections(tree):
        sections.add(TEETH)
    for effect, need in effects.missing_needs(sections):
        if effect.section in tree:
            missing = f"[{effects.effect_named(need).written}]"
            remedy = f"Add {missing}, or leave [{effect.section}] out."
            yield (effect.section,), f"needs the section {missing}, which is missing. {remedy}"
    for effect, other in effects.conflicts(sections):
        yield (effect.section,), f"cannot be combined with [{other}]. Leave one of the two out."


def _both_gears_have_a_width(tree: Tree) -> Broken:
    gears = table(tree, "gears")
    if gears is None or "face_width" in gears or all("face_width" in given_for(gears, gear) for gear in GEARS):
        return
    allowed = allowed_in(Gears, "face_width").description
    message = f"is missing. Allowed: {allowed}; or face_width of [gears.pinion] and of [gears.wheel]."
    yield ("gears", "face_width"), message


def _a_wheel_that_drives_has_coast_flanks(tree: Tree) -> Broken:
    load = load_in(tree)
    # The torque of a power is negative too where the speed is, which is told by itself.
    if load is not None and (quantity_at(tree, *load[0]) or 0.0) < 0.0 and "coast_flanks" not in tree:
        unit = "kW" if load[0][-1] == "power" else "N m"
        why = "is negative: it drives the pair from the wheel"
        yield load[0], f"{why}. Allowed: with the section [coast_flanks] any sign, without it 0 {unit} and above."


def _errors_are_small(tree: Tree) -> Broken:
    """Errors of manufacture and modifications are small against the tooth, whose place and shape stay what they are."""
    module = module_in(tree)
    largest = LARGEST_ERROR * (module or 0.0)
    for path, allowed, written in given(scene_text(tree), tree):
        values = (written if isinstance(written, list) else [written]) if allowed.small else []
        size = max((abs(quantity_in(value) or 0.0) for value in values), default=0.0)
        if size > largest > 0.0:
            reached = f": up to {size:.4g} mm" if isinstance(written, list) else ""
            message = f"is too large an error of manufacture or modification for a module of {module:g} mm{reached}."
            yield path, f"{message} Allowed: up to {largest:g} mm."


def _flanks_are_resolved_over_the_face(tree: Tree) -> Broken:
    """Fields of faces belong to three-dimensional scenes, which have rules of their own, and a hand to a helix."""
    if reasons := over_the_face(tree):
        from .face_rules import rules_over_the_face

        yield from rules_over_the_face(tree, reasons)
    else:
        for path, allowed, _ in given(scene_text(tree), tree):
            if allowed.over_face:
                yield path, NOT_IN_THE_PLANE
        yield from _remeshed_gears_have_one_width(tree)
    gears = table(tree, "gears") or {}
    if "pinion_hand" in gears and "helix_angle" not in gears:
        yield ("gears", "helix_angle"), 'is missing. Allowed: such as "15 deg". Or leave out pinion_hand.'


def _remeshed_gears_have_one_width(tree: Tree) -> Broken:
    """An overhang beyond the mate helps to carry, by a law for flanks that are condensed once."""
    asked = value_at(tree, "accuracy", "condensation")
    common = quantity_at(tree, "gears", "face_width")
    widths = {quantity_at(tree, "gears", gear, "face_width") or common for gear in GEARS}
    offsets = {quantity_at(tree, "gears", gear, "axial_offset") or 0.0 for gear in GEARS}
    if asked == EVERY_STEP and (len(widths) > 1 or len(offsets) > 1):
        remedy = 'Give both gears their common width, or take condensation = "once".'
        yield ("accuracy", "condensation"), f"is for gears of one face width without axial_offset. {remedy}"


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
            size = in_normal_section(name, number, helix_angle)
            if not allowed.lowest <= size <= allowed.highest:
                words = f"{size / units.quantity(f'1 {allowed.unit}')[0]:.4g} {allowed.unit}"
                message = f"makes {names[0]} = {words} in the normal section. Allowed of that: {allowed.description}."
                yield ("gears", name), message


def _gears_have_their_bodies(tree: Tree) -> Broken:
    """What an internal gear has is told by rules of its own."""
    both, *gears = with_gears(tree, "gears").values()
    external = not any(is_internal(tree, gear) for gear in GEARS)
    if external and not {*both, *gears[0], *gears[1]} & {*OF_INTERNAL, *INTERNAL}:
        return
    from .internal_rules import gears_have_their_bodies, internal_gears_have_negative_teeth

    yield from internal_gears_have_negative_teeth(tree)
    yield from gears_have_their_bodies(tree)


def _thickness_is_given_once(tree: Tree) -> Broken:
    gears = table(tree, "gears") or {}
    for gear in GEARS:
        own = table(gears, gear)
        if own is None:
            continue
        measures = [name for name in MEASURES if name in own]
        for name in measures:
            beside = MEASURES[name]
            if beside is not None and beside not in own:
                allowed = allowed_in(GearText, beside).description
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
            f"is given together with {beside}, from which it follows. Allowed: profile shifts of both gears alone, or"
            " measured tooth thicknesses of both without centre_distance."
        )
        yield ("gears", "backlash"), message


def _no_figure_is_given_twice(tree: Tree) -> Broken:
    gears = table(tree, "gears") or {}
    if "tip_shortening" in gears and all("tip_diameter" in (table(gears, gear) or {}) for gear in GEARS):
        message = (
            "is given together with the tip diameters of both gears, which say the same. Leave it out, or a tip"
            " diameter."
        )
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
                message = f"is given together with gears.{gear}.{diameter}, which says the same. Leave one out."
                yield ("gears", gear, "rack", name), message


def _protuberance_is_more_than_the_stock(tree: Tree) -> Broken:
    """Finishing takes no more than the protuberance has cut free, or it leaves a step in the root."""
    gears = table(tree, "gears") or {}
    wrong = {}
    pressure_angle = pressure_angle_in(tree)
    for gear in GEARS:
        amount, stock, angle = (
            _of_rack(gears, gear, name) for name in ("protuberance", "finishing_stock", "protuberance_angle")
        )
        cut = amount[1] if amount else 0.0
        if stock and stock[1] > cut:
            why = f"is more than the protuberance of the {gear}'s rack: finishing would leave a step in the root"
            wrong[stock[0]] = f"{why}. Allowed: up to {cut:.4g} mm."
        if angle and not cut:
            wrong[angle[0]] = "has no meaning without a protuberance. Give protuberance, or leave both out."
        elif angle and pressure_angle and angle[1] >= pressure_angle:
            wrong[angle[0]] = f"must be less than the pressure angle, {degrees(pressure_angle):.6g} deg. Lower it."
    yield from wrong.items()


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
        yield ("load", "power"), "has no constant torque with [speed_ramp]. Give wheel_torque or pinion_torque."


_RULES = (
    _effects_fit_together,
    _both_gears_have_a_width,
    a_speed_where_time_matters,
    _a_wheel_that_drives_has_coast_flanks,
    settling_is_of_vibrations,
    recorded_cycles_are_run,
    contact_fields_are_of_cycles_that_run,
    _errors_are_small,
    *ACCURACY_RULES,
    _flanks_are_resolved_over_the_face,
    _teeth_have_a_size,
    _gears_have_their_bodies,
    _thickness_is_given_once,
    _backlash_has_its_place,
    _no_figure_is_given_twice,
    _protuberance_is_more_than_the_stock,
    _load_is_given_once,
)
