"""Rolling bearings of shafts that bend, in a whole run on bodies without finite elements."""

import numpy as np
import pytest
from tests.elastic_shaft_scenes import ELASTIC, FEW, OUTPUT, ROLLING, WHEEL
from tests.hard_cases.invariants import cycle_of
from tests.helical import helical_scene, on_stand_in_bodies

from fenics_gears import model_of
from fenics_gears.dynamics.march import Marcher
from fenics_gears.dynamics.rolling_bearing import reaction
from fenics_gears.dynamics.shaft_at_work import even_load
from fenics_gears.results.dataset import RunResult
from fenics_gears.results.recorder import Recorder
from fenics_gears.simulation.bearings_at_work import mean_loads, with_bearings_at_work


def test_rolling_bearings_carry_by_their_law_in_the_run():
    """The bearings' own law at the shaft's mean motions."""
    model = model_of(helical_scene(ROLLING + OUTPUT + WHEEL, offset=2.0, accuracy=FEW))
    bodies = on_stand_in_bodies(model)
    shaft = model.drivetrain.elastic[0]

    def marched(model, stage=""):
        recorder = Recorder(model, cycle_of(model, bodies))
        return recorder, Marcher(recorder.cycle, model.equations_of_motion).run(model.steps, 1, observe=recorder.take)

    recorder, march = with_bearings_at_work(model, marched)
    model, result = recorder.model, RunResult(recorder, march).dataset
    assert result.attrs["largest_rolling_element_force"] > 0.0
    working = model.drivetrain.elastic[0]
    gear = np.linalg.solve(working.stiffness, mean_loads(model, recorder)[0])
    for number, motion in enumerate((working.at_bearings @ gear).reshape(2, 5)):
        law = reaction(shaft.bearings[number].rolling, motion).loads
        for axis, load in zip("xyz", law):
            found = result[f"bearing_force_{axis}"].values[1:, number].mean()
            assert abs(found - load) <= 2e-4 * np.abs(law[:3]).max()


@pytest.mark.parametrize("torque", [3e5, -3e5], ids=["drive", "coast"])
def test_the_even_load_is_the_force_of_a_run_on_the_flanks_that_carry(torque):
    """Statics: without friction forces have the direction of the flanks' normal."""
    model = model_of(helical_scene(ELASTIC + "\n[coast_flanks]\n", offset=2.0, accuracy=FEW, torque=torque))
    recorder = Recorder(model, cycle_of(model, on_stand_in_bodies(model)))
    Marcher(recorder.cycle, model.equations_of_motion).run(model.steps, 1, observe=recorder.take)
    recorder.finish()
    for shaft, load in zip(model.drivetrain.elastic, mean_loads(model, recorder)):
        even = even_load(shaft, model.pair, torque)
        # Each gear's tilts about the pitch point are what the line load makes of them.
        assert np.abs(even - load)[:3].max() <= 1e-4 * np.linalg.norm(load[:3])
