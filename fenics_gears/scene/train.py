"""A train of gears: a scene with `[stages.NAME]` in place of `[gears]`.

A stage of two gears has what the scene of a pair has: its gears, and the sections of its effects. In a row of gears
each gear meshes with the next, so that those between are idlers. The wheel of a stage, or the last gear of its row, is
on one rigid shaft with the pinion of the next stage, unless the scene says what shafts carry. Each mesh becomes the
scene of a pair, under the torque that it has in the train without losses, where paths share it evenly.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property, partial
from math import pi
from pathlib import Path
from typing import Any

from fenics_gears.errors import SceneError
from fenics_gears.geometry.gear_train import Layout
from fenics_gears.geometry.train_graph import turns_of_shafts
from fenics_gears.inputs.problem import NOTHING_DONE, Problem, line_numbers, listed
from fenics_gears.inputs.problem import Path as Field
from fenics_gears.inputs.tree import GEARS
from fenics_gears.inputs.units import QuantityError, of_kind
from fenics_gears.inputs.written import as_written

from .data import Load, Motion, Scene
from .parsing import is_train, name_of, parsed, text_of
from .planetary import planetary_parts
from .planetary_rules import has_planets
from .schema import LAST_CYCLES, NOMINAL_FREQUENCY
from .train_layout import check_cut_alike, check_layout
from .train_mesh import MeshOfScene, OfMeshes, gear_names, layout_of, rows_of
from .train_pair import MistakesOfStage, Placed, TrainMistakes, check_together, in_stage, pair_of, pair_scene
from .train_pair_shafts import in_train, in_words_of_train, of_pair, place_of, sections_of_pair
from .train_rules import OF_A_STAGE, SHARED, TrainSections, checked_train
from .train_shaft import BentShaft
from .train_shafts import TrainShafts, located_shafts
from .train_topology import NamedMesh, gears_within, graph_of, named_meshes
from .train_torques import even_torques, torques_of_shafts


@dataclass(frozen=True)
class TrainScene(OfMeshes):
    """A train of gears: its meshes from the driven shaft on, torques (N mm) on the first and the last shaft, of a
    planetary set on its input and its output, what its shafts are, and the text that it was read from.
    `recorded_cycles`: of the slowest mesh, whose steps numbers are taken from where stages move together."""

    title: str
    name: str
    meshes: tuple[MeshOfScene, ...]
    input_torque: float
    output_torque: float
    speed_given: bool
    text: str
    shafts: TrainShafts = TrainShafts()
    recorded_cycles: int = 1

    @property
    def loads(self) -> list[float]:
        """Torque (N mm) that resists the rotation of each shaft from outside, 0 where there is none."""
        found = [0.0] * self.graph.last + [self.output_torque]
        for each in self.shafts.loads:
            found[each.shaft] = each.torque
        return found

    @property
    def path_of_output_torque(self) -> tuple[str, ...]:
        """The field of the scene that gives the torque of the last shaft."""
        entries = [each.shaft for each in self.shafts.loads]
        if self.graph.last not in entries:
            return "load", "output_torque"
        return "load", "torques", str(entries.index(self.graph.last) + 1), "torque"

    @property
    def rows(self) -> list[list[int]]:
        """Numbers of its meshes, those together that are computed together."""
        return rows_of(self.meshes, self.shafts.moving)

    @property
    def alone(self) -> list[int]:
        """Numbers of the meshes that are pairs by themselves."""
        return [row[0] for row in self.rows if len(row) == 1 and not self.shafts.moving]

    @property
    def input_speed(self) -> float:
        """Turns of the first shaft in a second."""
        first = self.meshes[self.graph.out_of(0)[0]]
        own = first.scene.motion.mesh_frequency / first.pair.pinion.teeth
        carrier = self.shafts.carrier
        return own if carrier is None else own / abs(float(carrier.set.sun_by_carrier))

    @property
    def ratio(self) -> float:
        """Turns of the first shaft in one turn of the last; of a planetary set of its input and its output."""
        carrier = self.shafts.carrier
        return 1.0 / self.turns_of_last if carrier is None else abs(float(carrier.set.ratio))

    @property
    def turns_of_last(self) -> float:
        """Turns of the last shaft in one turn of the first."""
        return self.turns[-1]

    @cached_property
    def turns(self) -> list[float]:
        """Turns of each shaft in one turn of the first, in either sense."""
        return turns_of(self.layout)


def load_train(path: str | os.PathLike) -> TrainScene:
    """Read and validate the scene file of a train.

    Raises SceneError, naming every mistake at once, where the file cannot be read or is wrong, and GeometryError for
    impossible gears.

    >>> from fenics_gears import load_train
    >>> train = load_train("demos/gear_trains/electric_axle.toml")
    >>> [mesh.name for mesh in train.meshes], round(train.ratio, 3)
    (['first', 'second'], 9.401)
    """
    path = Path(path)
    return train_from_text(text_of(path, "scene"), name_of(path), source=str(path), directory=path.parent)


def train_from_text(
    text: str, name: str = "train", *, source: str | None = None, directory: Path = Path()
) -> TrainScene:
    """The train that a TOML text describes; arguments and errors are those of `scene_from_text`.

    >>> from pathlib import Path
    >>> from fenics_gears import train_from_text
    >>> text = Path("demos/gear_trains/idler.toml").read_text()
    >>> [mesh.pair.wheel.teeth for mesh in train_from_text(text).meshes]
    [31, 40]
    """
    source = source or name
    tree = parsed(text, source)
    if not is_train(tree):
        raise SceneError(f"{source}: has no [stages.NAME]: it is the scene of a pair, or none. {NOTHING_DONE}")
    return train_of(tree, text, name, source, directory)


def turns_of(layout: Layout) -> list[float]:
    """Turns of each shaft in one turn of the first, in either sense."""
    return list(map(float, exact_turns(layout)))


def exact_turns(layout: Layout) -> list[Fraction]:
    return turns_of_shafts(layout.graph, [(pair.pinion.teeth, pair.wheel.teeth) for pair in layout.pairs])


def train_of(tree: Mapping[str, Any], text: str, name: str, source: str, folder: Path) -> TrainScene:
    """The train of a parsed text. Raises SceneError, naming all mistakes of the train or of one of its stages at once,
    and GeometryError for gears that overlap."""
    sections: TrainSections | None = None
    problems: list[Problem] = []
    meshes: list[MeshOfScene] = []
    try:
        if has_planets(tree):
            meshes, sections = planetary_parts(tree, source, folder)
        else:
            sections, problems = checked_train(tree)
            if sections is not None:
                sections = replace(sections, shafts=located_shafts(sections.shafts, folder))
                meshes = _meshes_of(tree, sections, source, folder)
    except MistakesOfStage as error:
        problems = error.problems
    if problems or sections is None:
        raise TrainMistakes(listed(problems, line_numbers(text), source), problems)
    names = [mesh.name for mesh in meshes]
    check_layout(layout_of(meshes), names, gear_names(meshes), source)
    return _completed(tree.get("title") or name, name, text, meshes, sections)


def _meshes_of(tree: Mapping[str, Any], sections: TrainSections, source: str, folder: Path) -> list[MeshOfScene]:
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
    return found


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
    both = {name: gears[gear] for name, gear in zip(GEARS, mesh.gears)}
    given = {name: gear for name, gear in both.items() if gear is not None}
    shared = {name: tree[name] for name in SHARED if name in tree}
    sections = {"gears": fields | given, **shared, **inner, "load": {"wheel_torque": "1 N m"}}
    if "inertia" in sections:
        # The load is on the last shaft; speed and length of the run are put in for the train's.
        sections["inertia"] = {each: value for each, value in sections["inertia"].items() if each != "load"}
        sections["motion"] = {"pinion_speed": "1 rpm", "mesh_cycles": 1}
    on_shafts = of_pair(mesh.gears, bent)
    sections |= sections_of_pair(on_shafts, tree, sections)
    places = {name: at[2:] for name, at in zip(GEARS, mesh.places)}
    name = f"{mesh.stage} {mesh.number + 1}" if mesh.count > 1 else mesh.stage
    in_its_stage = partial(in_stage, mesh.stage, places, shared.keys() - inner.keys())
    put = Placed(lambda path: place_of(on_shafts, path) or in_its_stage(path), partial(in_words_of_train, on_shafts))
    label = f"{source}, stage {mesh.stage}"
    return pair_scene(sections, name, label, folder, put)


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


def _completed(title: str, name: str, text: str, meshes: Sequence[MeshOfScene], sections: TrainSections) -> TrainScene:
    """The train with steps, speeds and torques of all meshes."""
    load = sections.load
    motion = sections.motion
    layout = layout_of(meshes)
    graph = layout.graph
    turns = turns_of(layout)
    exact = exact_turns(layout)
    speed = motion.input_speed
    if motion.speed is not None:
        speed = motion.speed / turns[sections.shafts.speed_of]
    # Without a speed a cycle of the first mesh that the first shaft drives takes a second.
    first = meshes[graph.out_of(0)[0]].pair.pinion.teeth
    of_first = NOMINAL_FREQUENCY if speed is None else speed / (2.0 * pi) * first
    driving = 2.0 * pi * of_first / first
    on_shafts = torques_of_shafts(load, sections.shafts.loads, turns, driving)
    cycles = motion.mesh_cycles or 1
    torques = even_torques(layout, on_shafts)
    found: list[MeshOfScene] = []
    for number, mesh in enumerate(meshes):
        # Meshes of one gear have one frequency to the last digit.
        frequency = of_first * float(exact[graph.between[number][0]] * mesh.pair.pinion.teeth / first)
        moving = Motion(frequency, cycles, cycles, False, speed is not None)
        found.append(replace(mesh, scene=replace(mesh.scene, load=Load(torques[number]), motion=moving)))
    alike = sections.shafts.ramp is None and not any(mesh.scene.eccentricity for mesh in meshes)
    usual = LAST_CYCLES if alike else cycles
    recorded = min(motion.recorded_cycles or usual, cycles)
    of_ends = sum(own * turn for own, turn in zip(on_shafts, turns)), on_shafts[-1]
    if (carrier := sections.shafts.carrier) is not None:
        of_ends = carrier.torque, abs(carrier.set.torques(carrier.torque)[carrier.set.output])
    return TrainScene(title, name, tuple(found), *of_ends, speed is not None, text, sections.shafts, recorded)
