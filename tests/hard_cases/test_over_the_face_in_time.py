"""Rows 4, 17, 23 and 24 over the face: gears with inertia that tilt; bodies without finite elements."""

from dataclasses import replace

import numpy as np
import pytest
from tests.hard_cases.invariants import Run, cycle_of
from tests.hard_cases.test_any_scene import obeys_the_laws
from tests.hard_cases.test_over_the_face_static import run
from tests.helical import BEARINGS, CROWNED, FRICTION, INERTIA, SHAFTS, helical_scene, on_stand_in_bodies

from fenics_gears import model_of
from fenics_gears.dynamics.march import Marcher
from fenics_gears.results.dataset import RunResult
from fenics_gears.results.recorder import Recorder

DAMPED = INERTIA + '\n[damping]\nstiffness_proportional = "3e-6 s"\nmass_proportional = "500 1/s"\n'
FEW = "slices = 4\ncontact_nodes = 9\nsteps_per_mesh_cycle = 16"
BY_NIGHT = pytest.mark.nightly
BOTH = "\n[coast_flanks]\n"


def with_torque(more, part, **changes):
    """A run whose load is multiplied by `part(step)`; it starts in equilibrium under the whole load."""
    model = model_of(helical_scene(more, **{"accuracy": FEW, **changes}))
    cycle, load = cycle_of(model, on_stand_in_bodies(model)), (lambda step: (part(step) - 1.0) * model.drivetrain.load,)
    marcher, recorder = (
        Marcher(cycle, replace(model.equations_of_motion, loads=load)),
        Recorder(model, cycle, loads=load),
    )
    march = marcher.run(model.steps, model.steps + 1, observe=recorder.take)
    return Run(model, marcher, list(march.records), RunResult(recorder, march).dataset)


@pytest.mark.parametrize(
    "more",
    [
        pytest.param(INERTIA + FRICTION + SHAFTS, marks=BY_NIGHT),
        pytest.param(INERTIA + BEARINGS, marks=BY_NIGHT),
        DAMPED + BEARINGS + SHAFTS + FRICTION,
    ],
    ids=["shafts", "bearings", "whole drivetrain"],
)
def test_account_of_energy_closes(more, measured):
    """Row 4. Exact identity, the geometry moving."""
    result = run(more + CROWNED, accuracy=FEW).result
    works = {name: result[name].values for name in result if name.startswith("work_")}
    gained = result["energy"].values - result["energy"].values[0]
    balance = (
        works["work_input"]
        - works["work_output"]
        - works.get("work_damping", 0.0)
        - works.get("work_friction", 0.0)
        + works["work_contact_changes"]
    )
    scale = max(np.abs(value).max() for value in works.values())
    defect = float(np.abs(gained - balance).max() / scale)
    measured("a run with inertia: defect of the account of energy / largest work", defect, 1e-9, row=4)


@pytest.mark.parametrize("hand", [pytest.param("right", marks=BY_NIGHT), "left"])
def test_torque_reversed_while_running(hand, measured):
    """Row 17. The teeth part, cross the backlash, touch on their coast flanks and come back; axial forces turn round
    with the flank; laws hold."""
    found = with_torque(DAMPED + BOTH + BEARINGS, lambda step: -1.0 if 20 <= step < 100 else 1.0, hand=hand, cycles=10)
    result, sign = found.result, 1.0 if hand == "right" else -1.0
    penetration = obeys_the_laws(found)
    driving, coasting = result["normal_force"].values > 0.0, result["coast_normal_force"].values > 0.0
    free = ~driving & ~coasting
    axial = sign * result["reaction_z"].sel(gear="pinion").values
    measured(
        "reversal while running: steps on drive flanks, on coast flanks, in free flight",
        f"{driving.sum()}, {coasting.sum()}, {free.sum()} of {len(free)}",
        "all occur",
        row=17,
    )
    measured("reversal while running: largest penetration", penetration, "1e-4 um", "um", row=17)
    assert driving[:20].all() and coasting[20:110].any() and free.any() and driving[-20:].any()
    assert (
        np.all(axial[driving & ~coasting] > 0.0)
        and np.all(axial[coasting & ~driving] < 0.0)
        and np.abs(axial[free]).max() == 0.0
    )
    assert "lose contact" in result.attrs["warnings"]


def test_sudden_release(measured):
    """Row 17. Exact: without load and contact the wheel flies at constant speed; the result says that contact is
    lost."""
    found = with_torque(INERTIA + BOTH, lambda step: 0.0 if step >= 4 else 1.0, cycles=2)
    obeys_the_laws(found)
    result = found.result
    free = (result["normal_force"].values == 0.0) & (result["coast_normal_force"].values == 0.0)
    speeds = [record.state.velocity for record in found.records]
    pairs = [(a, b) for a, b, one, other in zip(speeds, speeds[1:], free, free[1:]) if one and other]
    changed = max((float(np.abs(b - a).max() / np.abs(a).max()) for a, b in pairs), default=np.inf)
    measured("released suddenly: change of speed in a step of free flight", changed, 1e-12, row=17)
    assert len(pairs) > 2 and "lose contact" in result.attrs["warnings"]
