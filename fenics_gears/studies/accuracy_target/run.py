"""A run of a scene with `[accuracy] target`: choose settings, run the scene with them, add the estimated error to the result's attributes."""

from __future__ import annotations

import time
import tomllib
from dataclasses import asdict, replace

import xarray as xr

from fenics_gears.inputs.written import as_toml
from fenics_gears.results.attributes import ESTIMATED
from fenics_gears.scene.data import Accuracy, Scene
from fenics_gears.simulation.simulate import simulate
from fenics_gears.studies.accuracy_target.choose import Chosen, choose
from fenics_gears.studies.fields import changed
from fenics_gears.system.progress import Progress

# The remedy where a warning recommends a setting, for settings may not stand beside a target.
OTHER_SETTINGS = "a warning names settings of [accuracy]: take a smaller target, or the chosen settings, which the result's scene has, and change them"
LENGTHS = ("flank_element_size", "body_element_size", "contact_length")


def simulate_to_target(scene: Scene, *, progress: Progress, **arguments) -> xr.Dataset:
    """As `simulate`, which it calls with `arguments`; attributes `target`, `estimated_error`, and `estimated_error: ...` by setting, all in
    parts of 1, `time_choose` (s), `target_runs`, `target_remarks`. The scene that the result carries has the settings in place of the
    target, so that it repeats the run.

    Raises TargetNotReached, and what `simulate` raises.
    """
    begun = time.perf_counter()
    chosen = choose(scene, scene.accuracy.target, progress)
    seconds = time.perf_counter() - begun
    result = simulate(with_settings(scene, chosen.accuracy), progress=progress, **arguments)
    return result.assign_attrs(_attributes(scene.accuracy.target, chosen, result.attrs["warnings"]), time_choose=seconds)


def with_settings(scene: Scene, accuracy: Accuracy) -> Scene:
    """The scene with settings written out, in its text too where it has one."""
    text = ""
    if scene.text:
        settings = {name: _written(name, value) for name, value in asdict(accuracy).items() if value is not None}
        text = as_toml(changed(tomllib.loads(scene.text), ("accuracy",), settings))
    return replace(scene, accuracy=accuracy, text=text)


def _written(name: str, value):
    return f"{float(value)!r} mm" if name in LENGTHS else value


def _attributes(target: float, chosen: Chosen, warnings: str) -> dict:
    remarks = chosen.remarks + ((OTHER_SETTINGS,) if "accuracy." in warnings else ())
    parts = {f"{ESTIMATED}{name}": part for name, part in chosen.parts.items()}
    how = {"target_runs": chosen.runs, "target_remarks": "\n".join(remarks)}
    return {"target": target, "estimated_error": chosen.estimated_error, **parts, **how}
