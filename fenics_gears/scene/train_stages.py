"""The meshes of a train of pairs and rows: each becomes the scene of a pair."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

from fenics_gears.errors import SceneError
from fenics_gears.inputs.problem import NOTHING_DONE, Problem
from fenics_gears.inputs.problem import Path as Field
from fenics_gears.inputs.tree import GEARS
from fenics_gears.inputs.units import QuantityError, of_kind
from fenics_gears.inputs.written import as_written

from .data import Scene
from .planetary_run_out import in_all_meshes
from .train_layout import check_cut_alike
from .train_mesh import MeshOfScene
from .train_pair import MistakesOfStage, Placed, check_together, in_stage, motion_put_in, pair_of, pair_scene
from .train_pair_shafts import in_train, in_words_of_train, of_pair, place_of, sections_of_pair
from .train_rules import OF_A_STAGE, OF_GEARS, ROW, SHARED, TrainSections
from .train_shaft import BentShaft
from .train_topology import NamedMesh, gears_within, graph_of, named_meshes


def meshes_of_stages(tree: Mapping[str, Any], sections: TrainSections, source: str, folder: Path) -> list[MeshOfScene]:
    """The meshes of a train; a gear in several of them is the same in all."""
    stages = tree["stages"]
    named, _ = named_meshes(stages)
    gears = dict(each for stage, content in stages.items() for each in gears_within(stage, content))
    shafts = {gear: number for number, each in enumerate(sections.shafts.carried) for gear in each}
    graph = graph_of(named, sections.shafts.carried)
    bent = sections.shafts.bent
    place = source, folder
    scenes = _scenes_of(named, gears, tree, place, bent)
    together = [number for own in graph.members if len(own) > 1 for number in own]
    for number in range(len(named)) if sections.shafts.moving else together:
        check_together(scenes[number], f"{source}, {named[number].name}")
    check_cut_alike(named, scenes, graph, source)
    for gear in graph.shared:
        # It has one tip circle: the lowest of those that its mates leave room for.
        sides = graph.sides[gear]
        tips = [getattr(scenes[number].gears, GEARS[side]).tip_diameter for number, side in sides]
        if len(set(tips)) > 1:
            first, side = sides[0]
            name = named[first].gears[side]
            gears[name] = {**gears[name], "tip_diameter": f"{min(tips)!r} mm"}
            for number, _ in sides:
                scenes[number] = _scene_of(named[number], gears, tree, place, bent)
    found = []
    for number, (mesh, scene) in enumerate(zip(named, scenes)):
        both = shafts[mesh.gears[0]], shafts[mesh.gears[1]]
        direction = _direction(mesh, stages[mesh.stage], source)
        pair = pair_of(scene, f"{source}, stage {mesh.stage}")
        own = MeshOfScene(mesh.name, scene, pair, direction, mesh.gears, both, graph.sense(number))
        found.append(replace(own, scene=in_train(scene), bent=of_pair(mesh.gears, bent)) if bent else own)
    return in_all_meshes(found, source)


def _scenes_of(
    named: Sequence[NamedMesh], gears: Mapping[str, Any], tree: Mapping[str, Any], place: tuple[str, Path],
    bent: Sequence[BentShaft],
) -> list[Scene]:  # fmt: skip
    """The scenes of all meshes. Raises MistakesOfStage for all that is wrong with any, each field once."""
    scenes = []
    problems: dict[Field, Problem] = {}
    for mesh in named:
        try:
            scenes.append(_scene_of(mesh, gears, tree, place, bent))
        except MistakesOfStage as error:
            for each in error.problems:
                problems.setdefault(each.path, each)
    if problems:
        raise MistakesOfStage(list(problems.values()))
    return scenes


def _scene_of(
    mesh: NamedMesh, gears: Mapping[str, Any], tree: Mapping[str, Any], place: tuple[str, Path],
    bent: Sequence[BentShaft],
) -> Scene:  # fmt: skip
    """The scene of a mesh, from what is written of all `gears`; its `place`: the file and its folder; `bent`: the
    shafts of the train that bend."""
    source, folder = place
    content = tree["stages"][mesh.stage]
    own = {name: value for name, value in content.items() if name not in ("kind", "gears", "directions", "direction")}
    inner = {name: value for name, value in own.items() if name in OF_A_STAGE}
    fields = {name: value for name, value in own.items() if name not in (*OF_A_STAGE, *GEARS)}
    numbers = _numbers_of(mesh, content)
    for name in {*inner} & {*OF_GEARS} if numbers else ():
        # A gear has its errors in the first mesh that it is in.
        inner[name] = {side: inner[name][number] for side, number in numbers.items() if number in inner[name]}
        inner = inner if inner[name] else {each: value for each, value in inner.items() if each != name}
    both = {name: gears[gear] for name, gear in zip(GEARS, mesh.gears)}
    given = {name: gear for name, gear in both.items() if gear is not None}
    shared = {name: tree[name] for name in SHARED if name in tree}
    sections = {"gears": fields | given, **shared, **inner, "load": {"wheel_torque": "1 N m"}}
    if "inertia" in sections:
        # The load is on the last shaft.
        sections["inertia"] = {each: value for each, value in sections["inertia"].items() if each != "load"}
    sections |= motion_put_in(sections, tree)
    on_shafts = of_pair(mesh.gears, bent)
    sections |= sections_of_pair(on_shafts, tree, sections)
    places = {name: at[2:] for name, at in zip(GEARS, mesh.places)}
    name = f"{mesh.stage} {mesh.number + 1}" if mesh.count > 1 else mesh.stage
    in_its_stage = partial(in_stage, mesh.stage, places, shared.keys() - inner.keys())

    def in_train_at(path: Field) -> Field:
        if path[:1] and path[0] in OF_GEARS and path[1:2] and path[1] in numbers:
            path = (path[0], numbers[path[1]], *path[2:])
        return place_of(on_shafts, path) or in_its_stage(path)

    put = Placed(in_train_at, partial(in_words_of_train, on_shafts))
    label = f"{source}, stage {mesh.stage}"
    return pair_scene(sections, name, label, folder, put)


def _numbers_of(mesh: NamedMesh, content: Mapping[str, Any]) -> dict[str, str]:
    """By which numbers a row calls the gears of a mesh that are in none before it; none of a pair."""
    if content.get("kind") != ROW:
        return {}
    return {"wheel": f"{mesh.number + 2}"} | ({} if mesh.number else {"pinion": "1"})


def _direction(mesh: NamedMesh, content: Mapping[str, Any], source: str) -> float:
    """Direction (rad) of a mesh's wheel from its pinion."""
    written = content.get("direction")
    if "directions" in content:
        written = content["directions"][mesh.number]
    if written is None:
        return 0.0
    try:
        return float(of_kind(written, "an angle")[0])
    except (QuantityError, TypeError):
        raise SceneError(
            f"{source}: stages.{mesh.stage}: the direction {as_written(written)} is no angle. Allowed: an angle with"
            f' its unit, as "35 deg". {NOTHING_DONE}'
        ) from None
