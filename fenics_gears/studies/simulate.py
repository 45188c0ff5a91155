"""`simulate` as users call it: run a scene; where it has a target, choose its settings first and add the estimated error to the result."""

from __future__ import annotations

import time
import tomllib
from dataclasses import asdict, replace
from typing import TYPE_CHECKING

import xarray as xr

from fenics_gears.elasticity.cache import Cache
from fenics_gears.inputs.written import as_toml
from fenics_gears.results.attributes import ESTIMATED
from fenics_gears.scene.data import Accuracy, Scene
from fenics_gears.simulation import simulate as simulation
from fenics_gears.simulation.routes import Preparation
from fenics_gears.studies.fields import changed
from fenics_gears.system.progress import Progress, SilentProgress

if TYPE_CHECKING:
    from fenics_gears.results.journal import Place

# The remedy where a warning recommends a setting, for settings may not stand beside a target.
OTHER_SETTINGS = "a warning names settings of [accuracy]: take a smaller target, or the chosen settings, which the result's scene has, and change them"
LENGTHS = ("flank_element_size", "body_element_size", "contact_length")


def simulate(
    scene: Scene,
    *,
    progress: Progress | None = None,
    cache: Cache | None = None,
    preparation: Preparation | None = None,
    comm=None,
    journal: Place | None = None,
) -> xr.Dataset:
    """Run a scene and return its result (docs/result.md).

    With `[accuracy] target` settings are chosen first, by trial runs. The result then has the attributes `target`, `estimated_error`, and
    `estimated_error: ...` by setting, all in parts of 1, `time_choose` (s), `target_runs`, `target_remarks`; the scene that it carries has the
    settings in place of the target, so that it repeats the run. Arguments, results and errors are those of `simulation.simulate.simulate`;
    with a target also TargetNotReached.
    """
    arguments = {"progress": progress or SilentProgress(), "cache": cache, "preparation": preparation, "comm": comm, "journal": journal}
    target = scene.accuracy.target
    if target is None:
        return simulation.simulate(scene, **arguments)
    from fenics_gears.studies.accuracy_target.choose import choose

    begun = time.perf_counter()
    chosen = choose(scene, target, arguments["progress"])
    seconds = time.perf_counter() - begun
    result = simulation.simulate(with_settings(scene, chosen.accuracy), **arguments)
    remark = OTHER_SETTINGS if "accuracy." in result.attrs["warnings"] else ""
    parts = {f"{ESTIMATED}{name}": part for name, part in chosen.parts.items()}
    how = {"target_runs": chosen.runs, "target_remarks": remark, "time_choose": seconds}
    if chosen.accuracy.slices:
        how |= {"slices": chosen.accuracy.slices, "layers": chosen.accuracy.layers}
    return result.assign_attrs({"target": target, "estimated_error": chosen.estimated_error, **parts, **how})


def with_settings(scene: Scene, accuracy: Accuracy) -> Scene:
    """The scene with settings written out, in its text too where it has one."""
    text = ""
    if scene.text:
        settings = {name: f"{float(value)!r} mm" if name in LENGTHS else value for name, value in asdict(accuracy).items() if value is not None}
        text = as_toml(changed(tomllib.loads(scene.text), ("accuracy",), settings))
    return replace(scene, accuracy=accuracy, text=text)
