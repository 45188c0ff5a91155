"""Sizes that follow the load, settled at the start: else each torque would need new bodies and contact operators."""

from __future__ import annotations

from typing import Any

from fenics_gears.scene_text import STAGES, Models, NoScene, Tree, fields, is_train, value_at

from .controls import Path, controls_of, reach
from .train_controls import has_planets, load_controls

SIZE = ("accuracy", "flank_element_size")
LENGTH = ("accuracy", "contact_length")
TARGET = ("accuracy", "target")
STEPS = "steps_per_mesh_cycle"


def settled(tree: Tree, model: Any, models: Models) -> Tree:
    """The scene with the size of its flank elements and a contact window that does for all sliders, where it has none
    of its own and no target."""
    if is_train(tree):
        return _settled_train(tree, model, models)
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


def is_slow(tree: Tree, model: Any) -> bool:
    """Whether a scene is shown with few steps first: over the face, and planetary sets. Of trains with a target the
    steps are chosen."""
    if not is_train(tree):
        return model.scene.three_dimensional
    scenes = [mesh.scene for mesh in model.scene.meshes]
    if any(each.accuracy.target is not None for each in scenes):
        return False
    return any(each.three_dimensional for each in scenes) or any(map(has_planets, tree[STAGES].values()))


def with_steps(tree: Tree, steps: int) -> Tree:
    """A train with so many steps of a mesh cycle, or the next number that its phases allow."""
    found = tree
    for place in places_of_accuracy(tree).values():
        found = fields.changed(found, (*place, "accuracy"), _accuracy(tree, place) | {STEPS: steps})
    return found


def _accuracy(tree: Tree, place: Path) -> dict[str, Any]:
    """What a stage has of its own and of the whole."""
    return {**tree.get("accuracy", {}), **(value_at(tree, *place, "accuracy") or {})}


def places_of_accuracy(tree: Tree) -> dict[str, Path]:
    """Where each stage of a train has its `[accuracy]`: a planetary set that of the whole."""
    return {stage: () if has_planets(content) else (STAGES, stage) for stage, content in tree[STAGES].items()}


def _length(models: Models, tree: Tree) -> float:
    try:
        return models.of(tree).resolution.contact_grid.length
    except NoScene:
        return 0.0


def _settled_train(tree: Tree, model: Any, models: Models) -> Tree:
    """The same of each stage of a train, whose windows do for the largest load of the slider."""
    places = places_of_accuracy(tree)
    if any(value_at(tree, *place, *TARGET) is not None for place in [(), *places.values()]):
        return tree
    largest = models.of(next(each.changed(tree, each.ends[1]) for each in load_controls(tree)))
    found = tree
    for stage, place in places.items():
        of_stage = [number for number, mesh in enumerate(model.scene.meshes) if mesh.name.split(":")[0] == stage]
        own = _accuracy(tree, place)
        sizes = min(model.models[number].resolution.flank_element_size for number in of_stage)
        own.setdefault(SIZE[1], f"{sizes:.3g} mm")
        longest = max(largest.models[number].resolution.contact_grid.length for number in of_stage)
        own.setdefault(LENGTH[1], f"{longest:.3g} mm")
        found = fields.changed(found, (*place, "accuracy"), own)
    return found
