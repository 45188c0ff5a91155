"""Rolling bearings and contact in balance: runs repeated until bearings are as stiff as the mean load of the run makes
them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np

from fenics_gears.dynamics.rolling_bearing import even_load
from fenics_gears.errors import ComputationError
from fenics_gears.inputs.tree import GEARS
from fenics_gears.model.drivetrain import drivetrain
from fenics_gears.model.model import Model
from fenics_gears.results.bent_shafts import OF_GEARS
from fenics_gears.results.dataset import RunResult
from fenics_gears.results.recorder import Recorder

# Change of a gear's mean load from one run to the next, in parts of its force (moments over the face width), that ends
# them; and their largest number.
SAME, MOST_RUNS = 1e-4, 20
# What a run that is repeated is called among the stages.
AGAIN = "march, bearings as loaded"

Loads = Mapping[str, np.ndarray]
Recorded = tuple[Recorder, RunResult]


def with_bearings_at_work(model: Model, recorded: Callable[..., Recorded]) -> Recorded:
    """The run of a model whose bearings have the stiffness that they have under its own mean load.

    Raises ComputationError where loads go on changing.
    """
    torque = model.scene.load.wheel_torque
    before = {each.gear: even_load(each, model.pair, torque) for each in model.drivetrain.elastic}
    for number in range(MOST_RUNS):
        run = recorded(model, *([AGAIN] if number else []))
        if not run[1].attrs["complete"]:
            return run
        loads = mean_loads(model, run[1])
        change = max(_apart(loads[gear], before[gear], model.pair.face_width) for gear in loads)
        if change <= SAME:
            return run
        before, model = loads, replace(model, drivetrain=drivetrain(model.scene, model.pair, loads))
    raise ComputationError(
        f"rolling bearings: after {MOST_RUNS} runs the mean load of a gear on its shaft still changes by"
        f" {change:.2g} of itself from run to run, since bearings with so much clearance carry now here, now there."
        " Take a smaller clearance, a preload or a larger torque"
    )


def mean_loads(model: Model, result: RunResult) -> dict[str, np.ndarray]:
    """Mean loads (5,) of "pinion" and "wheel" on their elastic shafts over a run."""
    motions = np.stack([result[name][1:].mean(axis=0) for name in OF_GEARS])
    return {each.gear: each.stiffness @ motions[:, GEARS.index(each.gear)] for each in model.drivetrain.elastic}


def _apart(load: np.ndarray, other: np.ndarray, width: float) -> float:
    size = np.array([1.0] * 3 + [1.0 / width] * 2)
    return float(np.linalg.norm(size * (load - other)) / np.linalg.norm(size[:3] * load[:3]))
