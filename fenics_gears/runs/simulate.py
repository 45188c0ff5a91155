"""A run from its scene to its result: its settings are settled, then it is simulated."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import xarray as xr

from fenics_gears.elasticity.cache import Cache
from fenics_gears.errors import MemoryEnded, SceneError
from fenics_gears.model.model import Model
from fenics_gears.results.dataset import RunResult
from fenics_gears.scene.data import Scene
from fenics_gears.scene.write import refuse_wrong
from fenics_gears.simulation.compiled_ahead import compile_loops
from fenics_gears.simulation.routes import Preparation
from fenics_gears.simulation.simulate import solved, with_lead_correction
from fenics_gears.system.job import Job
from fenics_gears.system.progress import Progress, SilentProgress

if TYPE_CHECKING:
    from fenics_gears.results.journal import JournalPlace

# The remedy where a warning recommends a setting, for a scene may not have both settings and a target.
OTHER_SETTINGS = (
    "a warning names settings of [accuracy]: take a smaller target, or change the chosen settings, which the result's"
    " scene has"
)
Keep = Callable[[xr.Dataset], None]


def simulate(
    scene: Scene | Model,
    *,
    progress: Progress | None = None,
    cache: Cache | None = None,
    preparation: Preparation | None = None,
    job: Job | None = None,
    journal: JournalPlace | None = None,
    keep: Keep | None = None,
) -> xr.Dataset:
    """Run a scene and return its result, an `xarray.Dataset` (docs/result.md).

    Its variables, over time, tooth pairs and contact nodes, have their units as `attrs["units"]`: rotations and the
    transmission error are in rad, displacements in mm, forces in N, pressures and stresses in MPa, torques and energies
    in N mm, times in s. Numbers of the whole run, such as `mean_transmission_error` (rad), the warnings, and the text
    of the scene that was run are in `result.attrs`.

    With `[accuracy] target` settings are chosen first, by trial runs. The result then has the attributes `target`,
    `estimated_error`, and `estimated_error: ...` by setting, all in parts of 1, `time_choose` (s), `target_runs`,
    `target_remarks`. Its scene has the settings in place of the target, so that it repeats the run.

    scene: from `load_scene` or `build_scene`, as it is or changed by `dataclasses.replace`; or its `model_of`.
    progress: is told the stages and how far they are (`system.progress`); nothing is shown unless given.
    cache: where condensed gears are kept (`elasticity.cache.Cache`); that of the user unless given.
    preparation: what comes before the march, `prepared` unless given; `runs.gear_store` has one for runs that share
        gears and contact operators.
    job: of rank 0, whose ranks share the remeshing of `condensation = "every step"`.
    journal: where a march that lasts longer than a few seconds is written down as it goes (`results.journal`); the
        caller removes it.
    keep: is given the result as soon as the march ends. What follows, dynamic factors and proposed lead modifications,
        may fail: a warning then says so, and the attribute `failed_afterwards` names it.

    Raises SceneError before any computation where a scene was changed to values that no scene file may have,
    GeometryError where the gears are impossible, and TargetNotReached where no settings
    keep the target. Raises ComputationError where the run does not fit into the memory that it may take, or a stage
    fails: the steps before are in its attribute `partial`. Ctrl-C during the march returns the steps computed so far,
    with the attribute `complete` 0.

    >>> from fenics_gears import load_scene, simulate
    >>> result = simulate(load_scene("demos/lundvall2004.toml"))
    >>> result.transmission_error.dims, result.transmission_error.attrs["units"]
    (('time',), 'rad')
    >>> mm = result.transmission_error.max().item() * result.attrs["base_radius_wheel"]
    >>> print(f"{mm:.2f} mm along the line of action at most")
    0.16 mm along the line of action at most
    """
    progress = progress or SilentProgress()
    result = settled_run(
        scene, progress, keep, cache=cache, preparation=preparation, job=job, journal=journal
    )  # fmt: skip
    return with_lead_correction(result, progress)


def settled_run(scene: Scene | Model, progress: Progress, keep: Keep | None = None, **options: Any) -> RunResult:
    """As `simulate`, without proposed lead modifications; `options` are those of `solved`."""
    chosen = settled(scene, progress)

    def ended(result: RunResult) -> None:
        chosen.describe(result)
        if keep is not None:
            keep(result.dataset)

    return solved(chosen.scene, progress=progress, ended=ended, **options)


@dataclass(frozen=True)
class SettledScene:
    """A scene, or its model, with settled settings; `chosen`: attributes of the result on their choice, none where the
    scene has its own."""

    scene: Scene | Model
    chosen: dict[str, Any] = field(default_factory=dict)

    def describe(self, result: RunResult) -> None:
        """Give the result these attributes."""
        if self.chosen:
            remarks = OTHER_SETTINGS if "accuracy." in result.attrs["warnings"] else ""
            result.attrs.update(self.chosen, target_remarks=remarks)


def settled(scene: Scene | Model, progress: Progress) -> SettledScene:
    """The scene with settings in place of its target, where it has one; raises TargetNotReached where none keep it."""
    known = scene.scene if isinstance(scene, Model) else scene
    if not isinstance(known, Scene):
        raise SceneError(
            f"simulate takes the scene of a pair, from load_scene, not an object of type {type(known).__name__}. A"
            " train is read by load_train and run by simulate_train"
        )
    refuse_wrong(known)
    target = known.accuracy.target
    if target is None:
        return SettledScene(scene)
    from .settings.target import choose

    begun = time.perf_counter()
    try:
        compile_loops(progress)
        settings = choose(known, target, progress)
    except MemoryError:
        raise MemoryEnded("before the run was over") from None
    accuracy = settings.setting.accuracy(known.gears.module)
    how = settings.attributes(target) | {"target_remarks": "", "time_choose": time.perf_counter() - begun}
    if accuracy.slices:
        how |= {"slices": accuracy.slices, "layers": accuracy.layers}
    return SettledScene(replace(known, accuracy=accuracy), how)
