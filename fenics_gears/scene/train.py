"""A train of gears: a scene with `[stages.NAME]` in place of `[gears]`.

A stage of two gears has what the scene of a pair has: its gears, and the sections of its effects. In a row of gears
each gear meshes with the next, so that those between are idlers. The wheel of a stage, or the last gear of its row, is
on one rigid shaft with the pinion of the next stage. Each mesh becomes the scene of a pair, under the torque that it
has in the train without losses.
"""

from __future__ import annotations

import os
from cmath import rect
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from math import pi
from pathlib import Path
from typing import Any

from fenics_gears.errors import GeometryError, SceneError
from fenics_gears.geometry.gear_train import SecondMesh, check_apart, second_mesh
from fenics_gears.geometry.pair import GearPair, gear_pair
from fenics_gears.inputs.fields import quantity, whole_number
from fenics_gears.inputs.problem import NOTHING_DONE, Problem, did_you_mean, line_numbers, listed
from fenics_gears.inputs.section import Section, fields_of, names_in, read
from fenics_gears.inputs.units import QuantityError, of_kind
from fenics_gears.inputs.written import as_toml, as_written

from .data import Load, Motion, Scene
from .parsing import parsed
from .read import name_of, scene_from_text, text_of
from .schema import NOMINAL_FREQUENCY

PAIR = "pair"
ROW = "row"
# Sections that a train may have for all of its stages, and those that a row may have of its own; and a stage of two
# gears. Others make shafts give way or vibrate, and so couple the stages.
SHARED = ("friction", "accuracy")
OF_A_ROW = (*SHARED, "tip_relief", "root_relief", "profile_modifications", "corner_contact")
OF_A_STAGE = (*OF_A_ROW, "lead_modifications", "misalignment", "coast_flanks", "body_meshes")
COUPLING = ("shafts", "bearings", "inertia", "damping", "torque_ripple", "speed_ramp", "flank_errors", "eccentricity")
OF_A_TRAIN = ("title", "stages", "load", "motion", *SHARED)
MOST_STAGES = 20


@dataclass(frozen=True)
class TrainLoad(Section):
    """``[load]`` of a train: by exactly one of these fields; the gears pass it on without losses."""

    alternatives = (("output_torque", "input_torque", "power"),)

    output_torque: float | None = quantity(
        "0 N m to 1e12 N m",
        "2 kN m",
        meaning="torque that resists the rotation of the last shaft",
        otherwise="from `input_torque` or `power`",
    )
    input_torque: float | None = quantity(
        "0 N m to 1e12 N m",
        "100 N m",
        meaning="torque that drives the first shaft",
        otherwise="`output_torque` or `power` is given",
    )
    power: float | None = quantity(
        "0 kW to 1e9 kW",
        "20 kW",
        meaning="power that goes through the train at the speed of `[motion]`, which is then required",
        otherwise="`output_torque` or `input_torque` is given",
    )


@dataclass(frozen=True)
class TrainMotion(Section):
    """``[motion]`` of a train."""

    input_speed: float | None = quantity(
        "1e-9 rpm to 1e6 rpm",
        "1500 rpm",
        meaning="speed of the first shaft",
        otherwise="a cycle of the first mesh takes 1 s",
    )
    mesh_cycles: int | None = whole_number(1, 1000000, 2, meaning="cycles that each mesh is run", otherwise="one")


@dataclass(frozen=True)
class MeshOfScene:
    """A mesh of a train: the `scene` of its pair, its name, and the direction (rad) of its wheel from its pinion.
    `idler`: of its pinion, where this is also the wheel of the mesh before; None on a shaft of two gears."""

    name: str
    scene: Scene
    pair: GearPair
    direction: float
    idler: SecondMesh | None = None


@dataclass(frozen=True)
class TrainScene:
    """A train of gears: its meshes from the driven shaft on, torques (N mm) on the first and the last shaft, and the
    text that it was read from."""

    title: str
    name: str
    meshes: tuple[MeshOfScene, ...]
    input_torque: float
    output_torque: float
    speed_given: bool
    text: str

    @property
    def ratio(self) -> float:
        """Turns of the first shaft in one turn of the last."""
        found = 1.0
        for mesh in self.meshes:
            found /= mesh.pair.rotation_ratio
        return found


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


def rows_of(meshes: Sequence[MeshOfScene]) -> list[list[int]]:
    """Numbers of meshes, those that idlers couple together."""
    rows: list[list[int]] = []
    for number, mesh in enumerate(meshes):
        if mesh.idler is None:
            rows.append([])
        rows[-1].append(number)
    return rows


def is_train(tree: Mapping[str, Any]) -> bool:
    return "stages" in tree and "gears" not in tree


