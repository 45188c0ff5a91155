"""A run of a train from its scene to its result: where it has a target, settings are chosen first."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import xarray as xr

from fenics_gears.contact.errors import ContactNotConverged
from fenics_gears.elasticity.cache import Cache
from fenics_gears.errors import SceneError
from fenics_gears.inputs.section import tree_of
from fenics_gears.inputs.written import as_toml
from fenics_gears.model.train import TrainModel, row_of, train_model_of
from fenics_gears.results.train import MeshResult, dataset_of, mesh_result
from fenics_gears.scene.accuracy import Accuracy
from fenics_gears.scene.parsing import parsed
from fenics_gears.scene.train import TrainScene
from fenics_gears.scene.train_mesh import MeshOfScene
from fenics_gears.scene.train_pair import STAGES
from fenics_gears.simulation.routes import Preparation
from fenics_gears.simulation.train import KeptRow, solved_row
from fenics_gears.system.progress import Progress, SilentProgress

from .gear_store import GearStore
from .simulate import settled_run

# What the result says of each mesh for which settings were chosen.
OF_TARGET = ("target", "estimated_error", "target_runs")
Keep = Callable[[MeshOfScene, xr.Dataset], None]
RAMPED = (
    ". [speed_ramp] accelerates the masses too, which can pull the teeth apart or wedge them. Allowed: a longer ramp"
    " (motion.mesh_cycles), an end_speed nearer to motion.input_speed, or a higher torque"
)


def simulate_train(
    scene: TrainScene | TrainModel,
    progress: Progress | None = None,
    cache: Cache | None = None,
    keep: Keep | None = None,
    preparation: Preparation | None = None,
    kept_row: KeptRow | None = None,
) -> xr.Dataset:
    """Run a train and return its result: the variables of a pair over steps and `mesh`, the numbers of each mesh, and
    the transmission error of the whole over time. With `[accuracy] target` settings are chosen first, at once of meshes
    that are computed together, and the scene in the result has them.

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
    if not isinstance(scene, TrainScene | TrainModel):
        raise SceneError(
            f"simulate_train takes a train, from load_train, not an object of type {type(scene).__name__}. The scene of"
            " a pair is read by load_scene and run by simulate"
        )
    progress = progress or SilentProgress()
    model = scene if isinstance(scene, TrainModel) else train_model_of(scene)
    chosen: dict[str, Accuracy] = {}
    found: list[MeshResult] = []
    for row, (part, numbers) in zip(model.rows, model.scene.rows_of_parts):
        mesh = row.meshes[0]
        target = mesh.scene.accuracy.target
        try:
            if not row.single:
                how: dict[str, Any] = {}
                if target is not None:
                    # Runs without a target load nothing of it.
                    from .settings.row_trials import chosen_of_row

                    settings = chosen_of_row(part, numbers, target, cache, progress)
                    row = row_of(settings.setting.of(part), numbers)
                    chosen |= dict(settings.setting.of_stages)
                    how = {name: settings.attributes(target)[name] for name in OF_TARGET}
                own = solved_row(row, progress, cache, kept_row)
                found += [replace(each, numbers=each.numbers | how) for each in own]
                continue
            result = settled_run(row.models[0], progress, cache=cache, preparation=preparation)
        except ContactNotConverged as failure:
            failure.reason = f"{mesh.name}: {failure.reason}{RAMPED if row.ramp is not None else ''}"
            failure.partial = None
            raise
        if not result.attrs["complete"]:
            raise KeyboardInterrupt
        if keep is not None:
            keep(mesh, result.dataset)
        if target is not None:
            chosen[row.models[0].scene.name] = result.recorder.model.scene.accuracy
        found.append(mesh_result(mesh.name, result))
    dataset = dataset_of(model, found)
    if chosen:
        dataset.attrs["scene"] = _with_settings(str(dataset.attrs["scene"]), chosen)
    return dataset


def _with_settings(text: str, chosen: dict[str, Accuracy]) -> str:
    """The text of a train with the settings of its stages in place of their targets."""
    tree = parsed(text, "the train")
    stages = {name: {**tree[STAGES][name], "accuracy": tree_of(accuracy)} for name, accuracy in chosen.items()}
    return as_toml({**tree, STAGES: {**tree[STAGES], **stages}})


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
