"""Sliders of a train: load and speed of the whole, gears and modifications by stage."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from fenics_gears.scene_text import GEARS, STAGES, fields, value_at

from .controls import SHIFT, Control, Path, Tree, friction, profile_shift, reliefs, twice

LOADS = {"input_torque": "input torque", "output_torque": "output torque", "power": "power"}
# The meshes of a planetary set, and what pinion and wheel of each are.
MESHES = {
    "sun_mesh": ("sun", "planets at the sun"),
    "ring_mesh": ("planets at the ring", "ring"),
    "second_sun_mesh": ("planets at the second sun", "second sun"),
}


def controls_of_train(tree: Tree) -> list[Control]:
    """What the page shows of a train from the start."""
    stages = [control for name in tree[STAGES] for control in _of_stage(tree, name)]
    return [*load_controls(tree), *stages, *(() if _own_friction(tree) else friction(tree))]


def names_in_train(tree: Tree) -> list[str]:
    """Names of the fields that a train may have."""
    within = [path for path, section in fields.of_stages().items() if not section]
    stages = [".".join((STAGES, stage, *path)) for stage in tree[STAGES] for path in within]
    return [*(f"load.{name}" for name in LOADS), "motion.input_speed", "friction.coefficient", *stages]


def load_controls(tree: Tree) -> Iterator[Control]:
    """Load and speed of the whole, the load first."""
    for name, label in LOADS.items():
        if value_at(tree, "load", name) is not None:
            yield twice(("load", name), label, "Load and speed", tree)
    if value_at(tree, "motion", "input_speed") is not None:
        yield twice(("motion", "input_speed"), "input speed", "Load and speed", tree)


def has_planets(content: Any) -> bool:
    """Whether a stage is a planetary set."""
    return content.get("kind") == "planetary"


def _of_stage(tree: Tree, stage: str) -> Iterator[Control]:
    place = (STAGES, stage)
    group = f"Stage {stage}"
    content = tree[STAGES][stage]
    for words, path in _gears(content):
        own = (*place, *path, SHIFT)
        if value_at(tree, *own) is not None:
            yield profile_shift(own, words, group, tree)
    if has_planets(content):
        for mesh, both in MESHES.items():
            if mesh == "second_sun_mesh" and "second_sun" not in content:
                continue
            yield from reliefs(tree, (*place, mesh), both, group)
    else:
        row = isinstance(content.get("gears"), list)
        yield from reliefs(tree, place, ("driving gears", "driven gears") if row else GEARS, group)


def _gears(content: Any) -> Iterator[tuple[str, Path]]:
    """Words for each gear that a stage declares, and its place in it."""
    listed = content.get("gears")
    if isinstance(listed, list):
        yield from ((f"gear {number}", ("gears", str(number))) for number in range(1, len(listed) + 1))
    yield from (
        (name, (name,))
        for name in (*GEARS, "sun", "planet", "step", "ring", "second_sun")
        if isinstance(content.get(name), dict)
    )


def _own_friction(tree: Tree) -> bool:
    return any("friction" in content for content in tree[STAGES].values())