def train_of(tree: Mapping[str, Any], text: str, name: str, source: str, folder: Path) -> TrainScene:
    """The train of a parsed text. Raises SceneError, naming all mistakes of the train or of one of its stages at once,
    and GeometryError for gears that overlap."""
    load, motion, problems = _sections(tree)
    if problems:
        raise SceneError(listed(problems, line_numbers(text), source))
    meshes: list[MeshOfScene] = []
    for stage, content in tree["stages"].items():
        meshes += _meshes_of(stage, content, tree, source, folder)
    return _completed(tree.get("title") or name, name, text, meshes, load, motion)


def _sections(tree: Mapping[str, Any]) -> tuple[Any, Any, list[Problem]]:
    problems = [
        Problem((each,), as_written(tree[each]), f"is not of a train.{did_you_mean(each, OF_A_TRAIN)} {_where(each)}")
        for each in tree
        if each not in OF_A_TRAIN
    ]
    stages = tree["stages"]
    if not isinstance(stages, Mapping) or not 0 < len(stages) <= MOST_STAGES:
        allowed = f"Allowed: 1 to {MOST_STAGES} sections [stages.NAME], each with the gears of a stage."
        return None, None, [*problems, Problem(("stages",), as_written(stages), f"has no stages. {allowed}")]
    for stage, content in stages.items():
        problems += _of_stage(("stages", stage), content)
    found = []
    for name, section in (("load", TrainLoad), ("motion", TrainMotion)):
        written = tree.get(name, {})
        if not isinstance(written, Mapping):
            problems.append(Problem((name,), as_written(written), f"is not a section with {fields_of(section)}."))
            continue
        values, wrong = read(section, written, (name,))
        found.append(values)
        problems += [_explained(each, section) for each in wrong]
    if isinstance(tree.get("load", {}), Mapping) and not {*names_in(TrainLoad)} & {*tree.get("load", {})}:
        problems.append(Problem(("load",), None, f"is missing. Add the section [load] with {fields_of(TrainLoad)}."))
    if not problems and found[0].power is not None and found[1].input_speed is None:
        problems.append(
            Problem(
                ("load", "power"), as_written(tree["load"]["power"]), "needs a speed. Allowed: with motion.input_speed."
            )
        )
    return *(found if not problems else (None, None)), problems


def _where(name: str) -> str:
    if name in OF_A_STAGE:
        return f"Write it within a stage: [stages.NAME.{name}]."
    if name in COUPLING:
        return f"It couples the stages, which is not yet computed. Known: {', '.join(OF_A_TRAIN)}."
    return f"Known: {', '.join(OF_A_TRAIN)}; within a stage {', '.join(OF_A_STAGE)} and all fields of [gears]."


def _explained(problem: Problem, section: type[Section]) -> Problem:
    if not problem.unknown:
        return problem
    names = names_in(section)
    said = f"is not known here.{did_you_mean(problem.path[-1], names)} Known: {', '.join(names)}."
    return replace(problem, message=said)


def _of_stage(path: tuple[str, ...], content: Any) -> Iterator[Problem]:
    if not isinstance(content, Mapping):
        yield Problem(path, as_written(content), "is not a section with the gears of a stage.")
        return
    kind = content.get("kind", PAIR)
    if kind not in (PAIR, ROW):
        said = "is not computed yet." if kind == "planetary" else "is no kind of stage."
        yield Problem((*path, "kind"), as_written(kind), f'{said} Allowed: "{PAIR}" or "{ROW}".')
    elif kind == ROW:
        yield from _of_row(path, content)
    elif "gears" in content or "directions" in content:
        wrong = "gears" if "gears" in content else "directions"
        yield Problem((*path, wrong), as_written(content[wrong]), f'is of a row. Add kind = "{ROW}", or leave it out.')
    idlers = kind == ROW and isinstance(content.get("gears"), list) and len(content["gears"]) > 2
    for name in (*COUPLING, *(OF_A_STAGE if idlers else ())):
        if name in content and name not in OF_A_ROW:
            what = "in rows with idlers" if name in OF_A_STAGE else "in trains"
            allowed = f"Allowed: {', '.join(OF_A_ROW if idlers else OF_A_STAGE)}."
            yield Problem((*path, name), "", f"is not yet computed {what}. {allowed}")


