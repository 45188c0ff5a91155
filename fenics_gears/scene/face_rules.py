"""Rules of three-dimensional scenes, which plane scenes do not load."""

from collections.abc import Sequence

from fenics_gears.inputs.problem import Broken, Path
from fenics_gears.inputs.tree import (
    GEARS,
    Tree,
    dotted,
    material_sections,
    module_in,
    quantity_at,
    quantity_in,
    table,
    value_at,
)

from .accuracy_rules import EVERY_STEP

# Effects say themselves what they need.
NOT_EFFECTS = (("gears", "helix_angle"), ("bearings", "places"))
# Layers of elements thinner than this, in modules, are needles.
THINNEST_LAYER = 0.02
# Face widths (mm) that the tolerances of ISO 1328-1:2013 are for.
WIDTHS = (4.0, 1200.0)
# A number with hundreds of digits is more than a float holds.
MOST_LAYERS = 10**9
PLANE_ONLY = {
    "element": ("Q1 incompatible",),
    "condensation": (EVERY_STEP,),
    "model": ("rigid teeth", "stiffness table", "ISO 6336-1"),
}
INSTEAD = {"element": "P2", "condensation": "once", "model": "elastic"}


def rules_over_the_face(tree: Tree, reasons: Sequence[Path]) -> Broken:
    """All of a scene that `reasons` make three-dimensional."""
    yield from _faces_are_resolved_by_elastic_contact(tree, reasons)
    yield from _layers_are_no_needles(tree)
    yield from _class_is_for_the_faces(tree)


def _faces_are_resolved_by_elastic_contact(tree: Tree, reasons: Sequence[Path]) -> Broken:
    why = f"cannot be combined with {dotted(reasons[0])}: flanks are then resolved over the face"
    accuracy = table(tree, "accuracy") or {}
    for name, refused in PLANE_ONLY.items():
        if accuracy.get(name) in refused:
            yield ("accuracy", name), f'{why}. Take "{INSTEAD[name]}", or leave one of the two out.'
    of_scene = next((path for path in reasons if path in NOT_EFFECTS), None)
    if of_scene is None:
        return
    for section in (each for each in ("body_meshes", "wheel_points") if each in tree):
        beside = f"cannot be combined with {dotted(of_scene)}: flanks are then resolved over the face"
        yield (section,), f"{beside}, and a body of a plane section is not. Leave one of the two out."
    if not material_sections(tree):
        yield of_scene, "needs elastic teeth. Add [gears.material], or leave it out."


def _class_is_for_the_faces(tree: Tree) -> Broken:
    drawn = value_at(tree, "flank_errors", "tolerance_class")
    for gear in GEARS if drawn is not None else ():
        width = quantity_at(tree, "gears", gear, "face_width") or quantity_at(tree, "gears", "face_width")
        if width is not None and not WIDTHS[0] <= width <= WIDTHS[1]:
            limits = f"{WIDTHS[0]:g} mm to {WIDTHS[1]:g} mm (ISO 1328-1), not {width:g} mm"
            yield ("flank_errors", "tolerance_class"), f"is for face widths from {limits}. Allowed: lists of errors."


def _layers_are_no_needles(tree: Tree) -> Broken:
    module = module_in(tree)
    layers = value_at(tree, "accuracy", "layers")
    homes = [("gears", "face_width"), *(("gears", gear, "face_width") for gear in GEARS)]
    widths = {
        path: width for path in homes if (width := quantity_in(value_at(tree, *path))) is not None and width > 0.0
    }
    if module is None or not widths:
        return
    path = min(widths, key=lambda each: widths[each])
    thinnest = THINNEST_LAYER * module
    width = widths[path]
    if width < thinnest:
        yield path, f"is less than a layer of elements. Allowed in three dimensions: from {thinnest:g} mm."
    elif type(layers) is int and (count := min(layers, MOST_LAYERS)) * thinnest > width:
        message = (
            f"is too many for a face of {width:g} mm: layers would be {width / count:.3g} mm thin. Allowed: up to"
            f" {int(width / thinnest)}."
        )
        yield ("accuracy", "layers"), message
