"""The scene of a mesh of a train, and mistakes in it at their places in the train."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

from fenics_gears.errors import GeometryError, SceneError
from fenics_gears.geometry.pair import GearPair, gear_pair
from fenics_gears.inputs.problem import NOTHING_DONE, Problem
from fenics_gears.inputs.problem import Path as Field
from fenics_gears.inputs.tree import GEARS
from fenics_gears.inputs.written import as_toml

from .data import Scene
from .parsing import parsed, values_of

STAGES = "stages"
SPEED_OF_PAIR = 'motion.pinion_speed, such as "1500 rpm", or motion.mesh_frequency'
SPEED_OF_TRAIN = 'motion.input_speed, such as "1500 rpm"'
# Put in for speed and length of the train's run, which are not known yet.
ANY_MOTION = {"pinion_speed": "1 rpm", "mesh_cycles": 1}


class MistakesOfStage(SceneError):
    """All that is wrong with a stage, at its places in the train."""

    def __init__(self, problems: list[Problem]):
        super().__init__("; ".join(each.message for each in problems))
        self.problems = problems


class TrainMistakes(SceneError):
    """All that is wrong with a train, in words, and as `problems`."""

    def __init__(self, words: str, problems: list[Problem]):
        super().__init__(words)
        self.problems = problems


def in_stage(stage: str, places: Mapping[str, Field], shared: Collection[str], path: Field) -> Field:
    """Where a train has what its pair's scene has at a path; `places`: of the gears of a row; `shared`: sections of all
    stages."""
    if path[:1] != ("gears",):
        return path if {*path[:1]} & {"load", *shared} else (STAGES, stage, *path)
    gear = places.get(path[1], path[1:2]) if len(path) > 1 else ()
    return (STAGES, stage, *gear, *path[2:])


class Placed(NamedTuple):
    """Where a train has what a pair's scene has, and how it says what is said of the pair."""

    field: Callable[[Field], Field]
    words: Callable[[str], str]

    def of(self, problem: Problem) -> Problem:
        """A mistake in a pair's scene at its place in the train."""
        message = self.words(problem.message)
        for place in (*(("gears", gear) for gear in GEARS), ("gears",)):
            message = message.replace(f"[{'.'.join(place)}", f"[{'.'.join(self.field(place))}")
        message = message.replace(SPEED_OF_PAIR, SPEED_OF_TRAIN)
        return replace(problem, path=self.field(problem.path), message=message)


def pair_scene(sections: Mapping[str, Any], name: str, source: str, folder: Path, place: Placed) -> Scene:
    """The scene of one mesh; `place`: where the train has what it has. Raises MistakesOfStage."""
    text = as_toml(sections)
    try:
        values, problems = values_of(parsed(text, source), text, name, folder)
    except GeometryError as error:
        raise GeometryError(f"{source}: {error}") from error
    if values is None:
        raise MistakesOfStage([place.of(each) for each in problems])
    found = Scene(**values)
    found.__dict__["text"] = text
    return found


def motion_put_in(sections: Mapping[str, Any], tree: Mapping[str, Any]) -> dict[str, Any]:
    """The motion of a mesh with these sections, where its masses or a formula of friction ask for one that the train
    has."""
    friction = sections.get("friction")
    formula = isinstance(friction, Mapping) and "formula" in friction
    if "inertia" in sections or formula and {"input_speed", "speed"} & {*tree.get("motion", {})}:
        return {"motion": ANY_MOTION}
    return {}


def pair_of(scene: Scene, label: str, words: Callable[[str], str] = str) -> GearPair:
    """The gears of a mesh; `label`: its file and stage, `words`: what is said of the pair, in those of the train.
    Raises GeometryError."""
    try:
        return gear_pair(scene.gears)
    except GeometryError as error:
        raise GeometryError(f"{label}: {words(str(error))}") from error


def check_together(scene: Scene, source: str) -> None:
    """Raise SceneError for a mesh that cannot yet move together with others."""
    together = "where meshes move together, by idlers, [shafts], [inertia] or [bearings]"
    if not scene.resolves_contact or scene.accuracy.condensation is not None:
        raise SceneError(
            f"{source}: rigid teeth, accuracy.model and accuracy.condensation are not yet computed {together}."
            f" Allowed: elastic teeth, by a material. {NOTHING_DONE}"
        )
    bearings = scene.bearings
    own = scene.shafts is None and bearings is not None and bearings.each is not None
    if bearings is not None and (bearings.places is not None or own):
        raise SceneError(
            f"{source}: bearings with places are not yet computed in trains. Allowed: bearings.stiffness, which holds"
            f" the centre of each gear. {NOTHING_DONE}"
        )
