"""Rules between the fields of a scene; those of one effect are in its own module.

They read the parsed TOML file, so that they apply even where some field is wrong; a value that they cannot read is
reported elsewhere.
"""

import re
from collections.abc import Iterable, Mapping
from itertools import chain
from math import lcm

from fenics_gears import effects
from fenics_gears.inputs.problem import Broken, Problem, meant, nearest
from fenics_gears.inputs.section import allowed_in, fields_of, given, names_in
from fenics_gears.inputs.tree import (
    GEARS,
    LARGEST_ERROR,
    MODULES,
    NOT_IN_THE_PLANE,
    Tree,
    given_for,
    load_in,
    material_sections,
    module_in,
    over_the_face,
    quantity_at,
    quantity_in,
    table,
    teeth_in,
    value_at,
)
from fenics_gears.inputs.written import as_written

from .accuracy_rules import ACCURACY_RULES, EVERY_STEP
from .data import HUNTING_TOOTH_PERIOD
from .drawing_rules import DRAWING_RULES
from .gear_schema import Gears
from .schema import MotionText, scene_text

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
    found = ((path, value_at(tree, *path), message) for path, message in broken)
    return [Problem(path, None if value is None else as_written(value), message) for path, value, message in found]


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
        yield (effect.section,), f"cannot stand beside [{other}]. Leave one of the two out."


def _both_gears_have_a_width(tree: Tree) -> Broken:
    gears = table(tree, "gears")
    if gears is None or "face_width" in gears or all("face_width" in given_for(gears, gear) for gear in GEARS):
        return
    allowed = allowed_in(Gears, "face_width").description
    message = f"is missing. Allowed: {allowed}; or face_width of [gears.pinion] and of [gears.wheel]."
    yield ("gears", "face_width"), message


def _a_speed_where_time_matters(tree: Tree) -> Broken:
    motion = table(tree, "motion") or {}
    # Without these a scene is a sequence of positions, each in equilibrium.
    named = (each for each in effects.AT_THE_TOP if each in tree)
    needing = next((each for each in named if "inertia" in (each, *effects.effect_named(each).needs)), None)
    if needing is None or not isinstance(tree.get("motion", {}), Mapping):
        return
    if "motion" not in tree:
        yield (
            ("motion",),
            f"is missing. Add the section [motion] with {fields_of(MotionText)}; [{needing}] needs a speed.",
        )
        return
    names = ("mesh_frequency", "pinion_speed")
    if not any(nearest(name, names) or meant(("motion",), name, names) for name in motion):
        either = 'mesh_frequency, such as "200 Hz", or pinion_speed, such as "750 rpm"'
        yield ("motion", "mesh_frequency"), f"is missing. Allowed: {either}; [{needing}] needs one."
    if "mesh_cycles" not in motion and "settling_time" not in motion:
        allowed = allowed_in(MotionText, "mesh_cycles").description
        message = f'is missing. Allowed: {allowed}; [{needing}] needs it, or settling_time, such as "25 ms".'
        yield ("motion", "mesh_cycles"), message


def _a_wheel_that_drives_has_coast_flanks(tree: Tree) -> Broken:
    load = load_in(tree)
    if load is not None and load[1] < 0.0 and "coast_flanks" not in tree:
        unit = "kW" if load[0][-1] == "power" else "N m"
        why = "is negative: it drives the pair from the wheel"
        yield load[0], f"{why}. Allowed: with the section [coast_flanks] any sign, without it 0 {unit} and above."


def _settling_is_of_vibrations(tree: Tree) -> Broken:
    motion = table(tree, "motion") or {}
    if "settling_time" not in motion:
        return
    place = ("motion", "settling_time")
    if "inertia" not in tree:
        yield place, "is for scenes with [inertia]: without it there is no vibration that dies down. Leave it out."
    if "speed_ramp" in tree:
        yield place, "is for a steady speed. Allowed with [speed_ramp]: mesh_cycles, the length of the whole ramp."


def _recorded_cycles_are_run(tree: Tree) -> Broken:
    motion = table(tree, "motion") or {}
    recorded, run = (_cycles(tree, motion.get(name)) for name in ("recorded_cycles", "mesh_cycles"))
    if type(recorded) is int and type(run) is int and recorded > run > 0:
        count = "" if motion["recorded_cycles"] == recorded else f"({recorded} mesh cycles) "
        more = f"{count}is more than mesh_cycles = {as_written(motion['mesh_cycles'])}"
        yield ("motion", "recorded_cycles"), f"{more}. Allowed: at most that."


def _contact_fields_are_of_cycles_that_run(tree: Tree) -> Broken:
    written = value_at(tree, "output", "contact_fields")
    motion = table(tree, "motion") or {}
    place = ("output", "contact_fields")
    if written is not None and "recorded_cycles" in motion:
        yield place, "stands beside motion.recorded_cycles, which says the same. Leave one of the two out."
    asked = re.fullmatch(r"last (\d{1,7}) cycles?", written) if isinstance(written, str) else None
    run = _cycles(tree, motion.get("mesh_cycles"))
    if asked and type(run) is int and int(asked[1]) > run > 0:
        yield place, f"is more than motion.mesh_cycles = {as_written(motion['mesh_cycles'])}. Allowed: at most that."


def _cycles(tree: Tree, written) -> object:
    """Mesh cycles as a number, also of a whole hunting tooth period; else what is written."""
    teeth = [teeth_in(tree, gear) for gear in GEARS]
    return lcm(*teeth) if written == HUNTING_TOOTH_PERIOD and None not in teeth else written


def _errors_are_small(tree: Tree) -> Broken:
    """Errors of manufacture and modifications are small against the tooth, whose place and shape stay what they are."""
    module = module_in(tree)
    largest = LARGEST_ERROR * (module or 0.0)
    for path, allowed, written in given(scene_text(tree), tree):
        values = (written if isinstance(written, list) else [written]) if allowed.small else []
        size = max((abs(quantity_in(value) or 0.0) for value in values), default=0.0)
        if size > largest > 0.0:
            message = f"is too large an error of manufacture for a module of {module:g} mm: up to {size:.4g} mm."
            yield path, f"{message} Allowed: up to {largest:g} mm."


def _flanks_are_resolved_over_the_face(tree: Tree) -> Broken:
    """Fields of faces belong to three-dimensional scenes, which have rules of their own, and a hand to a helix."""
    if reasons := over_the_face(tree):
        # Imported here: plane scenes have none.
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
    """What stands out beyond the mate helps to carry, by a law for flanks that are condensed once."""
    asked = value_at(tree, "accuracy", "condensation")
    common = quantity_at(tree, "gears", "face_width")
    widths = {quantity_at(tree, "gears", gear, "face_width") or common for gear in GEARS}
    offsets = {quantity_at(tree, "gears", gear, "axial_offset") or 0.0 for gear in GEARS}
    if asked == EVERY_STEP and (len(widths) > 1 or len(offsets) > 1):
        remedy = 'Give both gears their common width, or take condensation = "once".'
        yield ("accuracy", "condensation"), f"is for gears of one face width without axial_offset. {remedy}"


_RULES = (
    _effects_fit_together,
    _both_gears_have_a_width,
    _a_speed_where_time_matters,
    _a_wheel_that_drives_has_coast_flanks,
    _settling_is_of_vibrations,
    _recorded_cycles_are_run,
    _contact_fields_are_of_cycles_that_run,
    _errors_are_small,
    *ACCURACY_RULES,
    _flanks_are_resolved_over_the_face,
    *DRAWING_RULES,
)