def _of_row(path: tuple[str, ...], content: Mapping[str, Any]) -> Iterator[Problem]:
    gears = content.get("gears")
    place = (*path, "gears")
    if not isinstance(gears, list) or len(gears) < 2 or not all(isinstance(each, Mapping) for each in gears):
        allowed = "Allowed: a list of at least two tables, as [{ teeth = 24 }, { teeth = 31 }, { teeth = 40 }]."
        yield Problem(place, None if gears is None else as_written(gears), f"has not the gears of a row. {allowed}")
        return
    directions = content.get("directions")
    if directions is not None and (not isinstance(directions, list) or len(directions) != len(gears) - 1):
        allowed = f"Allowed: {len(gears) - 1} angles, one for each mesh."
        yield Problem((*path, "directions"), as_written(directions), f"has not one angle for each mesh. {allowed}")
    for name in ("pinion", "wheel", "direction"):
        if name in content:
            yield Problem((*path, name), as_written(content[name]), "is of a pair. A row has gears and directions.")
    if len(gears) > 2 and "backlash" in content:
        said = (
            "would thin the teeth of an idler differently in both of its meshes. Allowed: profile_shift of each gear."
        )
        yield Problem((*path, "backlash"), as_written(content["backlash"]), said)


def _meshes_of(
    stage: str, content: Mapping[str, Any], tree: Mapping[str, Any], source: str, folder: Path
) -> list[MeshOfScene]:
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
        found = _pair_scene(sections, f"{stage} {number + 1}" if count > 1 else stage, label, folder)
        if count > 1:
            _check_in_row(found, label)
        return found

    scenes = [scene(number) for number in range(count)]
    for number in range(1, count):
        # An idler has one tip circle: the lower one of those that both of its mates leave room for.
        tips = [scenes[number - 1].gears.wheel.tip_diameter, scenes[number].gears.pinion.tip_diameter]
        if tips[0] != tips[1]:
            gears[number] = {**gears[number], "tip_diameter": f"{min(tips)!r} mm"}
            scenes[number - 1 : number + 1] = [scene(number - 1), scene(number)]
    pairs = [gear_pair(each.gears) for each in scenes]
    return _joined(stage, scenes, pairs, directions, label)


def _pair_scene(sections: Mapping[str, Any], name: str, source: str, folder: Path) -> Scene:
    """The scene of one mesh. Raises SceneError that says which stage it is of."""
    try:
        found = scene_from_text(as_toml(sections), name, source=source, directory=folder, with_lines=False)
    except SceneError as error:
        raise SceneError(f"{error}\n[gears] and its effects stand for the stage's own section.") from None
    except GeometryError as error:
        raise GeometryError(str(error)) from None
    if found.accuracy.target is not None:
        raise SceneError(f"{source}: accuracy.target is not yet computed in trains. {NOTHING_DONE}")
    return found


def _check_in_row(scene: Scene, source: str) -> None:
    """Raise SceneError for a mesh of a row with idlers that is not of elastic spur gears in the plane."""
    if scene.three_dimensional:
        raise SceneError(
            f"{source}: helical gears are not yet computed in rows with idlers. Allowed: spur gears with"
            f" {', '.join(OF_A_ROW)}. {NOTHING_DONE}"
        )
    if not scene.resolves_contact or scene.accuracy.condensation is not None:
        raise SceneError(
            f"{source}: rigid teeth, accuracy.model and accuracy.condensation are not yet computed in rows with idlers."
            f" Allowed: elastic teeth, by a material. {NOTHING_DONE}"
        )


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
    stage: str, scenes: Sequence[Scene], pairs: Sequence[GearPair], directions: Sequence[float], label: str
) -> list[MeshOfScene]:
    """The meshes of a stage, with how each idler's second mesh follows from its first."""
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
            # In the frame of every second mesh, the mirror image, angles count the other way.
            sense = -1.0 if (number - 1) % 2 else 1.0
            angles = sense * (directions[number - 1] + pi), sense * directions[number]
            idler = second_mesh(before.pair, pair, *angles)
        name = f"{stage}: gears {number + 1} and {number + 2}" if len(scenes) > 1 else stage
        meshes.append(MeshOfScene(name, scene, pair, directions[number], idler))
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


def _completed(
    title: str, name: str, text: str, meshes: Sequence[MeshOfScene], load: TrainLoad, motion: TrainMotion
) -> TrainScene:
    """The train with steps, speeds and torques of all meshes."""
    ratios = [mesh.pair.rotation_ratio for mesh in meshes]
    through = 1.0
    for each in ratios:
        through *= each
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
    for mesh, ratio in zip(meshes, ratios):
        torque /= ratio
        moving = Motion(frequency, cycles, cycles, False, speed is not None)
        behind = meshes[len(found) + 1 : len(found) + 2]
        frequency *= behind[0].pair.pinion.teeth / mesh.pair.wheel.teeth if behind else 1.0
        found.append(replace(mesh, scene=replace(mesh.scene, load=Load(torque), motion=moving)))
    return TrainScene(title, name, tuple(found), output * through, output, speed is not None, text)
