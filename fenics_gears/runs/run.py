"""One run of many: its scene, made when it is asked for, and what its result is known by."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, fields
from functools import partial
from typing import Any

from fenics_gears.elasticity.cache import content_key
from fenics_gears.model.model import Model, model_of
from fenics_gears.numbers_version import NUMBERS_VERSION
from fenics_gears.runs.gear_store import cycle_key, operators_key
from fenics_gears.scene.data import Scene

Sharing = tuple[int, int]


@dataclass(frozen=True)
class Run:
    """A scene that is to be run.

    `key`: hash of all that its result depends on; `sharing`: equal numbers of runs that share contact operators, and of
    these of runs with the same gaps; `make`: makes its model; `index`: its place among the cases of a study, `values`:
    of the swept fields, in words.
    """

    key: str
    sharing: Sharing
    make: Callable[[], Model]
    index: int = 0
    values: dict[str, str] = field(default_factory=dict)

    @property
    def model(self) -> Model:
        """The model of its scene."""
        return self.make()

    @property
    def scene(self) -> Scene:
        """Its scene."""
        return self.model.scene

    @property
    def name(self) -> str:
        """What its files are called, without the ending."""
        return f"{self.index:04d}-{self.key[:16]}"

    def __str__(self) -> str:
        """The run in words."""
        return f"case {self.index} ({', '.join(f'{name} = {value}' for name, value in self.values.items())})"

    def __reduce__(self) -> tuple:
        # To another process goes the scene; its model is made there.
        return _received, (self.scene, self.key, self.index, self.values)


def run_of(model: Model, index: int = 0, values: dict[str, str] | None = None, make: Any = None) -> Run:
    """The run of a model, which it holds unless it can `make` it again."""
    # Root stress and gears whose settings are yet to be chosen are condensed in other ways.
    apart = model.scene.output.root_stress, model.scene.accuracy.target
    operators = operators_key(model)
    sharing = hash((operators, apart)), hash(cycle_key(model, operators))
    return Run(scene_key(model.scene), sharing, make or (lambda: model), index, values or {})


def _received(scene: Scene, key: str, index: int, values: dict[str, str]) -> Run:
    return Run(key, (0, 0), partial(model_of, scene), index, values)


def scene_key(scene: Scene) -> str:
    """Hash of all that a scene's result depends on: its values, however they are written, and the version of the
    program's numbers."""
    words = "title", "name", "derived", "written", "folder"
    said = {field.name: getattr(scene, field.name) for field in fields(scene) if field.name not in words}
    return content_key({"scene": said, "numbers": NUMBERS_VERSION})
