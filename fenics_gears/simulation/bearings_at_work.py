"""Rolling bearings and contact in balance: runs repeated until bearings are as stiff as the mean load of the run makes
them."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import xarray as xr

from fenics_gears.dynamics.march import March
from fenics_gears.dynamics.shaft_at_work import even_load
from fenics_gears.errors import ComputationError
from fenics_gears.inputs.tree import GEARS
from fenics_gears.model.drivetrain import drivetrain
from fenics_gears.model.model import Model
from fenics_gears.results.bent_shafts import OF_GEARS
from fenics_gears.results.recorder import Recorder

# Change of a gear's mean load from one run to the next, in parts of its force (moments over the face width), that ends
# them; and their largest number.
SAME, MOST_RUNS = 3e-5, 20
# Largest factor from step to step that is reckoned with, and a square of a step that is none.
FASTEST, TINY = 0.8, 1e-300
# What a run that is repeated is called among the stages.
AGAIN = "march, bearings as loaded"

Marched = tuple[Recorder, March]


class NoBalance(ComputationError):
    """Loads go on changing from run to run; `marched`: the last of them, `partial`: its result."""

    marched: Marched
    partial: xr.Dataset


def with_bearings_at_work(model: Model, marched: Callable[..., Marched]) -> Marched:
    """The run of a model whose bearings have the stiffness that they have under its own mean load. Raises
    NoBalance where loads go on changing."""
    shafts, size = model.drivetrain.elastic, np.array([1.0, 1.0, 1.0, *[1.0 / model.pair.face_width] * 2])
    loads = np.array([even_load(each, model.pair, model.scene.load.wheel_torque) for each in shafts])
    last = np.zeros_like(loads)
    for number in range(MOST_RUNS):
        recorder, march = marched(model, *([AGAIN] if number else []))
        if march.interrupted:
            return recorder, march
        recorder.finish()
        found = mean_loads(model, recorder)
        step = (found - loads) * size
        change = float(np.max(np.linalg.norm(step, axis=1) / np.linalg.norm(found[:, :3], axis=1)))
        if change <= SAME:
            return recorder, march
        # Steps go down by nearly one factor, whose series is summed up.
        factor = float(np.clip((step * last).sum() / max((last**2).sum(), TINY), -FASTEST, FASTEST))
        loads, last = found + factor / (1.0 - factor) * step / size, step
        own = dict(zip((each.gear for each in shafts), loads))
        model = replace(model, drivetrain=drivetrain(model.scene, model.pair, own))
    failure = NoBalance(
        f"rolling bearings: after {MOST_RUNS} runs the mean load of a gear on its shaft still changes by"
        f" {change:.2g} of itself from run to run. Take a smaller clearance, a preload or a larger torque"
    )
    failure.marched = recorder, march
    raise failure


def mean_loads(model: Model, recorder: Recorder) -> np.ndarray:
    """Mean loads (shafts, 5) of gears on their elastic shafts over a recorded run."""
    motions = np.stack([recorder.arrays[name][1:].mean(axis=0) for name in OF_GEARS])
    return np.array([each.stiffness @ motions[:, GEARS.index(each.gear)] for each in model.drivetrain.elastic])
