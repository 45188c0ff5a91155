"""A run of a train from its scene to its result: the settings of stages with a target are chosen first."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Any

import xarray as xr

from fenics_gears.elasticity.cache import Cache
from fenics_gears.inputs.section import tree_of
from fenics_gears.inputs.written import as_toml
from fenics_gears.model.model import Model
from fenics_gears.model.train import TrainModel
from fenics_gears.scene.parsing import parsed
from fenics_gears.scene.train import TrainScene
from fenics_gears.scene.train_pair import STAGES
from fenics_gears.simulation.routes import Preparation
from fenics_gears.simulation.train import Keep, KeptRow, solved_train
from fenics_gears.system.progress import Progress, SilentProgress

from .gear_store import GearStore
from .simulate import SettledScene, settled


def simulate_train(
    scene: TrainScene | TrainModel,
    progress: Progress | None = None,
    cache: Cache | None = None,
    keep: Keep | None = None,
    preparation: Preparation | None = None,
    kept_row: KeptRow | None = None,
) -> xr.Dataset:
    """Run a train and return its result: the variables of a pair over steps and `mesh`, the numbers of each mesh, and
    the transmission error of the whole over time. Of stages with `[accuracy] target` settings are chosen first, and the
    scene in the result has them.

    keep: is given each stage of two gears and its result as a pair.
    preparation: as in `simulate`, of each of these; kept_row: keeps the contact equations of rows with idlers, or makes
        them.

    Raises GeometryError and SceneError before any computation, ComputationError where a stage fails, KeyboardInterrupt
    on Ctrl-C.

    >>> from fenics_gears import load_train, simulate_train
    >>> found = simulate_train(load_train("demos/gear_trains/idler.toml"))
    >>> found["mesh"].values.tolist()
    ['idler: gears 1 and 2', 'idler: gears 2 and 3']
    """
    chosen: dict[str, SettledScene] = {}

    def settle(model: Model, progress: Progress) -> SettledScene:
        chosen[model.scene.name] = found = settled(model, progress)
        return found

    result = solved_train(scene, progress or SilentProgress(), cache, keep, preparation, settle, kept_row)
    with_settings = {name: each for name, each in chosen.items() if each.chosen}
    if with_settings:
        result.attrs["scene"] = _with_settings(str(result.attrs["scene"]), with_settings)
    return result


def _with_settings(text: str, chosen: dict[str, SettledScene]) -> str:
    """The text of a train with the settings of its stages in place of their targets."""
    tree = parsed(text, "the train")
    stages = dict(tree[STAGES])
    for name, each in chosen.items():
        scene = each.scene.scene if isinstance(each.scene, Model) else each.scene
        stages[name] = {**stages[name], "accuracy": tree_of(scene.accuracy)}
    return as_toml({**tree, STAGES: stages})


@dataclass
class RunOfTrain:
    """As `RunResult`, of a train: its `dataset`, its `attrs` and the `seconds` that its numbers took."""

    dataset: xr.Dataset

    @property
    def attrs(self) -> dict[str, Any]:
        return self.dataset.attrs

    @property
    def seconds(self) -> float:
        return self.attrs["time_numbers"]


def train_completed(model: TrainModel, store: GearStore, progress: Progress | None = None) -> RunOfTrain:
    """The whole result of a train's run and its `wall_time`, s. Raises KeyboardInterrupt on Ctrl-C."""
    begun = time.perf_counter()
    store.of_pairs(len(model.rows))
    dataset = simulate_train(model, progress, preparation=store.prepared, kept_row=store.row)
    dataset.attrs["wall_time"] = time.perf_counter() - begun
    return RunOfTrain(dataset)
