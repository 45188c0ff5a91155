"""Rules between the fields of ``[accuracy]`` and ``[output]``, and what they need of a scene."""

from fenics_gears.inputs.problem import Broken
from fenics_gears.inputs.section import allowed_in, names_in
from fenics_gears.inputs.tree import Tree, load_in, material_sections, module_in, quantity_in, table, value_at
from fenics_gears.inputs.written import as_written

from .accuracy import ELASTIC, ISO_6336, RIGID_TEETH, STIFFNESS_TABLE, Accuracy
from .gear_schema import Gears

# Smallest and largest sizes in modules: the dense compliance of a flank of finer elements has gigabytes.
FINEST_ELEMENT = 1e-3
FINEST_BODY = 1e-2
_SIZES = (
    ("flank_element_size", FINEST_ELEMENT, 1.0),
    ("body_element_size", FINEST_BODY, 10.0),
    ("contact_length", 0.0, 3.0),
)
EVERY_STEP = "every step"


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
            yield ("accuracy", name), f'has no meaning beside condensation = "{EVERY_STEP}". Leave one of the two out.'


def _cheaper_models_have_what_they_need(tree: Tree) -> Broken:
    accuracy = table(tree, "accuracy") or {}
    place = ("accuracy", "model")
    chosen = accuracy.get("model")
    if chosen not in (RIGID_TEETH, STIFFNESS_TABLE, ISO_6336):
        return
    if chosen != RIGID_TEETH and not material_sections(tree):
        yield place, "needs the section [gears.material], which is missing. Add it, or leave accuracy.model out."
    if accuracy.get("condensation") == EVERY_STEP:
        yield place, f'cannot stand beside condensation = "{EVERY_STEP}". Leave one of the two out.'
    if value_at(tree, "output", "root_stress") is True:
        yield place, 'has no stresses for output.root_stress. Allowed beside it: "elastic". Leave one of the two out.'
    if chosen != STIFFNESS_TABLE and "corner_contact" in tree:
        yield place, "cannot stand beside [corner_contact], which it knows nothing of. Leave one of the two out."


_NOT_BESIDE_A_TARGET = {
    "model": "cannot stand beside accuracy.target, which is for the full contact of elastic teeth",
    "condensation": "cannot stand beside accuracy.target, which condenses once",
    "elastic_teeth": "cannot stand beside accuracy.target, which keeps all teeth elastic",
    "interpolation": "cannot stand beside accuracy.target, which averages",
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
        yield place, "needs teeth that give way. Add [gears.material], or leave the target out."
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
        yield place, "needs teeth that give way. Add [gears.material], or leave root_stress out."
    if accuracy.get("model", ELASTIC) != ELASTIC:
        yield place, f'needs teeth of finite elements. Take accuracy.model = "{ELASTIC}", or leave root_stress out.'
    if accuracy.get("condensation") == EVERY_STEP:
        yield place, f'cannot stand beside condensation = "{EVERY_STEP}". Take "once", or leave root_stress out.'


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
