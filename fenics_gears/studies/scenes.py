"""The scenes of a study's cases: the base scene with the changes of each."""

import functools
import itertools
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from fenics_gears.errors import SceneError
from fenics_gears.inputs.problem import Problem
from fenics_gears.inputs.written import as_toml
from fenics_gears.model.model import Model, model_of
from fenics_gears.scene.read import scene_of

from . import fields
from .axis import Axis, label

# Cases whose scenes and models are held, of 8 kB each.
MOST_HELD = 1000


@dataclass(frozen=True)
class Changes:
    """The changes that a study file makes to the base scene, by the paths of its fields."""

    without: tuple[fields.Path, ...]
    fixed: dict[fields.Path, Any]
    axes: tuple[Axis, ...]
    combine: str

    def points(self) -> Iterator[tuple[Any, ...]]:
        """The swept values of each case; the last axis changes fastest."""
        values = [axis.values for axis in self.axes]
        return itertools.product(*values) if self.combine == "product" else zip(*values)

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

    def __init__(self, name: str, directory: Path, changes: Changes, scene_tree: Mapping[str, Any]):
        self._name, self._directory, self._changes, self._tree = name, directory, changes, scene_tree
        self.points = list(changes.points())
        self.model = functools.lru_cache(MOST_HELD)(self._model)

    def values(self, index: int) -> dict[str, str]:
        """The swept fields of a case, in words."""
        return {axis.dotted: label(value) for axis, value in zip(self._changes.axes, self.points[index])}

    def _model(self, index: int) -> Model:
        tree = self._changes.apply(self._tree, self.points[index])
        return model_of_tree(f"{self._name}-{index:04d}", tree, self._directory)


class NoScene(SceneError):
    """A parsed file that is no scene; `problems`: all that is wrong with it."""

    def __init__(self, problems: list[Problem]):
        super().__init__("; ".join(f"{'.'.join(problem.path)} {problem.message}".strip() for problem in problems))
        self.problems = problems


def model_of_tree(name: str, tree: Mapping[str, Any], directory: Path) -> Model:
    """The model of a parsed scene. Raises NoScene."""
    try:
        text = as_toml(tree)
        scene, problems = scene_of(tree, text, name, directory)
        if scene is None:
            raise NoScene(problems)
        # It gives this scene, which need not be written and read again to see whether it does.
        scene.__dict__["text"] = text
        return model_of(scene)
    except NoScene:
        raise
    except SceneError as error:
        raise NoScene([Problem((), None, str(error))]) from error
