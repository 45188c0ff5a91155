"""The gears of many runs, each condensed once, a process a gear, before the runs that share them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

from fenics_gears.elasticity.cache import user_cache
from fenics_gears.elasticity.compliance import Reach
from fenics_gears.model.model import Model, model_of
from fenics_gears.runs.gear_store import GEARS, body_key, gear_key, own_gear_store
from fenics_gears.runs.run import Run
from fenics_gears.scene.data import Scene
from fenics_gears.simulation.root_stress import rows_of
from fenics_gears.simulation.routes import route_of

# What is condensed of a gear.
SECTION, BODY, ROOT_STRESS = "section", "body", "root stress"


@dataclass(frozen=True)
class GearTask:
    """A gear to be condensed: the "pinion" or the "wheel" of a scene, over the teeth within `reach`; its plane section,
    its body over the face, or its root stress."""

    scene: Scene
    name: str
    reach: Reach
    part: str = SECTION


def gear_tasks(runs: Iterable[Run]) -> list[GearTask]:
    """The distinct gears of the runs; first what takes longest."""
    tasks: dict[str, dict[tuple, GearTask]] = {ROOT_STRESS: {}, BODY: {}, SECTION: {}}
    # Runs that share contact operators share their gears.
    for run in {run.sharing[0]: run for run in runs}.values():
        model = run.model
        # With a target the gears' meshes are known only after settings are chosen.
        if model.scene.accuracy.target is not None or not route_of(model).condensed_once:
            continue
        reach = model.touching.reach
        for name in GEARS:
            for part, key in _keys(model, name, reach):
                # Young's modulus is a factor, so the cache keeps one entry for all its values.
                key = (key[0], key[1].poissons_ratio, *key[2:])
                tasks[part].setdefault(key, GearTask(model.scene, name, reach, part))
    return [task for of_part in tasks.values() for task in of_part.values()]


def _keys(model: Model, name: str, reach: Reach) -> Iterator[tuple[str, tuple]]:
    """What is to be condensed of a gear, and what that depends on."""
    yield SECTION, gear_key(model, name, reach)
    if model.face is not None:
        yield BODY, body_key(model, name, reach)
    if model.scene.output.root_stress and route_of(model).stresses:
        face = None if model.face is None else (model.face.slices, model.pair.common_face, model.pair.gear_middles)
        yield (
            ROOT_STRESS,
            (*(gear_key if face is None else body_key)(model, name, reach), face, model.scene.coast_flanks is not None),
        )


def condense(task: GearTask, tick: Callable[[], None] | None = None) -> None:
    """Condense a gear into the cache and into this process's store."""
    model, store = model_of(task.scene), own_gear_store()
    if task.part == ROOT_STRESS:
        rows_of(model, task.name, user_cache())
    else:
        (store.body if task.part == BODY else store.gear)(model, task.name, task.reach, user_cache())
