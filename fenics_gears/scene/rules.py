"""Rules between the fields of a scene, beyond what each field allows by itself. Rules of one effect are in its own
module.

The rules read the parsed TOML file, so that they apply even where some field is wrong; a value that they cannot read is
reported elsewhere.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from math import lcm

from fenics_gears import effects
from fenics_gears.inputs.names import nearest
from fenics_gears.inputs.problem import Problem
from fenics_gears.inputs.section import allowed_in, given, names_in
from fenics_gears.inputs.synonyms import meant
from fenics_gears.inputs.tree import (
    GEARS,
    LARGEST_ERROR,
    Tree,
    given_for,
    load_in,
    material_sections,
    over_the_face,
    quantity_at,
    quantity_in,
    table,
    teeth_in,
    value_at,
)
from fenics_gears.inputs.written import as_written
from fenics_gears.scene.accuracy import ELASTIC, ISO_6336, RIGID_TEETH, STIFFNESS_TABLE, Accuracy
from fenics_gears.scene.data import HUNTING_TOOTH_PERIOD
from fenics_gears.scene.drawing_rules import DRAWING_RULES
from fenics_gears.scene.face_rules import faces_are_resolved_by_elastic_contact, fields_of_faces_have_a_face
from fenics_gears.scene.gear_schema import Gears
from fenics_gears.scene.schema import MotionText, SceneText

# In modules: the dense compliance of a flank of such elements has gigabytes.
FINEST_ELEMENT, FINEST_BODY = 1e-3, 1e-2
EVERY_STEP = "every step"
TEETH = "tooth_elasticity"


def broken_rules(tree: Tree) -> list[Problem]:
    """All rules that the parsed file breaks."""
    rules = (*_RULES, *(effect.rules for effect in effects.EFFECTS if effect.rules is not None))
    return [problem for rule in rules for problem in rule(tree)]


def _effects_fit_together(tree: Tree) -> Iterator[Problem]:
    known = [effect.section for effect in effects.top_level()]
    sections = {
        nearest(name, known) or meant((), name, known) or name for name in tree
    }  # a misspelt section is another problem
    # Without [gears] the teeth are unknown.
    if table(tree, "gears") is None or material_sections(tree):
        sections.add(TEETH)
    for effect, need in effects.missing_needs(sections):
        missing = effects.effect_named(need).written
        yield Problem(
            (effect.section,),
            "",
            f"needs the section [{missing}], which is missing. Add [{missing}], or leave [{effect.section}] out.",
        )
    for effect, other in effects.conflicts(sections):
        yield Problem((effect.section,), "", f"cannot stand beside [{other}]. Leave one of the two out.")


def _both_gears_have_a_width(tree: Tree) -> Iterator[Problem]:
    gears = table(tree, "gears")
    if gears is None or "face_width" in gears or all("face_width" in given_for(gears, gear) for gear in GEARS):
        return
    allowed = allowed_in(Gears, "face_width").description
    yield Problem(
        ("gears", "face_width"),
        None,
        f"is missing. Allowed: {allowed}; or face_width of [gears.pinion] and of [gears.wheel].",
    )


# Only with these does time matter; without them a scene is a sequence of positions, each in equilibrium.
NEED_A_SPEED = ("inertia", *(effect.section for effect in effects.EFFECTS if "inertia" in effect.needs))


def _one_speed(tree: Tree) -> Iterator[Problem]:
    motion = table(tree, "motion") or {}
    given = [name for name in ("mesh_frequency", "pinion_speed") if name in motion]
    if len(given) == 2:
        yield Problem(
            ("motion", "pinion_speed"),
            as_written(motion["pinion_speed"]),
            "stands beside mesh_frequency; allowed is one of the two. Leave one out.",
        )
    needing = next((section for section in NEED_A_SPEED if section in tree), None)
    if needing is None or not isinstance(tree.get("motion", {}), Mapping):
        return
    if "motion" not in tree:
        message = (
            f"is missing. Add the section [motion] with its fields: {', '.join(names_in(MotionText))};"
            f" [{needing}] needs a speed."
        )
        yield Problem(("motion",), None, message)
        return
    if not any(
        nearest(name, names) or meant(("motion",), name, names)
        for name in motion
        for names in [("mesh_frequency", "pinion_speed")]
    ):
        message = (
            f'is missing. Allowed: mesh_frequency, such as "200 Hz", or pinion_speed, such as "750 rpm"; [{needing}]'
            " needs one."
        )
        yield Problem(("motion", "mesh_frequency"), None, message)
    if "mesh_cycles" not in motion and "settling_time" not in motion:
        message = (
            f"is missing. Allowed: {allowed_in(MotionText, 'mesh_cycles').description}; [{needing}] needs it, or"
            ' settling_time, such as "25 ms".'
        )
        yield Problem(("motion", "mesh_cycles"), None, message)


def _one_length_of_the_run(tree: Tree) -> Iterator[Problem]:
    motion = table(tree, "motion") or {}
    if "settling_time" not in motion:
        return
    place, written = ("motion", "settling_time"), as_written(motion["settling_time"])
    if "mesh_cycles" in motion:
        yield Problem(place, written, "stands beside mesh_cycles; allowed is one of the two. Leave one out.")
    if "inertia" not in tree:
        yield Problem(
            place,
            written,
            "is for scenes with [inertia]: without it there is no vibration that dies down. Leave it out.",
        )
    if "speed_ramp" in tree:
        yield Problem(
            place,
            written,
            "is for a steady speed. Allowed with [speed_ramp]: mesh_cycles, the length of the whole ramp.",
        )


def _recorded_cycles_are_run(tree: Tree) -> Iterator[Problem]:
    motion = table(tree, "motion") or {}
    recorded, run = (_cycles(tree, motion.get(name)) for name in ("recorded_cycles", "mesh_cycles"))
    if type(recorded) is int and type(run) is int and recorded > run > 0:
        count = "" if motion["recorded_cycles"] == recorded else f"({recorded} mesh cycles) "
        message = (
            f"{count}is more than mesh_cycles = {as_written(motion['mesh_cycles'])}. Allowed: at most as many cycles as"
            " are run."
        )
        yield Problem(("motion", "recorded_cycles"), as_written(motion["recorded_cycles"]), message)


def _contact_fields_are_of_cycles_that_run(tree: Tree) -> Iterator[Problem]:
    written, motion = value_at(tree, "output", "contact_fields"), table(tree, "motion") or {}
    place = ("output", "contact_fields")
    if written is not None and "recorded_cycles" in motion:
        yield Problem(
            place,
            as_written(written),
            "stands beside motion.recorded_cycles, which says the same in another way. Leave one of the two out.",
        )
    asked, run = (
        re.fullmatch(r"last (\d{1,7}) cycles?", written) if isinstance(written, str) else None,
        _cycles(tree, motion.get("mesh_cycles")),
    )
    if asked and type(run) is int and int(asked[1]) > run > 0:
        message = (
            f"is more than motion.mesh_cycles = {as_written(motion['mesh_cycles'])}. Allowed: at most as many cycles as"
            " are run, or true."
        )
        yield Problem(place, as_written(written), message)


def _cycles(tree: Tree, written) -> object:
    """Mesh cycles as a number, also of a whole hunting tooth period; what is written where that is no number of
    cycles."""
    teeth = [teeth_in(tree, gear) for gear in GEARS]
    return lcm(*teeth) if written == HUNTING_TOOTH_PERIOD and None not in teeth else written


def _errors_are_small(tree: Tree) -> Iterator[Problem]:
    """Errors of manufacture and modifications are small against the tooth, whose place and shape stay what they are."""
    module = quantity_at(tree, "gears", "module")
    largest = LARGEST_ERROR * (module or 0.0)
    for path, allowed, written in given(SceneText, tree):
        values = written if isinstance(written, list) else [written]
        size = max((abs(quantity_in(value) or 0.0) for value in values), default=0.0)
        if allowed.small and size > largest > 0.0:
            message = f"is too large an error of manufacture for a module of {module:g} mm: up to {size:.4g} mm."
            yield Problem(path, as_written(written), f"{message} Allowed: up to {largest:g} mm.")


def _resolution_fits_the_teeth(tree: Tree) -> Iterator[Problem]:
    module = _module(tree)
    if module is None:
        return
    accuracy = table(tree, "accuracy") or {}
    for name, modules in (("flank_element_size", 1.0), ("body_element_size", 10.0), ("contact_length", 3.0)):
        size = quantity_in(accuracy.get(name))
        if size is not None and size > modules * module:
            yield Problem(
                ("accuracy", name),
                as_written(accuracy[name]),
                f"is too large for a module of {module:g} mm. Allowed: up to {modules * module:g} mm.",
            )
    for name, modules in (("flank_element_size", FINEST_ELEMENT), ("body_element_size", FINEST_BODY)):
        size, finest = quantity_in(accuracy.get(name)), modules * module
        if size is not None and 0 < size < finest:
            message = (
                f"is too small for a module of {module:g} mm: no memory holds such a mesh. Allowed: from {finest:g} mm."
            )
            yield Problem(("accuracy", name), as_written(accuracy[name]), message)


def _body_is_no_finer_than_the_flank(tree: Tree) -> Iterator[Problem]:
    accuracy = table(tree, "accuracy") or {}
    body, flank = (quantity_in(accuracy.get(name)) for name in ("body_element_size", "flank_element_size"))
    if body is not None and flank is not None and 0 < body < flank:
        message = (
            f"is smaller than flank_element_size = {as_written(accuracy['flank_element_size'])}. Allowed: from that"
            " size on."
        )
        yield Problem(("accuracy", "body_element_size"), as_written(accuracy["body_element_size"]), message)


def _remeshing_has_its_own_nodes(tree: Tree) -> Iterator[Problem]:
    accuracy = table(tree, "accuracy") or {}
    if accuracy.get("condensation") != EVERY_STEP:
        return
    for name in ("interpolation", "elastic_teeth"):
        if name in accuracy:
            message = (
                f'has no meaning beside condensation = "{EVERY_STEP}", where flank nodes meet and the whole gear is'
                " meshed. Leave one of the two out."
            )
            yield Problem(("accuracy", name), as_written(accuracy[name]), message)


def _remeshed_gears_have_one_width(tree: Tree) -> Iterator[Problem]:
    """What stands out beyond the mate helps to carry, by a law for flanks that are condensed once."""
    asked = value_at(tree, "accuracy", "condensation")
    common = quantity_at(tree, "gears", "face_width")
    widths = {quantity_at(tree, "gears", gear, "face_width") or common for gear in GEARS}
    offsets = {quantity_at(tree, "gears", gear, "axial_offset") or 0.0 for gear in GEARS}
    if asked == EVERY_STEP and not over_the_face(tree) and (len(widths) > 1 or len(offsets) > 1):
        remedy = 'Give both gears the width that they have in common, or take condensation = "once".'
        message = f"is for gears of one face width without axial_offset. {remedy}"
        yield Problem(("accuracy", "condensation"), as_written(asked), message)


def _cheaper_models_have_what_they_need(tree: Tree) -> Iterator[Problem]:
    accuracy = table(tree, "accuracy") or {}
    chosen = accuracy.get("model")
    if chosen not in (RIGID_TEETH, STIFFNESS_TABLE, ISO_6336):
        return

    def problem(message: str) -> Problem:
        return Problem(("accuracy", "model"), as_written(chosen), message)

    if chosen != RIGID_TEETH and not material_sections(tree):
        yield problem("needs the section [gears.material], which is missing. Add it, or leave accuracy.model out.")
    if accuracy.get("condensation") == EVERY_STEP:
        yield problem(f'cannot stand beside condensation = "{EVERY_STEP}". Leave one of the two out.')
    if value_at(tree, "output", "root_stress") is True:
        yield problem('has no stresses for output.root_stress. Allowed beside it: "elastic". Leave one of the two out.')
    lacking = {RIGID_TEETH: ("corner_contact",), ISO_6336: ("corner_contact",), STIFFNESS_TABLE: ()}[chosen]
    for section in lacking:
        if section in tree:
            yield problem(f"cannot stand beside [{section}], which it knows nothing of. Leave one of the two out.")


_NOT_BESIDE_A_TARGET = {
    "model": "cannot stand beside accuracy.target, which is for the full contact of elastic teeth",
    "condensation": "cannot stand beside accuracy.target, which condenses once",
    "elastic_teeth": "cannot stand beside accuracy.target, which keeps all teeth elastic",
    "interpolation": "cannot stand beside accuracy.target, which averages",
}


def _a_target_chooses_alone(tree: Tree) -> Iterator[Problem]:
    accuracy, gears = table(tree, "accuracy") or {}, table(tree, "gears") or {}
    if "target" not in accuracy:
        return
    for name in accuracy:
        if name in names_in(Accuracy) and name != "target":
            message = f"{_NOT_BESIDE_A_TARGET.get(name, 'is chosen by accuracy.target')}. Leave one of the two out."
            yield Problem(("accuracy", name), as_written(accuracy[name]), message)

    def problem(message: str) -> Problem:
        return Problem(("accuracy", "target"), as_written(accuracy["target"]), message)

    if gears and not material_sections(tree):
        yield problem("needs teeth that give way. Add [gears.material], or leave the target out.")
    load = load_in(tree)
    if load is not None and load[1] == 0.0:
        yield problem(
            f"has no meaning without a load: nothing gives way then. Give {'.'.join(load[0])}, or leave the target out."
        )
    if "body_meshes" in tree:
        yield problem("cannot refine the meshes of [body_meshes]. Leave one of the two out.")


def _root_stress_has_its_teeth(tree: Tree) -> Iterator[Problem]:
    if value_at(tree, "output", "root_stress") is not True:
        return
    if table(tree, "gears") is not None and not material_sections(tree):
        yield Problem(
            ("output", "root_stress"),
            "true",
            "needs teeth that give way. Add [gears.material], or leave root_stress out.",
        )
    accuracy = table(tree, "accuracy") or {}
    if accuracy.get("model", ELASTIC) != ELASTIC:
        yield Problem(
            ("output", "root_stress"),
            "true",
            f'needs teeth of finite elements. Take accuracy.model = "{ELASTIC}", or leave root_stress out.',
        )
    if accuracy.get("condensation") == EVERY_STEP:
        yield Problem(
            ("output", "root_stress"),
            "true",
            f'cannot stand beside condensation = "{EVERY_STEP}". Take "once", or leave root_stress out.',
        )


_RULES = (
    _effects_fit_together,
    _both_gears_have_a_width,
    _one_speed,
    _one_length_of_the_run,
    _recorded_cycles_are_run,
    _contact_fields_are_of_cycles_that_run,
    _errors_are_small,
    _resolution_fits_the_teeth,
    _body_is_no_finer_than_the_flank,
    _remeshing_has_its_own_nodes,
    _remeshed_gears_have_one_width,
    _root_stress_has_its_teeth,
    _cheaper_models_have_what_they_need,
    _a_target_chooses_alone,
    faces_are_resolved_by_elastic_contact,
    fields_of_faces_have_a_face,
    *DRAWING_RULES,
)


def _module(tree: Tree) -> float | None:
    """The module in mm; None where it is missing or wrong by itself."""
    module = quantity_at(tree, "gears", "module")
    if module is None:
        return None
    allowed = allowed_in(Gears, "module")
    return module if allowed.lowest <= module <= allowed.highest else None
