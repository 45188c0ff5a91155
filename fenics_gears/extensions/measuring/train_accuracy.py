"""What the settings of a train cost whose meshes are computed together: each made finer alone, in all meshes at once.

How much a number then changes is how much of its error that setting leaves, or more: of a setting whose error falls
with its first power half of the error is left, of one with the second power a quarter. Quickly each is made coarser in
place of finer: the change is as large as the error, or larger."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

from fenics_gears import ComputationError, GearsError, simulate_train
from fenics_gears.many_runs import Progress
from fenics_gears.measuring import Accuracy, Cache, Model, compile_kernels, own_setting
from fenics_gears.shown import train_model_of

from .machine import machine
from .train_rows import Row, TrainReport, numbers_of

OWN = "as they stand"
WHAT = "one setting finer in all meshes"
WHAT_QUICKLY = "one setting coarser in all meshes"


def measure(train, progress: Progress, quick: bool = False) -> TrainReport:
    """Run a train as it stands and with each setting finer, or `quick` coarser; seconds are of runs with gears of their
    own. Raises SceneError, GeometryError, and ComputationError where it does not run as it stands."""
    progress.stage("compile")
    compile_kernels(any(mesh.scene.friction is not None for mesh in train.meshes), progress=progress)
    models = {mesh.name: model for mesh, model in zip(train.meshes, train_model_of(train).models)}
    of_setting = {OWN: train.with_accuracy(lambda mesh: _accuracy(mesh.scene.accuracy, models[mesh.name]))}
    for name in _changes(next(iter(models.values())), quick):
        of_setting[name] = train.with_accuracy(
            lambda mesh, name=name: _accuracy(
                mesh.scene.accuracy, models[mesh.name], _changes(models[mesh.name], quick)[name]
            )
        )
    progress.stage("settings")
    rows: list[Row] = []
    failures = []
    for name in progress.counted(list(of_setting), str):
        try:
            rows.append(_row(name, of_setting[name], of_setting[OWN]))
        except GearsError as error:
            if not rows:
                raise ComputationError(f"the train does not run as it stands: {error}") from error
            failures.append((name, str(error).splitlines()[0]))
    what = WHAT_QUICKLY if quick else WHAT
    return TrainReport(train.title, what, "time", tuple(rows), tuple(failures), machine())


def _row(name: str, changed, own) -> Row:
    """The run of a train with changed settings."""
    if name != OWN:
        resolved = [[model.resolution for model in train_model_of(each).models] for each in (changed, own)]
        slices = [[model.slices_and_layers for model in train_model_of(each).models] for each in (changed, own)]
        if resolved[0] == resolved[1] and slices[0] == slices[1]:
            raise ComputationError("the train has no such setting: steps of all meshes are of one length")
    with TemporaryDirectory() as folder:
        begun = time.perf_counter()
        found = simulate_train(changed, cache=Cache(Path(folder)))
        return Row(name, time.perf_counter() - begun, numbers_of(found), "" if name == OWN else OWN)


def _changes(model: Model, quick: bool) -> dict[str, dict[str, float]]:
    """By row, which settings of a mesh are finer than as they stand, or coarser."""
    setting = own_setting(model.scene)
    body = setting.accuracy(model.scene.gears.module).body_element_size
    often, size = ("half", "twice") if quick else ("twice", "half")
    times = 0.5 if quick else 2.0
    counts = {"steps_per_mesh_cycle": setting.steps} | ({"slices": setting.slices} if setting.slices else {})
    sizes = {"flank_element_size": setting.flank, "body_element_size": body}
    return {
        **{f"{often} the {name.partition('_')[0]}": {name: max(int(times * own), 2)} for name, own in counts.items()},
        **{f"{name.partition('_')[0]} elements {size} as large": {name: own / times} for name, own in sizes.items()},
    }


def _accuracy(own: Accuracy, model: Model, changed: Mapping[str, float] | None = None) -> Accuracy:
    """The accuracy of a mesh in a row. Steps and flank elements stay as they were decided where they are not
    changed."""
    decided = {
        "steps_per_mesh_cycle": model.resolution.steps_per_mesh_cycle,
        "flank_element_size": model.resolution.flank_element_size,
    }
    return replace(own, **decided | dict(changed or {}))
