"""Rules between the fields of ``[motion]``, ``[accuracy]`` and ``[output]``, and what they need of a scene."""

import re
from collections.abc import Mapping
from math import lcm

from fenics_gears import effects
from fenics_gears.inputs.problem import Broken, meant, nearest
from fenics_gears.inputs.section import allowed_in, fields_of, names_in
from fenics_gears.inputs.tree import (
    GEARS,
    Tree,
    load_in,
    material_sections,
    module_in,
    quantity_in,
    table,
    teeth_in,
    value_at,
)
from fenics_gears.inputs.written import as_written

from .accuracy import ELASTIC, ISO_6336, RIGID_TEETH, STIFFNESS_TABLE, Accuracy
from .gear_schema import Gears
from .schema import HUNTING_TOOTH_PERIOD, MotionText

# Smallest and largest sizes in modules: the dense compliance of a flank of finer elements has gigabytes.
FINEST_ELEMENT = 1e-3
FINEST_BODY = 1e-2
_SIZES = (
    ("flank_element_size", FINEST_ELEMENT, 1.0),
    ("body_element_size", FINEST_BODY, 10.0),
    ("contact_length", 0.0, 3.0),
)
EVERY_STEP = "every step"


def a_speed_where_time_matters(tree: Tree) -> Broken:
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


def settling_is_of_vibrations(tree: Tree) -> Broken:
    motion = table(tree, "motion") or {}
    if "settling_time" not in motion:
        return
    place = ("motion", "settling_time")
    if "inertia" not in tree:
        yield place, "is for scenes with [inertia]: without it there is no vibration that dies down. Leave it out."
    if "speed_ramp" in tree:
        yield place, "is for a steady speed. Allowed with [speed_ramp]: mesh_cycles, the length of the whole ramp."


def recorded_cycles_are_run(tree: Tree) -> Broken:
    motion = table(tree, "motion") or {}
    recorded, run = (_cycles(tree, motion.get(name)) for name in ("recorded_cycles", "mesh_cycles"))
    if type(recorded) is int and type(run) is int and recorded > run > 0:
        count = "" if motion["recorded_cycles"] == recorded else f"({recorded} mesh cycles) "
        more = f"{count}is more than mesh_cycles = {as_written(motion['mesh_cycles'])}"
        yield ("motion", "recorded_cycles"), f"{more}. Allowed: at most that."


def contact_fields_are_of_cycles_that_run(tree: Tree) -> Broken:
    written = value_at(tree, "output", "contact_fields")
    motion = table(tree, "motion") or {}
    place = ("output", "contact_fields")
    if written is not None and "recorded_cycles" in motion:
        yield place, "is given together with motion.recorded_cycles, which says the same. Leave one of the two out."
    asked = re.fullmatch(r"last (\d{1,7}) cycles?", written) if isinstance(written, str) else None
    run = _cycles(tree, motion.get("mesh_cycles"))
    if asked and type(run) is int and int(asked[1]) > run > 0:
        yield place, f"is more than motion.mesh_cycles = {as_written(motion['mesh_cycles'])}. Allowed: at most that."


def _cycles(tree: Tree, written) -> object:
    """Mesh cycles as a number, also of a whole hunting tooth period; else what is written."""
    teeth = [teeth_in(tree, gear) for gear in GEARS]
    return lcm(*teeth) if written == HUNTING_TOOTH_PERIOD and None not in teeth else written


def _resolution_fits_the_teeth(tree: Tree) -> Broken:
    module = _module(tree)
    if module is None:
        return
    accuracy = table(tree, "accuracy") or {}
    for name, finest, coarsest in _SIZES:
        size = quantity_in(accuracy.get(name))
        smallest = finest * module
        largest = coarsest * module
        if size is None:
            continue
        if size > largest:
            yield ("accuracy", name), f"is too large for a module of {module:g} mm. Allowed: up to {largest:g} mm."
        elif 0 < size < smallest:
            yield ("accuracy", name), f"is too small for a module of {module:g} mm. Allowed: from {smallest:g} mm."


