"""What the effects of a train cost and change whose meshes are computed together: the train bare, with each effect
alone, with all but each, and with all."""

from __future__ import annotations

import statistics
from dataclasses import replace

from fenics_gears import ComputationError, GearsError, simulate_train
from fenics_gears.many_runs import Progress
from fenics_gears.measuring import Accuracy, Model, compile_kernels
from fenics_gears.shown import train_model_of

from .effect_costs.subsets import ALL, ALONE, BARE, LEFT_OUT, Subset, subsets_of
from .effect_costs.train_subsets import EffectsOfTrain
from .machine import machine
from .train_rows import Row, TrainReport, numbers_of

WHAT = "effects, one more than the bare train and one less than all"
ROUNDS = 3
COMPARED = {ALONE: BARE, LEFT_OUT: ALL}


def measure(train, progress: Progress, rounds: int = ROUNDS) -> TrainReport:
    """Run the subsets of a train's effects in turns, all with the steps and the flank elements of the whole; seconds
    are the median of their marches. Raises SceneError, GeometryError, and ComputationError where none runs."""
    progress.stage("compile")
    for tangential in (False, True):
        compile_kernels(tangential, progress=progress)
    subsets, skipped = subsets_of(EffectsOfTrain(train))
    left = [(each.name, each.reason) for each in skipped]
    models = {mesh.name: model for mesh, model in zip(train.meshes, train_model_of(train).models)}
    seconds: dict[str, list[float]] = {subset.name: [] for subset in subsets}
    numbers: dict[str, dict[str, float]] = {}
    progress.stage("march")
    for subset in progress.counted(subsets * rounds, lambda subset: subset.name):
        if subset.name not in seconds:
            continue
        try:
            found = simulate_train(subset.scene.with_accuracy(lambda mesh: _as_whole(mesh.scene, models[mesh.name])))
        except GearsError as error:
            left.append((subset.name, str(error).splitlines()[0]))
            del seconds[subset.name]
            continue
        numbers.setdefault(subset.name, numbers_of(found))
        seconds[subset.name].append(found.attrs["time_march"])
    rows = tuple(
        Row(each.name, statistics.median(seconds[each.name]), numbers[each.name], _compared(each))
        for each in subsets
        if each.name in numbers
    )
    if not rows:
        raise ComputationError("no subset of the effects could be run: " + "; ".join(f"{n}: {why}" for n, why in left))
    return TrainReport(train.title, WHAT, "march", rows, tuple(left), machine())


def _compared(subset: Subset) -> str:
    return COMPARED.get(subset.kind, "")


def _as_whole(scene, model: Model) -> Accuracy:
    """The accuracy of a mesh with the settings of the whole train."""
    resolution = model.resolution
    slices, layers = model.slices_and_layers if scene.three_dimensional else (None, None)
    return replace(
        scene.accuracy,
        element=resolution.element,
        flank_element_size=resolution.flank_element_size,
        steps_per_mesh_cycle=resolution.steps_per_mesh_cycle,
        slices=slices,
        layers=layers,
    )
