"""The gears of many runs, each condensed once, a process a gear, before the runs that share them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from typing import ClassVar

from fenics_gears.elasticity.cache import user_cache
from fenics_gears.inputs.tree import GEARS
from fenics_gears.model.model import Model, model_of
from fenics_gears.model.row_model import RowModel
from fenics_gears.model.train import TrainModel
from fenics_gears.scene.data import Scene
from fenics_gears.scene.train_mesh import gear_names
from fenics_gears.simulation.bodies import body_key
from fenics_gears.simulation.root_stress import rows_of
from fenics_gears.simulation.routes import route_of
from fenics_gears.simulation.train import shared_body
from fenics_gears.system.environment import threads
from fenics_gears.system.progress import SilentProgress

from .gear_store import own_gear_store
from .run import Run

# What is condensed of a gear.
BODY = "body"
ROOT_STRESS = "root stress"


@dataclass(frozen=True)
class GearTask:
    """A gear of a scene, "pinion" or "wheel", of which a part is to be condensed: its body, or its root stress."""

    scene: Scene
    name: str
    part: str = BODY


@dataclass(frozen=True)
class SharedGearTask:
    """A gear of several meshes of a row, by its number, which is to be condensed."""

    row: RowModel
    gear: int
    part: ClassVar[str] = BODY

    @property
    def name(self) -> str:
        return gear_names(self.row.meshes)[self.gear]


def gear_tasks(runs: Iterable[Run]) -> list[GearTask | SharedGearTask]:
    """The distinct gears of the runs; first what takes longest."""
    tasks: dict[str, dict[tuple, GearTask | SharedGearTask]] = {ROOT_STRESS: {}, BODY: {}}
    # Runs that share contact operators share their gears.
    for run in {run.sharing[0]: run for run in runs}.values():
        for part, key, task in _tasks(run.model):
            # Young's modulus is a factor, so the cache keeps one entry for all its values.
            key = (key[0], key[1].poissons_ratio, *key[2:])
            tasks[part].setdefault(key, task)
    return [task for of_part in tasks.values() for task in of_part.values()]


def _tasks(model: Model | TrainModel) -> Iterator[tuple[str, tuple, GearTask | SharedGearTask]]:
    """Part, key and task of each gear of a model."""
    if isinstance(model, Model):
        yield from _of_pair(model, GEARS)
        return
    for row in model.rows:
        for gear, sides in enumerate(row.graph.sides):
            mesh, side = sides[0]
            if len(sides) == 1:
                yield from _of_pair(row.models[mesh], GEARS[side : side + 1])
            elif row.models[mesh].scene.accuracy.target is None:
                # Without what the models have computed of themselves.
                yield BODY, row.keys_of_shared(gear), SharedGearTask(row.changed(replace), gear)


def _of_pair(model: Model, names: Iterable[str]) -> Iterator[tuple[str, tuple, GearTask]]:
    # With a target the gears' meshes are known only after settings are chosen.
    if model.scene.accuracy.target is not None or not route_of(model).condensed_once:
        return
    for name in names:
        for part, key in _keys(model, name):
            yield part, key, GearTask(model.scene, name, part)


def _keys(model: Model, name: str) -> Iterator[tuple[str, tuple]]:
    key = body_key(model, name)
    yield BODY, key
    if model.scene.output.root_stress and route_of(model).stresses:
        slices = model.face.slices, model.pair.common_face, model.pair.gear_middles
        yield ROOT_STRESS, (*key, slices, model.scene.coast_flanks is not None)


def condense(task: GearTask | SharedGearTask, tick: Callable[[], None] | None = None) -> None:
    """Condense a gear into the cache and into this process's store; one of several meshes into the cache."""
    if isinstance(task, SharedGearTask):
        shared_body(task.row, task.gear, user_cache())
        return
    model = model_of(task.scene)
    if task.part == ROOT_STRESS:
        rows_of(model, task.name, user_cache())
    elif threads() > 1:
        # Both at once; the store then has the other one when it is asked for.
        own_gear_store().bodies(model, SilentProgress(), user_cache())
    else:
        own_gear_store().body(model, task.name, user_cache())