def _body_is_no_finer_than_the_flank(tree: Tree) -> Broken:
    accuracy = table(tree, "accuracy") or {}
    body, flank = (quantity_in(accuracy.get(name)) for name in ("body_element_size", "flank_element_size"))
    if body is not None and flank is not None and 0 < body < flank:
        least = f"flank_element_size = {as_written(accuracy['flank_element_size'])}"
        yield ("accuracy", "body_element_size"), f"is smaller than {least}. Allowed: from that size on."


def _remeshing_has_its_own_nodes(tree: Tree) -> Broken:
    accuracy = table(tree, "accuracy") or {}
    if accuracy.get("condensation") != EVERY_STEP:
        return
    for name in ("interpolation", "elastic_teeth"):
        if name in accuracy:
            yield ("accuracy", name), f'has no meaning with condensation = "{EVERY_STEP}". Leave one of the two out.'


def _cheaper_models_have_what_they_need(tree: Tree) -> Broken:
    accuracy = table(tree, "accuracy") or {}
    place = ("accuracy", "model")
    chosen = accuracy.get("model")
    if chosen not in (RIGID_TEETH, STIFFNESS_TABLE, ISO_6336):
        return
    if chosen != RIGID_TEETH and not material_sections(tree):
        yield place, "needs the section [gears.material], which is missing. Add it, or leave accuracy.model out."
    if accuracy.get("condensation") == EVERY_STEP:
        yield place, f'cannot be combined with condensation = "{EVERY_STEP}". Leave one of the two out.'
    if value_at(tree, "output", "root_stress") is True:
        yield place, 'has no stresses for output.root_stress. Allowed with it: "elastic". Leave one of the two out.'
    if chosen != STIFFNESS_TABLE and "corner_contact" in tree:
        yield place, "cannot be combined with [corner_contact], which it knows nothing of. Leave one of the two out."


_NOT_BESIDE_A_TARGET = {
    "model": "cannot be combined with accuracy.target, which is for the full contact of elastic teeth",
    "condensation": "cannot be combined with accuracy.target, which condenses once",
    "elastic_teeth": "cannot be combined with accuracy.target, which keeps all teeth elastic",
    "interpolation": "cannot be combined with accuracy.target, which averages",
}


def _a_target_chooses_alone(tree: Tree) -> Broken:
    accuracy = table(tree, "accuracy") or {}
    gears = table(tree, "gears") or {}
    place = ("accuracy", "target")
    if "target" not in accuracy:
        return
    for name in accuracy:
        if name in names_in(Accuracy) and name != "target":
            message = f"{_NOT_BESIDE_A_TARGET.get(name, 'is chosen by accuracy.target')}. Leave one of the two out."
            yield ("accuracy", name), message
    if gears and not material_sections(tree):
        yield place, "needs elastic teeth. Add [gears.material], or leave the target out."
    load = load_in(tree)
    if load is not None and load[1] == 0.0:
        home = ".".join(load[0])
        yield place, f"has no meaning without a load. Give {home}, or leave the target out."
    if "body_meshes" in tree:
        yield place, "cannot refine the meshes of [body_meshes]. Leave one of the two out."


def _root_stress_has_its_teeth(tree: Tree) -> Broken:
    place = ("output", "root_stress")
    accuracy = table(tree, "accuracy") or {}
    if value_at(tree, *place) is not True:
        return
    if table(tree, "gears") is not None and not material_sections(tree):
        yield place, "needs elastic teeth. Add [gears.material], or leave root_stress out."
    if accuracy.get("model", ELASTIC) != ELASTIC:
        yield place, f'needs teeth of finite elements. Take accuracy.model = "{ELASTIC}", or leave root_stress out.'
    if accuracy.get("condensation") == EVERY_STEP:
        yield place, f'cannot be combined with condensation = "{EVERY_STEP}". Take "once", or leave root_stress out.'


def _module(tree: Tree) -> float | None:
    """The module in mm; None where it is missing or wrong by itself."""
    module = module_in(tree)
    if module is None:
        return None
    allowed = allowed_in(Gears, "module")
    return module if allowed.lowest <= module <= allowed.highest else None


ACCURACY_RULES = (
    _resolution_fits_the_teeth,
    _body_is_no_finer_than_the_flank,
    _remeshing_has_its_own_nodes,
    _root_stress_has_its_teeth,
    _cheaper_models_have_what_they_need,
    _a_target_chooses_alone,
)
