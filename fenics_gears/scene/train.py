"""A train of gears: a scene with `[stages.NAME]` in place of `[gears]`.

A stage of two gears has what the scene of a pair has: its gears, and the sections of its effects. In a row of gears
each gear meshes with the next, so that those between are idlers. The wheel of a stage, or the last gear of its row, is
on one rigid shaft with the pinion of the next stage. Each mesh becomes the scene of a pair, under the torque that it
has in the train without losses.
"""

from __future__ import annotations

import os
from cmath import rect
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from math import pi, prod
from pathlib import Path
from typing import Any

from fenics_gears.errors import GeometryError, SceneError
from fenics_gears.geometry.gear_train import SecondMesh, check_apart, second_mesh
from fenics_gears.geometry.pair import GearPair, gear_pair
from fenics_gears.inputs.problem import NOTHING_DONE, line_numbers, listed
from fenics_gears.inputs.units import QuantityError, of_kind
from fenics_gears.inputs.written import as_written

from .data import Load, Motion, Scene
from .parsing import is_train, name_of, parsed, text_of
from .schema import LAST_CYCLES, NOMINAL_FREQUENCY
from .train_pair import ROW_GEARS, MistakesOfStage, TrainMistakes, check_together, in_stage, pair_scene
from .train_rules import OF_A_STAGE, PAIR, ROW, SHARED, TrainSections, checked_train
from .train_shafts import TrainShafts


@dataclass(frozen=True)
class MeshOfScene:
    """A mesh of a train: the `scene` of its pair, its name, and the direction (rad) of its wheel from its pinion.
    `idler`: of its pinion, where this is also the wheel of the mesh before; None on a shaft of two gears. `gears`:
    names of pinion and wheel."""

    name: str
    scene: Scene
    pair: GearPair
    direction: float
    idler: SecondMesh | None = None
    gears: tuple[str, str] = ("pinion", "wheel")


@dataclass(frozen=True)
class TrainScene:
    """A train of gears: its meshes from the driven shaft on, torques (N mm) on the first and the last shaft, what its
    shafts are, and the text that it was read from. `recorded_cycles`: of the slowest mesh, whose steps numbers are
    taken from where stages move together."""

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
        first = self.meshes[0]
        return first.scene.motion.mesh_frequency / first.pair.pinion.teeth

    @property
    def ratio(self) -> float:
        """Turns of the first shaft in one turn of the last."""
        return 1.0 / self.turns_of_last

    @property
    def turns_of_last(self) -> float:
        """Turns of the last shaft in one turn of the first."""
        return turns_of_last(self.meshes)


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


def turns_of_last(meshes: Iterable[MeshOfScene]) -> float:
    """Turns of the last shaft in one turn of the first."""
    return prod(mesh.pair.rotation_ratio for mesh in meshes)


def rows_of(meshes: Sequence[MeshOfScene], moving: bool = False) -> list[list[int]]:
    """Numbers of meshes, those together that idlers couple, or all where stages move together (`moving`)."""
    rows: list[list[int]] = []
    for number, mesh in enumerate(meshes):
        if not rows or mesh.idler is None and not moving:
            rows.append([])
        rows[-1].append(number)
    return rows


def train_of(tree: Mapping[str, Any], text: str, name: str, source: str, folder: Path) -> TrainScene:
    """The train of a parsed text. Raises SceneError, naming all mistakes of the train or of one of its stages at once,
    and GeometryError for gears that overlap."""
    sections, problems = checked_train(tree)
    meshes: list[MeshOfScene] = []
    try:
        for stage, content in tree["stages"].items() if sections is not None else ():
            meshes += _meshes_of(stage, content, tree, (source, folder, len(meshes)))
    except MistakesOfStage as error:
        problems = error.problems
    if problems or sections is None:
        raise TrainMistakes(listed(problems, line_numbers(text), source), problems)
    if sections.shafts.moving:
        for mesh in meshes:
            check_together(mesh.scene, f"{source}, {mesh.name}")
    return _completed(tree.get("title") or name, name, text, meshes, sections)


