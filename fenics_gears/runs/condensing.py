"""The gears of many runs, each condensed once, a process a gear, before the runs that share them."""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

from fenics_gears.elasticity.cache import user_cache
from fenics_gears.inputs.tree import GEARS
from fenics_gears.model.model import Model, model_of
from fenics_gears.scene.data import Scene
from fenics_gears.simulation.bodies import body_key
from fenics_gears.simulation.root_stress import rows_of
from fenics_gears.simulation.routes import route_of
from fenics_gears.system.progress import SilentProgress
from fenics_gears.system.second_process import threads

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


def gear_tasks(runs: Iterable[Run]) -> list[GearTask]:
    """The distinct gears of the runs; first what takes longest."""
    tasks: dict[str, dict[tuple, GearTask]] = {ROOT_STRESS: {}, BODY: {}}
    # Runs that share contact operators share their gears.
    for run in {run.sharing[0]: run for run in runs}.values():
        model = run.model
        # With a target the gears' meshes are known only after settings are chosen.
        if model.scene.accuracy.target is not None or not route_of(model).condensed_once:
            continue
        for name in GEARS:
            for part, key in _keys(model, name):
                # Young's modulus is a factor, so the cache keeps one entry for all its values.
                key = (key[0], key[1].poissons_ratio, *key[2:])
                tasks[part].setdefault(key, GearTask(model.scene, name, part))
    return [task for of_part in tasks.values() for task in of_part.values()]


def _keys(model: Model, name: str) -> Iterator[tuple[str, tuple]]:
    key = body_key(model, name)
    yield BODY, key
    if model.scene.output.root_stress and route_of(model).stresses:
        slices = model.face.slices, model.pair.common_face, model.pair.gear_middles
        yield ROOT_STRESS, (*key, slices, model.scene.coast_flanks is not None)


def condense(task: GearTask, tick: Callable[[], None] | None = None) -> None:
    """Condense a gear into the cache and into this process's store."""
    model = model_of(task.scene)
    if task.part == ROOT_STRESS:
        rows_of(model, task.name, user_cache())
    elif threads() > 1:
        # Both at once; the store then has the other one when it is asked for.
        own_gear_store().bodies(model, SilentProgress(), user_cache())
    else:
        own_gear_store().body(model, task.name, user_cache())
