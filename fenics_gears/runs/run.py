"""One run of many: its scene, made when it is asked for, and what its result is known by."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from dataclasses import dataclass, field, fields, replace
from typing import TYPE_CHECKING, Any

from fenics_gears.elasticity.cache import as_json
from fenics_gears.model.model import Model
from fenics_gears.numbers_version import NUMBERS_VERSION
from fenics_gears.scene.data import Scene
from fenics_gears.scene.schema import WORDS

from .gear_store import cycle_key, operators_key

if TYPE_CHECKING:
    from fenics_gears.model.train import TrainModel
    from fenics_gears.scene.train import TrainScene

Sharing = tuple[int, int]


@dataclass(frozen=True)
class Run:
    """A scene, of a pair or of a train, that is to be run.

    `key`: hash of all that its result depends on. `sharing`: equal numbers of runs that share contact operators, and of
    these of runs with the same gaps. `make`: makes its model. `index`: its place in a study. `values`: of the swept
    fields, in words.
    """

    key: str
    sharing: Sharing
    make: Callable[[], Model | TrainModel]
    index: int = 0
    values: dict[str, str] = field(default_factory=dict)

    @property
    def model(self) -> Any:
        """A `Model`, of a train a `TrainModel`."""
        return self.make()

    @property
    def scene(self) -> Any:
        """A `Scene`, of a train a `TrainScene`."""
        return self.model.scene

    @property
    def name(self) -> str:
        """What its files are called, without the ending."""
        return f"{self.index:04d}-{self.key[:16]}"

    def __str__(self) -> str:
        return f"case {self.index} ({', '.join(f'{name} = {value}' for name, value in self.values.items())})"

    def __reduce__(self) -> tuple:
        # To another process goes the model without what it has computed of itself.
        return _received, (self.model.changed(replace), self.key, self.index, self.values)


def run_of(model: Model | TrainModel, index: int = 0, values: dict[str, str] | None = None, make: Any = None) -> Run:
    """The run of a model, which it holds unless it can `make` it again."""
    # Root stress and gears whose settings are yet to be chosen are condensed in other ways.
    apart = [(each.scene.output.root_stress, each.scene.accuracy.target) for each in model.models]
    operators = [operators_key(each) for each in model.models]
    cycles = map(cycle_key, model.models, operators)
    sharing = hash((*operators, *apart)), hash(tuple(cycles))
    return Run(scene_key(model.scene), sharing, make or (lambda: model), index, values or {})


def _received(model: Model | TrainModel, key: str, index: int, values: dict[str, str]) -> Run:
    return Run(key, (0, 0), lambda: model, index, values)


def scene_key(scene: Scene | TrainScene) -> str:
    """Hash of all that a scene's result depends on: its values, however they are written, and the version of the
    program's numbers."""
    if not isinstance(scene, Scene):
        return _train_key(scene)
    said = ",".join(f'"{name}":{as_json(getattr(scene, name))}' for name in _SAID)
    return hashlib.sha256(f'{{"numbers":{NUMBERS_VERSION},"scene":{{{said}}}}}'.encode()).hexdigest()


def _train_key(train: TrainScene) -> str:
    """That of the scene of each mesh, and all else that the train says but for words."""
    said = {each.name: getattr(train, each.name) for each in fields(train) if each.name not in (*WORDS, *OF_A_TRAIN)}
    if train.joined:
        said |= {"parts": [*map(_train_key, train.joined)], "joints": [each.stiffness for each in train.joints]}
    meshes = [
        (scene_key(mesh.scene), {each.name: getattr(mesh, each.name) for each in fields(mesh) if each.name not in READ})
        for mesh in train.meshes
    ]
    return hashlib.sha256(as_json((meshes, said)).encode()).hexdigest()


# Of a train, what is said mesh by mesh, and of a mesh, what its scene says.
OF_A_TRAIN = ("meshes", "text", "joined", "joints")
READ = ("scene", "pair")
_SAID = sorted({each.name for each in fields(Scene)} - {*WORDS})