def _meshes_of(
    stage: str, content: Mapping[str, Any], tree: Mapping[str, Any], place: tuple[str, Path, int]
) -> list[MeshOfScene]:
    """The meshes of a stage; its `place`: the file, its folder, and how many meshes there are before."""
    source, folder, before = place
    row = content.get("kind", PAIR) == ROW
    gears = list(content["gears"]) if row else [content.get("pinion"), content.get("wheel")]
    count = len(gears) - 1
    directions = [
        _angle(each, stage, source)
        for each in (content.get("directions", [None] * count) if row else [content.get("direction")])
    ]
    own = {name: value for name, value in content.items() if name not in ("kind", "gears", "directions", "direction")}
    label = f"{source}, stage {stage}"

    def scene(number: int) -> Scene:
        inner = {name: value for name, value in own.items() if name in OF_A_STAGE}
        fields = {name: value for name, value in own.items() if name not in (*OF_A_STAGE, "pinion", "wheel")}
        both = {"pinion": gears[number], "wheel": gears[number + 1]}
        given = {name: gear for name, gear in both.items() if gear is not None}
        shared = {name: tree[name] for name in SHARED if name in tree}
        sections = {"gears": fields | given, **shared, **inner, "load": {"wheel_torque": "1 N m"}}
        if "inertia" in sections:
            # The load is on the last shaft; speed and length of the run are put in for the train's.
            sections["inertia"] = {each: value for each, value in sections["inertia"].items() if each != "load"}
            sections["motion"] = {"pinion_speed": "1 rpm", "mesh_cycles": 1}
        places = {name: (ROW_GEARS, str(number + place)) for place, name in enumerate(both, 1)} if row else {}
        name = f"{stage} {number + 1}" if count > 1 else stage
        found = pair_scene(
            sections, name, label, folder, partial(in_stage, stage, places, shared.keys() - inner.keys())
        )
        if found.gears.wheel.teeth < 0:
            raise SceneError(
                f"{label}: an internal gear is not computed in a train yet. Allowed: external gears in a train, an"
                f" internal wheel in a scene of one pair. {NOTHING_DONE}"
            )
        if count > 1:
            check_together(found, label)
        return found

    scenes = [scene(number) for number in range(count)]
    for number in range(1, count):
        # An idler has one tip circle: the lower one of those that both of its mates leave room for.
        tips = [scenes[number - 1].gears.wheel.tip_diameter, scenes[number].gears.pinion.tip_diameter]
        if tips[0] != tips[1]:
            gears[number] = {**gears[number], "tip_diameter": f"{min(tips)!r} mm"}
            scenes[number - 1 : number + 1] = [scene(number - 1), scene(number)]
    pairs = [gear_pair(each.gears) for each in scenes]
    return _joined(stage, scenes, pairs, directions, (label, before))


def _angle(written: Any, stage: str, source: str) -> float:
    if written is None:
        return 0.0
    try:
        return float(of_kind(written, "an angle")[0])
    except (QuantityError, TypeError):
        raise SceneError(
            f"{source}: stages.{stage}: the direction {as_written(written)} is no angle. Allowed: an angle with its"
            f' unit, as "35 deg". {NOTHING_DONE}'
        ) from None


def _joined(
    stage: str, scenes: Sequence[Scene], pairs: Sequence[GearPair], directions: Sequence[float],
    place: tuple[str, int],
) -> list[MeshOfScene]:  # fmt: skip
    """The meshes of a stage, with how each idler's second mesh follows from its first; its `place`: the label, and how
    many meshes there are before."""
    label, meshes_before = place
    meshes: list[MeshOfScene] = []
    for number, (scene, pair) in enumerate(zip(scenes, pairs)):
        idler = None
        if number:
            before = meshes[-1]
            if before.pair.wheel != pair.pinion:
                raise GeometryError(
                    f"{label}: gear {number + 1} would be cut differently for its two meshes: give its profile_shift,"
                    f" tip_diameter and root_diameter. {NOTHING_DONE}"
                )
            # In the frame of every second mesh of the train, the mirror image, angles count the other way.
            sense = -1.0 if (meshes_before + number - 1) % 2 else 1.0
            angles = sense * (directions[number - 1] + pi), sense * directions[number]
            idler = second_mesh(before.pair, pair, *angles)
        name = f"{stage}: gears {number + 1} and {number + 2}" if len(scenes) > 1 else stage
        gears = f"{stage}.{number + 1}", f"{stage}.{number + 2}"
        if len(scenes) == 1:
            gears = f"{stage}.pinion", f"{stage}.wheel"
        meshes.append(MeshOfScene(name, scene, pair, directions[number], idler, gears))
    _check_overlap(meshes, label)
    return meshes


def _check_overlap(meshes: Sequence[MeshOfScene], label: str) -> None:
    """Raise GeometryError where gears of a row that do not mesh overlap."""
    centres = [0j]
    for mesh in meshes:
        centres.append(centres[-1] + rect(mesh.pair.centre_distance, mesh.direction))
    gears = [meshes[0].pair.pinion, *(mesh.pair.wheel for mesh in meshes)]
    for one in range(len(gears)):
        for other in range(one + 2, len(gears)):
            distance = abs(centres[other] - centres[one])
            check_apart(gears[one], gears[other], distance, f"{label}: gears {one + 1} and {other + 1}")


def _completed(title: str, name: str, text: str, meshes: Sequence[MeshOfScene], sections: TrainSections) -> TrainScene:
    """The train with steps, speeds and torques of all meshes."""
    load = sections.load
    motion = sections.motion
    through = turns_of_last(meshes)
    speed = motion.input_speed
    frequency = NOMINAL_FREQUENCY if speed is None else speed / (2.0 * pi) * meshes[0].pair.pinion.teeth
    driving = 2.0 * pi * frequency / meshes[0].pair.pinion.teeth
    if load.output_torque is not None:
        output = load.output_torque
    elif load.input_torque is not None:
        output = load.input_torque / through
    else:
        output = load.power / driving / through
    cycles = motion.mesh_cycles or 1
    found: list[MeshOfScene] = []
    torque = output * through
    for mesh in meshes:
        torque /= mesh.pair.rotation_ratio
        moving = Motion(frequency, cycles, cycles, False, speed is not None)
        behind = meshes[len(found) + 1 : len(found) + 2]
        frequency *= behind[0].pair.pinion.teeth / mesh.pair.wheel.teeth if behind else 1.0
        found.append(replace(mesh, scene=replace(mesh.scene, load=Load(torque), motion=moving)))
    recorded = min(motion.recorded_cycles or LAST_CYCLES, cycles)
    of_ends = output * through, output
    return TrainScene(title, name, tuple(found), *of_ends, speed is not None, text, sections.shafts, recorded)
