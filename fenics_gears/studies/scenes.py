"""The scenes of a study's cases: the base scene with the changes of each."""

from __future__ import annotations

import functools
import itertools
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from fenics_gears.effects import effect_named
from fenics_gears.errors import SceneError
from fenics_gears.inputs.problem import NOTHING_DONE, Problem
from fenics_gears.inputs.section import read
from fenics_gears.inputs.written import as_toml
from fenics_gears.model.model import RELIEFS, Model, model_of, with_reliefs
from fenics_gears.model.train import TrainModel, train_model_of
from fenics_gears.scene.data import Scene
from fenics_gears.scene.parsing import is_train, values_of
from fenics_gears.scene.rules import broken_by_numbers
from fenics_gears.scene.train import train_of
from fenics_gears.scene.train_pair import TrainMistakes

from . import fields
from .axis import Axis, label

# Cases whose scenes and models are held, of 8 kB each.
MOST_HELD = 1000


@dataclass(frozen=True)
class SceneChanges:
    """The changes that a study file makes to the base scene, by the paths of its fields."""

    without: tuple[fields.Path, ...]
    fixed: dict[fields.Path, Any]
    axes: tuple[Axis, ...]
    combine: str

    def points(self) -> Iterator[tuple[Any, ...]]:
        """The values of each case in the order of the axes, of which random ones are last and vary together."""
        if self.combine != "product":
            return zip(*(axis.values for axis in self.axes))
        samples = list(zip(*(axis.values for axis in self.axes if axis.random))) or [()]
        listed = itertools.product(*(axis.values for axis in self.axes if not axis.random))
        return ((*point, *sample) for point, sample in itertools.product(listed, samples))

    def apply(self, tree: Mapping[str, Any], point: tuple[Any, ...]) -> dict[str, Any]:
        """The scene of one case: first what is left out, then what is set, then what is swept."""
        for path in self.without:
            tree = fields.changed(tree, path, fields.ABSENT)
        for path, value in self.fixed.items():
            tree = fields.with_section(tree, path) if value == {} else fields.changed(tree, path, value)
        for axis, value in zip(self.axes, point):
            tree = fields.changed(tree, axis.path, value)
        return dict(tree)


class Scenes:
    """The scenes of a study's cases: of a large study each is made again when it is asked for."""

    def __init__(self, name: str, directory: Path, changes: SceneChanges, scene_tree: Mapping[str, Any]):
        self._name = name
        self._directory = directory
        self._changes = changes
        self._tree = scene_tree
        self.points = list(changes.points())
        self.model = functools.lru_cache(MOST_HELD)(self._model)

    def values(self, index: int) -> dict[str, str]:
        return {axis.dotted: label(value) for axis, value in zip(self._changes.axes, self.points[index])}

    def _model(self, index: int) -> Model | TrainModel:
        tree = self._changes.apply(self._tree, self.points[index])
        return model_of_tree(f"{self._name}-{index:04d}", tree, self._directory)


class Models:
    """The models of parsed scenes of one `name`, which name files from a `directory` on. A plane scene that differs
    from one before in the numbers of its reliefs alone is that one with other values, which takes a sixth of the
    time."""

    def __init__(self, name: str, directory: Path):
        self._name = name
        self._directory = directory
        # Parsed scenes without reliefs, the names of all that their reliefs say, and their models.
        self._known: list[tuple[dict[str, Any], Any, Model]] = []

    def of(self, tree: Mapping[str, Any]) -> Any:
        """The model of a parsed scene. Raises NoScene."""
        if is_train(tree):
            return model_of_tree(self._name, tree, self._directory)
        rest = {name: section for name, section in tree.items() if name not in RELIEFS}
        said = _names({name: tree.get(name) for name in RELIEFS})
        known = next((model for others, names, model in self._known if names == said and others == rest), None)
        changed = None if known is None else self._with_reliefs(known, tree)
        if changed is not None:
            return changed
        # It has all reasons where it is no scene.
        model = model_of_tree(self._name, tree, self._directory)
        if known is None and not model.scene.three_dimensional:
            self._known = [(rest, said, model), *self._known[: MOST_HELD // 10]]
        return model

    def _with_reliefs(self, model: Model, tree: Mapping[str, Any]) -> Model | None:
        """A model with the reliefs of a parsed scene; None where something is wrong with them."""
        own = {}
        problems = broken_by_numbers(tree, RELIEFS)
        for effect in (effect_named(name) for name in RELIEFS if name in tree):
            section, wrong = read(effect.fields, tree[effect.section], (effect.section,))
            problems += wrong
            if not problems:
                own[effect.section] = effect.data_of(section, self._directory)
        if problems:
            return None
        scene = replace(model.scene, **own)
        # As in `model_of_tree`.
        scene.__dict__["text"] = as_toml(tree)
        try:
            return with_reliefs(model, scene)
        except SceneError:
            return None


def _names(said: Any) -> Any:
    return {name: _names(each) for name, each in said.items()} if isinstance(said, Mapping) else type(said)


class NoScene(SceneError):
    """A parsed file that is no scene; `problems`: all that is wrong with it."""

    def __init__(self, problems: list[Problem]):
        super().__init__("; ".join(f"{'.'.join(problem.path)} {problem.message}".strip() for problem in problems))
        self.problems = problems


def model_of_tree(name: str, tree: Mapping[str, Any], directory: Path) -> Any:
    """The `Model` of a parsed scene, of a train its `TrainModel`. Raises NoScene."""
    if is_train(tree):
        return _train_of_tree(name, tree, directory)
    try:
        text = as_toml(tree)
        values, problems = values_of(tree, text, name, directory)
        if values is None:
            raise NoScene(problems)
        scene = Scene(**values)
        # It gives this scene, which need not be written and read again to be sure.
        scene.__dict__["text"] = text
        return model_of(scene)
    except NoScene:
        raise
    except SceneError as error:
        raise _no_scene(error) from error


def _train_of_tree(name: str, tree: Mapping[str, Any], directory: Path) -> TrainModel:
    try:
        return train_model_of(train_of(tree, as_toml(tree), name, "the train", directory))
    except TrainMistakes as error:
        raise NoScene(error.problems) from error
    except SceneError as error:
        raise _no_scene(error) from error


def _no_scene(error: SceneError) -> NoScene:
    said = str(error).replace(NOTHING_DONE, "").strip()
    return NoScene([Problem((), None, each) for each in said.splitlines()])
