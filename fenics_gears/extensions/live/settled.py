"""Sizes that follow the load, settled at the start: else each torque would need new bodies and contact operators."""

from __future__ import annotations

from typing import Any

from fenics_gears.scene_text import Models, NoScene, Tree, fields, value_at

from .controls import controls_of, reach

SIZE = ("accuracy", "flank_element_size")
LENGTH = ("accuracy", "contact_length")
TARGET = ("accuracy", "target")


def settled(tree: Tree, model: Any, models: Models) -> Tree:
    """The scene with the size of its flank elements and a contact window that does for all sliders, where it has none
    of its own and no target."""
    scene = model.scene
    if not scene.resolves_contact or value_at(tree, *TARGET) is not None:
        return tree
    if value_at(tree, *SIZE) is None:
        tree = fields.changed(tree, SIZE, f"{model.resolution.flank_element_size:.3g} mm")
    if value_at(tree, *LENGTH) is None:
        # A slider may go where there is no scene.
        lengths = [_length(models, other) for other in (tree, *reach(tree, controls_of(tree, scene.three_dimensional)))]
        tree = fields.changed(tree, LENGTH, f"{max(lengths):.3g} mm")
    return tree


def _length(models: Models, tree: Tree) -> float:
    try:
        return models.of(tree).resolution.contact_grid.length
    except NoScene:
        return 0.0
