"""The two tasks of a study's processes: condense a gear, run a case. Of a case that fails the reason is kept."""

from __future__ import annotations

import time
import traceback
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from fenics_gears.elasticity.cache import user_cache
from fenics_gears.elasticity.compliance import Reach
from fenics_gears.errors import GearsError
from fenics_gears.model.model import Model, model_of
from fenics_gears.scene.data import Scene
from fenics_gears.simulation.root_stress import rows_of
from fenics_gears.simulation.routes import route_of
from fenics_gears.simulation.simulate import simulate
from fenics_gears.studies.case_files import save_case, save_failure
from fenics_gears.studies.combine import CaseRecord
from fenics_gears.studies.gear_store import GEARS, body_key, cycle_key, gear_key, operators_key, own_gear_store
from fenics_gears.studies.study import Case
from fenics_gears.system.progress import SilentProgress

Tick = Callable[[], None]

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


def gear_tasks(cases: list[Case]) -> list[GearTask]:
    """The distinct gears of the cases; first what takes longest."""
    reaches: dict[tuple, Reach] = {}
    tasks: dict[str, dict[tuple, GearTask]] = {ROOT_STRESS: {}, BODY: {}, SECTION: {}}
    for case in cases:
        model = model_of(case.scene)
        # With a target the gears' meshes are known only after settings are chosen.
        if case.scene.accuracy.target is not None or not route_of(model).condensed_once:
            continue
        cycle = cycle_key(model)[:4]  # the reach follows from gears and accuracy
        if cycle not in reaches:
            reaches[cycle] = model.touching.reach
        for name in GEARS:
            for part, key in _keys(model, name, reaches[cycle]):
                # Young's modulus is a factor, so the cache keeps one entry for all its values.
                tasks[part].setdefault(
                    (key[0], key[1].poissons_ratio, *key[2:]), GearTask(case.scene, name, reaches[cycle], part)
                )
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


def in_order_of_sharing(cases: list[Case]) -> list[Case]:
    """The cases in their order, but those that share contact operators next to each other, and of these those with the
    same gaps."""
    groups: dict[tuple, dict[tuple, list[Case]]] = {}
    for case in cases:
        model = model_of(case.scene)
        groups.setdefault(operators_key(model), {}).setdefault(cycle_key(model), []).append(case)
    return [case for group in groups.values() for alike in group.values() for case in alike]


def condense(task: GearTask, tick: Tick | None = None) -> None:
    """Condense a gear into the cache and into this process's store."""
    model, store = model_of(task.scene), own_gear_store()
    if task.part == ROOT_STRESS:
        rows_of(model, task.name, user_cache())
    else:
        (store.body if task.part == BODY else store.gear)(model, task.name, task.reach, user_cache())


def run_case(directory: Path, case: Case, tick: Tick | None = None) -> CaseRecord | str:
    """Run a case and write its file, or why it failed, into a directory; return its record, or that reason. Raises
    KeyboardInterrupt where Ctrl-C
    ended it."""
    begun = time.perf_counter()
    try:
        run = simulate(case.scene, progress=Ticking(tick), preparation=own_gear_store().prepared)
        if not run.attrs["complete"]:
            raise KeyboardInterrupt
        run.attrs["wall_time"] = time.perf_counter() - begun
        return save_case(run, case, directory)
    except Exception as error:
        if isinstance(error.__cause__, KeyboardInterrupt):  # compiled code that a second Ctrl-C hit in the middle
            raise KeyboardInterrupt from error
        reason = str(error) if isinstance(error, GearsError) else f"{type(error).__name__}: {error}"
        save_failure(case, reason, traceback.format_exc(), directory)
        return reason


class Ticking(SilentProgress):
    """Calls ``tick`` as often as a simulation reports; it may raise KeyboardInterrupt."""

    def __init__(self, tick: Tick | None):
        self._tick = tick

    def update(self, done: int, total: int, note: str = "") -> None:
        """Call ``tick``."""
        if self._tick is not None:
            self._tick()
