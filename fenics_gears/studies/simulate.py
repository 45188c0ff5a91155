"""`simulate` as users call it: run a scene; where it has a target, choose its settings first and add the estimated
error to the result."""

from __future__ import annotations

import time
from dataclasses import replace
from typing import TYPE_CHECKING

import xarray as xr

from fenics_gears.elasticity.cache import Cache
from fenics_gears.results.attributes import ESTIMATED
from fenics_gears.scene.data import Scene
from fenics_gears.simulation import simulate as simulation
from fenics_gears.simulation.routes import Preparation
from fenics_gears.system.job import Job
from fenics_gears.system.progress import Progress, SilentProgress

if TYPE_CHECKING:
    from fenics_gears.results.journal import Place

# The remedy where a warning recommends a setting, for settings may not stand beside a target.
OTHER_SETTINGS = (
    "a warning names settings of [accuracy]: take a smaller target, or the chosen settings, which the result's scene"
    " has, and change them"
)


def simulate(
    scene: Scene,
    *,
    progress: Progress | None = None,
    cache: Cache | None = None,
    preparation: Preparation | None = None,
    job: Job | None = None,
    journal: Place | None = None,
) -> xr.Dataset:
    """Run a scene and return its result, an `xarray.Dataset` (docs/result.md).

    Its variables, over time, tooth pairs and contact nodes, have their units as `attrs["units"]`: rotations and the
    transmission error are in rad, displacements in mm, forces in N, pressures and stresses in MPa, torques and energies
    in N mm, times in s. Numbers of the whole run, such as `mean_transmission_error` (rad), the warnings, and the text
    of the scene that was run are in `result.attrs`.

    With `[accuracy] target` settings are chosen first, by trial runs. The result then has the attributes `target`,
    `estimated_error`, and `estimated_error: ...` by setting, all in parts of 1, `time_choose` (s), `target_runs`,
    `target_remarks`. The scene that it carries has the settings in place of the target, so that it repeats the run.

    scene: from `load_scene` or `build_scene`, as it is or changed by `dataclasses.replace`.
    progress: is told the stages and how far they are (`system.progress`); nothing is shown unless given.
    cache: where condensed gears are kept (`elasticity.cache.Cache`); that of the user unless given.
    preparation: what many runs share (`simulation.simulate.simulate`).
    job: the MPI processes that share the run (`system.job`).
    journal: where steps are written while the run goes on (`results.journal`).

    Raises GeometryError before any computation where the gears are impossible; ComputationError where the run does not
    fit into the memory that it may take, or a stage fails: steps that were computed before are then in its attribute
    `partial`; TargetNotReached where no settings keep the target. Ctrl-C during the march returns the steps computed so
    far, with the attribute `complete` 0.

    >>> from fenics_gears import load_scene, simulate
    >>> result = simulate(load_scene("demos/lundvall2004.toml"))
    >>> result.transmission_error.dims, result.transmission_error.attrs["units"]
    (('time',), 'rad')
    >>> length = result.transmission_error * result.attrs["base_radius_wheel"]
    >>> print(f"{length.max().item():.2f} mm along the line of action at most")
    0.16 mm along the line of action at most
    """
    arguments = {
        "progress": progress or SilentProgress(),
        "cache": cache,
        "preparation": preparation,
        "job": job,
        "journal": journal,
    }
    target = scene.accuracy.target
    if target is None:
        return simulation.simulate(scene, **arguments)
    from fenics_gears.studies.accuracy_target.choose import choose

    begun = time.perf_counter()
    chosen = choose(scene, target, arguments["progress"])
    seconds = time.perf_counter() - begun
    result = simulation.simulate(replace(scene, accuracy=chosen.accuracy), **arguments)
    remark = OTHER_SETTINGS if "accuracy." in result.attrs["warnings"] else ""
    parts = {f"{ESTIMATED}{name}": part for name, part in chosen.parts.items()}
    how = {"target_runs": chosen.runs, "target_remarks": remark, "time_choose": seconds}
    if chosen.accuracy.slices:
        how |= {"slices": chosen.accuracy.slices, "layers": chosen.accuracy.layers}
    return result.assign_attrs({"target": target, "estimated_error": chosen.estimated_error, **parts, **how})
