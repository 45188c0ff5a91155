"""A train of gears: a scene with `[stages.NAME]` in place of `[gears]`.

A stage of two gears has what the scene of a pair has: its gears, and the sections of its effects. In a row of gears
each gear meshes with the next, so that those between are idlers. The wheel of a stage, or the last gear of its row, is
on one rigid shaft with the pinion of the next stage, unless the scene says what shafts carry. Each mesh becomes the
scene of a pair, under the torque that it has in the train without losses, where paths share it evenly.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from math import ceil, lcm, pi, prod
from pathlib import Path
from typing import Any

from fenics_gears.effects import common_period
from fenics_gears.errors import SceneError
from fenics_gears.geometry.gear_train import Layout
from fenics_gears.inputs.problem import NOTHING_DONE, Problem, line_numbers, listed

from .data import Load, Motion
from .parsing import is_train, name_of, parsed, text_of
from .planetary import planetary_parts, seen_by_carrier
from .planetary_rules import has_planets
from .schema import LAST_CYCLES, NOMINAL_FREQUENCY
from .train_joints import Ends, JoinedText, in_series
from .train_layout import check_layout
from .train_loads import LoadOfShaft, TrainLoad
from .train_mesh import MeshOfScene, gear_names, layout_of, rows_of
from .train_pair import MistakesOfStage, TrainMistakes
from .train_rules import TrainSections, checked_train
from .train_scene import TrainScene, turns_of
from .train_shafts import located_shafts
from .train_stages import meshes_of_stages

Part = tuple[list[MeshOfScene], TrainSections]


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


def train_of(tree: Mapping[str, Any], text: str, name: str, source: str, folder: Path) -> TrainScene:
    """The train of a parsed text. Raises SceneError, naming all mistakes of the train or of one of its stages at once,
    and GeometryError for gears that overlap."""
    try:
        if has_planets(tree) and len(tree["stages"]) > 1:
            return _in_series(tree, text, name, source, folder)
        meshes, sections = _part(tree, source, folder)
    except MistakesOfStage as error:
        raise TrainMistakes(listed(error.problems, line_numbers(text), source), error.problems) from error
    return _completed(tree.get("title") or name, name, text, meshes, sections)


def _part(tree: Mapping[str, Any], source: str, folder: Path) -> Part:
    """The meshes of a parsed train without loads, and its sections. Raises MistakesOfStage."""
    if has_planets(tree):
        meshes, sections = planetary_parts(tree, source, folder)
    else:
        found, problems = checked_train(tree)
        if found is None:
            raise MistakesOfStage(problems)
        sections = replace(found, shafts=located_shafts(found.shafts, folder))
        meshes = meshes_of_stages(tree, sections, source, folder)
    check_layout(layout_of(meshes), [mesh.name for mesh in meshes], gear_names(meshes), source)
    return meshes, sections


def _in_series(tree: Mapping[str, Any], text: str, name: str, source: str, folder: Path) -> TrainScene:
    """Planetary sets beside other stages: each part of the train under the torque and at the speed that it has without
    losses."""
    whole = JoinedText.of(tree)
    found: list[Part] = []
    problems = []
    for each in whole.trees:
        try:
            found.append(_part(each, source, folder))
        except MistakesOfStage as error:
            problems += error.problems
    problems += [
        _together(meshes) for meshes, sections in found if not sections.shafts.carrier and sections.shafts.moving
    ]
    if problems:
        raise MistakesOfStage(problems)
    order, joints = in_series(whole, [_ends(sections) for _, sections in found])
    found = [found[number] for number in order]
    ratios = [_ratio(*part) for part in found]
    given = whole.motion.input_speed
    speed = 2.0 * pi * NOMINAL_FREQUENCY / _cycles_in_a_turn(*found[0]) if given is None else given
    *_, torque = torques_of_shafts(whole.load, (), [1.0, 1.0 / prod(ratios)], speed)
    parts: list[TrainScene] = []
    for number, (meshes, sections) in enumerate(found):
        behind = prod(ratios[number + 1 :])
        motion = replace(sections.motion, input_speed=speed / prod(ratios[:number]))
        own = replace(sections, load=TrainLoad(output_torque=torque / behind), motion=motion)
        title = ", ".join(dict.fromkeys(mesh.name.split(":")[0] for mesh in meshes))
        parts.append(_completed(title, name, text, meshes, own, given is not None))
    every = tuple(mesh for part in parts for mesh in part.meshes)
    ends = parts[0].input_torque, parts[-1].output_torque
    title = tree.get("title") or name
    return TrainScene(title, name, every, *ends, given is not None, text, joined=tuple(parts), joints=tuple(joints))


def _together(meshes: Sequence[MeshOfScene]) -> Problem:
    said = (
        "has stages that move together or share the power, which is not computed beside planetary sets yet. Allowed:"
        " stages one after the other on rigid shafts, without inertia and bearings; a shaft that twists may join them"
        " to a set."
    )
    return Problem(("stages", meshes[0].name.split(":")[0]), "", said)


def _ends(sections: TrainSections) -> Ends:
    """What stands on the first and on the last shaft of a part."""
    carrier = sections.shafts.carrier
    if carrier is None:
        return Ends(sections.shafts.carried[0], sections.shafts.carried[-1])
    own = carrier.set
    first, last = ((f"{carrier.stage}.{member}",) for member in (own.input, own.output))
    return Ends(first, last)


def _ratio(meshes: Sequence[MeshOfScene], sections: TrainSections) -> float:
    """Turns of the input of a part in one of its output."""
    carrier = sections.shafts.carrier
    return 1.0 / turns_of(layout_of(meshes))[-1] if carrier is None else abs(float(carrier.set.ratio))


def _cycles_in_a_turn(meshes: Sequence[MeshOfScene], sections: TrainSections) -> float:
    """Cycles of the first mesh of a part in a turn of its input."""
    carrier = sections.shafts.carrier
    first = meshes[layout_of(meshes).graph.out_of(0)[0]].pair.pinion.teeth
    return first if carrier is None else first * abs(float(carrier.set.sun_by_carrier))


def _completed(
    title: str, name: str, text: str, meshes: Sequence[MeshOfScene], sections: TrainSections, given: bool = True
) -> TrainScene:
    """The train with steps, speeds and torques of all meshes; `given`: whether a speed in the sections is the scene's,
    or stands for one."""
    sections = seen_by_carrier(sections, given)
    load = sections.load
    motion = sections.motion
    layout = layout_of(meshes)
    graph = layout.graph
    turns = turns_of(layout)
    speed = motion.input_speed
    if motion.speed is not None:
        speed = motion.speed / turns[sections.shafts.speed_of]
    # Without a speed a cycle of the first mesh that the first shaft drives takes a second.
    first = meshes[graph.out_of(0)[0]].pair.pinion.teeth
    of_first = NOMINAL_FREQUENCY if speed is None else speed / (2.0 * pi) * first
    driving = 2.0 * pi * of_first / first
    on_shafts = torques_of_shafts(load, sections.shafts.loads, turns, driving)
    given = given and speed is not None
    periods = [int(common_period(mesh.scene)) for mesh in meshes]
    # Meshes of one gear have one frequency to the last digit.
    lengths = [layout.turns[shaft] * pair.pinion.teeth / first for (shaft, _), pair in zip(graph.between, layout.pairs)]
    cycles = [motion.mesh_cycles or 1] * len(meshes)
    if motion.mesh_cycles is None and sections.shafts.carrier is None:
        cycles = _whole_periods(meshes, periods, lengths, sections.shafts.moving)
    torques = even_torques(layout, on_shafts)
    found: list[MeshOfScene] = []
    for number, mesh in enumerate(meshes):
        own = cycles[number]
        moving = Motion(of_first * float(lengths[number]), own, own, periods[number] > 1, given)
        found.append(replace(mesh, scene=replace(mesh.scene, load=Load(torques[number]), motion=moving)))
    usual = LAST_CYCLES if sections.shafts.ramp is None and max(periods) == 1 else max(cycles)
    recorded = min(motion.recorded_cycles or usual, max(cycles))
    of_ends = sum(own * turn for own, turn in zip(on_shafts, turns)), on_shafts[-1]
    if (carrier := sections.shafts.carrier) is not None:
        of_ends = carrier.torque, abs(carrier.set.torques(carrier.torque)[carrier.set.output])
    return TrainScene(title, name, tuple(found), *of_ends, given, text, sections.shafts, recorded)


def _whole_periods(
    meshes: Sequence[MeshOfScene], periods: Sequence[int], rates: Sequence[Fraction], moving: bool
) -> list[int]:
    """Cycles that each mesh is run, unless given: a whole period of what differs between its cycles; where stages move
    together so many of the slowest mesh that each has gone through its own. `rates`: mesh frequencies over one."""
    if moving:
        return [max(ceil(period / rate * min(rates)) for period, rate in zip(periods, rates))] * len(meshes)
    found = list(periods)
    for row in rows_of(meshes):
        for number in row:
            found[number] = lcm(*(periods[each] for each in row))
    return found


def torques_of_shafts(
    load: TrainLoad, loads: Sequence[LoadOfShaft], turns: Sequence[float], driving: float
) -> list[float]:
    """Torque (N mm) that resists the rotation of each shaft but the first from outside; `turns` of each in one of the
    first, which turns by `driving` rad/s. Raises SceneError where nothing is left for the last shaft."""
    found = [0.0] * len(turns)
    for each in loads:
        found[each.shaft] = each.torque
    if load.output_torque is not None:
        found[-1] = load.output_torque
    elif load.input_torque is not None or load.power is not None:
        torque = load.input_torque if load.input_torque is not None else (load.power or 0.0) / driving
        others = sum(own * turn for own, turn in zip(found, turns))
        if others and others >= torque:
            raise SceneError(
                f"load: {1e-3 * torque:.6g} N m drive the first shaft, of which load.torques take {1e-3 * others:.6g} N"
                " m: nothing is left for the last shaft. Allowed: more input_torque or power, or smaller load.torques."
                f" {NOTHING_DONE}"
            )
        found[-1] = (torque - others) / turns[-1]
    return found


def even_torques(layout: Layout, of_shafts: Sequence[float]) -> list[float]:
    """Torque (N mm) on the wheel of each mesh without losses, where the meshes that drive a shaft share it evenly;
    `of_shafts`: torque on each shaft from outside."""
    graph = layout.graph
    on_shafts = list(of_shafts)
    found = [0.0] * len(layout.pairs)
    for shaft in range(graph.last, 0, -1):
        driving = graph.into(shaft)
        for mesh in driving:
            found[mesh] = on_shafts[shaft] / len(driving)
            on_shafts[graph.between[mesh][0]] += found[mesh] * abs(layout.pairs[mesh].rotation_ratio)
    return found
