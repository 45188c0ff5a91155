"""Rules of three-dimensional scenes: what stands beside a helix angle, lead modifications, misalignment and places of
bearings."""

from __future__ import annotations

from collections.abc import Iterator

from fenics_gears.inputs.problem import Problem
from fenics_gears.inputs.section import given
from fenics_gears.inputs.tree import (
    GEARS,
    NOT_IN_THE_PLANE,
    Tree,
    dotted,
    material_sections,
    over_the_face,
    quantity_at,
    quantity_in,
    table,
    value_at,
)
from fenics_gears.inputs.written import as_written
from fenics_gears.scene.accuracy_rules import EVERY_STEP
from fenics_gears.scene.schema import scene_text

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


def faces_are_resolved_by_elastic_contact(tree: Tree) -> Iterator[Problem]:
    """A three-dimensional scene has elastic teeth in full contact, of equal sectors, condensed once."""
    reasons = over_the_face(tree)
    if not reasons:
        return
    why = f"cannot stand beside {dotted(reasons[0])}: flanks are then resolved over the face"
    accuracy = table(tree, "accuracy") or {}
    for name, refused in PLANE_ONLY.items():
        if accuracy.get(name) in refused:
            yield Problem(
                ("accuracy", name),
                as_written(accuracy[name]),
                f'{why}. Take "{INSTEAD[name]}", or leave one of the two out.',
            )
    for gear in GEARS:
        if value_at(tree, "gears", gear, "web") is not None:
            yield Problem(
                ("gears", gear, "web"), "", f"{why}, and webs are of plane sections only. Leave one of the two out."
            )
    of_scene = next((path for path in reasons if path in NOT_EFFECTS), None)
    if of_scene is None:
        return
    if "body_meshes" in tree:
        yield Problem(
            ("body_meshes",),
            "",
            f"{why.replace(dotted(reasons[0]), dotted(of_scene))}, and the mesh of a plane section is not. Leave one of"
            " the two out.",
        )
    if not material_sections(tree):
        yield Problem(
            of_scene,
            as_written(value_at(tree, *of_scene)) or "",
            "needs teeth that give way. Add [gears.material], or leave it out.",
        )


def fields_of_faces_have_a_face(tree: Tree) -> Iterator[Problem]:
    """Fields of faces belong to three-dimensional scenes, a hand to a helix, and layers have a thickness."""
    gears, reasons = table(tree, "gears") or {}, over_the_face(tree)
    if not reasons:
        for path, allowed, written in given(scene_text(tree), tree):
            if allowed.over_face:
                yield Problem(path, as_written(written), NOT_IN_THE_PLANE)
        yield from _remeshed_gears_have_one_width(tree)
    if "pinion_hand" in gears and "helix_angle" not in gears:
        message = (
            'is missing. Allowed: such as "15 deg"; pinion_hand has no meaning without it. Add it, or leave pinion_hand'
            " out."
        )
        yield Problem(("gears", "helix_angle"), None, message)
    if reasons:
        yield from _layers_are_no_needles(tree)
        yield from _class_is_for_the_faces(tree)


def _remeshed_gears_have_one_width(tree: Tree) -> Iterator[Problem]:
    """What stands out beyond the mate helps to carry, by a law for flanks that are condensed once."""
    asked = value_at(tree, "accuracy", "condensation")
    common = quantity_at(tree, "gears", "face_width")
    widths = {quantity_at(tree, "gears", gear, "face_width") or common for gear in GEARS}
    offsets = {quantity_at(tree, "gears", gear, "axial_offset") or 0.0 for gear in GEARS}
    if asked == EVERY_STEP and (len(widths) > 1 or len(offsets) > 1):
        remedy = 'Give both gears the width that they have in common, or take condensation = "once".'
        message = f"is for gears of one face width without axial_offset. {remedy}"
        yield Problem(("accuracy", "condensation"), as_written(asked), message)


def _class_is_for_the_faces(tree: Tree) -> Iterator[Problem]:
    drawn = value_at(tree, "flank_errors", "tolerance_class")
    for gear in GEARS if drawn is not None else ():
        width = quantity_at(tree, "gears", gear, "face_width") or quantity_at(tree, "gears", "face_width")
        if width is not None and not WIDTHS[0] <= width <= WIDTHS[1]:
            message = (
                f"is for face widths from {WIDTHS[0]:g} mm to {WIDTHS[1]:g} mm (ISO 1328-1), not {width:g} mm. Allowed:"
                " lists of errors instead."
            )
            yield Problem(("flank_errors", "tolerance_class"), as_written(drawn), message)


def _layers_are_no_needles(tree: Tree) -> Iterator[Problem]:
    module, layers = quantity_at(tree, "gears", "module"), value_at(tree, "accuracy", "layers")
    homes = [("gears", "face_width"), *(("gears", gear, "face_width") for gear in GEARS)]
    widths = {
        path: width for path in homes if (width := quantity_in(value_at(tree, *path))) is not None and width > 0.0
    }
    if module is None or not widths:
        return
    path = min(widths, key=lambda each: widths[each])
    thinnest, width = THINNEST_LAYER * module, widths[path]
    if width < thinnest:
        message = (
            "is less than a layer of elements. Allowed in three-dimensional scenes of this module: from"
            f" {thinnest:g} mm."
        )
        yield Problem(path, as_written(value_at(tree, *path)), message)
    elif type(layers) is int and (count := min(layers, MOST_LAYERS)) * thinnest > width:
        message = (
            f"is too many for a face of {width:g} mm: layers would be {width / count:.3g} mm thin. Allowed: up to"
            f" {int(width / thinnest)}."
        )
        yield Problem(("accuracy", "layers"), as_written(layers), message)
