"""Trial runs of meshes of a train that are computed together, for `[accuracy] target`: sizes grow in all stages at
once, and each mesh is judged as its pair."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from math import ceil, inf
from typing import Any

import xarray as xr

from fenics_gears.elasticity.cache import Cache
from fenics_gears.errors import GearsError
from fenics_gears.model.row_model import RowModel
from fenics_gears.model.train import row_of
from fenics_gears.model.train_cost import row_cost
from fenics_gears.model.train_parts import whole_steps
from fenics_gears.scene.accuracy import Accuracy
from fenics_gears.scene.train_mesh import MeshOfScene
from fenics_gears.scene.train_scene import TrainScene
from fenics_gears.simulation.train import solved_row
from fenics_gears.system.progress import Progress

from .measures import judged_answer
from .setting import body_size
from .target import Chosen, chosen_by
from .trial_runs import ROUND_STEPS, Sizes, TargetNotReached, Trials, check_sizes


def stage_of(mesh: MeshOfScene) -> str:
    return mesh.name.partition(":")[0]


@dataclass(frozen=True)
class SettingOfRow:
    """The `[accuracy]` of each stage, by name."""

    of_stages: tuple[tuple[str, Accuracy], ...]

    def of(self, train: TrainScene) -> TrainScene:
        """A train with these; stages without one keep theirs."""
        known = dict(self.of_stages)
        return train.with_accuracy(lambda mesh: known.get(stage_of(mesh), mesh.scene.accuracy))

    @property
    def words(self) -> str:
        return "; ".join(
            f"{name}: flank elements {own.flank_element_size:.3g} mm, body elements {own.body_element_size:.3g} mm,"
            f" {own.steps_per_mesh_cycle} steps" + (f", {own.slices} slices" if own.slices else "")
            for name, own in self.of_stages
        )


def chosen_of_row(
    train: TrainScene, numbers: Sequence[int], target: float, cache: Cache | None, progress: Progress
) -> Chosen:
    """As `target.choose`, for the meshes of these numbers of a train; the setting is a SettingOfRow."""
    return chosen_by(partial(TrialsOfRow, train, numbers, cache), target, progress)


class TrialsOfRow(Trials):
    """Of the meshes of these `numbers` of a train; steps count those of the mesh with fewest, others have more in
    proportion. Contact windows are those of the defaults. Their peak-to-peak values are those at steps."""

    def __init__(
        self, train: TrainScene, numbers: Sequence[int], cache: Cache | None, begun: Callable[[str], None],
        tick: Callable[[], None] | None = None,
    ):  # fmt: skip
        self._train = train.with_accuracy(lambda mesh: Accuracy())
        self._numbers = numbers
        self._cache = cache
        self._usual = row_of(self._train, numbers)
        self._fewest = min(whole_steps(self._usual.meshes, [1] * len(numbers)))
        self.step_unit = 2 * self._fewest * ceil(ROUND_STEPS / (2 * self._fewest))
        super().__init__(self._usual.models, row_cost, self._usual.drivetrain.mass is not None, True, begun, tick)

    def setting(self, sizes: Sizes) -> SettingOfRow:
        found: dict[str, Accuracy] = {}
        for mesh, model in zip(self._usual.meshes, self.models):
            resolution = model.resolution
            body = body_size(resolution.order, bool(self.slices)) * mesh.scene.gears.module
            other = found.get(stage_of(mesh), Accuracy(flank_element_size=inf, body_element_size=inf))
            found[stage_of(mesh)] = Accuracy(
                element=resolution.element,
                flank_element_size=min(sizes.mesh * resolution.flank_element_size, other.flank_element_size),
                body_element_size=min(sizes.mesh * body, other.body_element_size),
                steps_per_mesh_cycle=self._fewest * ceil(sizes.steps / self._fewest),
                slices=sizes.slices or self.slices or None,
                layers=max(model.slices_and_layers[1], other.layers or 0) if self.slices else None,
            )
        return SettingOfRow(tuple(found.items()))

    def _with_window_long_enough(self, sizes: Sizes) -> None:
        """Windows are as wide as meshes together may need by their loads."""

    def _model(self, sizes: Sizes) -> RowModel:
        setting = self.setting(sizes)
        modules = {stage_of(mesh): mesh.scene.gears.module for mesh in self._usual.meshes}
        for name, accuracy in setting.of_stages:
            check_sizes(setting.words, accuracy, modules[name])
        try:
            return row_of(setting.of(self._train), self._numbers)
        except GearsError as error:
            raise TargetNotReached(f"{setting.words}: {error}") from None

    def _run(self, setting: SettingOfRow, progress: Progress) -> Any:
        found = solved_row(row_of(setting.of(self._train), self._numbers), progress, self._cache)
        runs = [xr.Dataset(each.variables, attrs=each.numbers) for each in found]
        self._answers[setting] = tuple(map(judged_answer, runs))
