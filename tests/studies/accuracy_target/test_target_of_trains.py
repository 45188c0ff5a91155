"""`[accuracy] target` of meshes that are computed together."""

import re

import numpy as np
import pytest
from tests.planets import planetary_text
from tests.trains import COARSE, row, two_stages

from fenics_gears import SceneError, simulate_train, train_from_text
from fenics_gears.model.train import train_model_of
from fenics_gears.results.mesh_of_train import carried_train, mesh_run
from fenics_gears.runs.settings.measures import JUDGED, distance, judged_answer
from fenics_gears.runs.settings.row_trials import TrialsOfRow
from fenics_gears.runs.settings.trial_runs import Sizes

TARGET = 0.05


@pytest.fixture(scope="module")
def run():
    return simulate_train(train_from_text(row((24, 31, 40), (0, 60), 300.0).text.replace(COARSE, 'target = "5 %"')))


def test_the_true_error_of_every_mesh_is_within_the_target(run):
    """By flank and body elements two thirds as large and twice the steps."""
    train = carried_train(run)

    def finer(number: str, by: float) -> str:
        return re.sub(rf'({number} = "?)([\d.]+)', lambda found: f"{found[1]}{float(found[2]) * by:g}", text)

    text = train.text
    for number, by in (("flank_element_size", 0.67), ("body_element_size", 0.67), ("steps_per_mesh_cycle", 2.0)):
        text = finer(number, by)
    reference = simulate_train(train_from_text(text))
    for number in range(2):
        own, true = (judged_answer(mesh_run(found, train, number)) for found in (run, reference))
        error = max(distance(own, true, name) for name in JUDGED)
        assert error <= float(run["estimated_error"][number]) <= TARGET == float(run["target"][number])


def test_the_scene_that_the_result_carries_repeats_it(run):
    """Identity, to the last bit; the scene's text has settings in place of its target."""
    train = carried_train(run)
    assert all(mesh.scene.accuracy.target is None for mesh in train.meshes)
    assert np.array_equal(simulate_train(train).transmission_error.values, run.transmission_error.values)


@pytest.mark.parametrize("asked", [20, 40, 60, 140])
def test_half_the_steps_are_half_the_steps(asked):
    """By counting: steps of meshes with 27 and 20 teeth on one shaft are whole multiples, also of half as many."""
    text = two_stages(more='[bearings]\nstiffness = "2e5 N/mm"\n').text
    text = text.replace("teeth = 30,", "teeth = 27,")
    train = train_from_text(text)
    trials = TrialsOfRow(train, [0, 1], None, lambda words: None)
    steps = trials.step_unit * (asked // 20)
    both = (trials.setting(Sizes(1.0, each)).of(train) for each in (steps, steps // 2))
    whole, half = ([own.resolution.steps_per_mesh_cycle for own in train_model_of(each).models] for each in both)
    assert min(whole) == steps and whole == [2 * each for each in half]


def test_a_set_takes_accuracy_of_its_own():
    """In place of that of the whole, as its result has it after a target."""
    text = planetary_text(more='accuracy = { steps_per_mesh_cycle = 24, flank_element_size = "0.2 mm" }')
    found = {mesh.scene.accuracy.steps_per_mesh_cycle for mesh in train_from_text(text).meshes}
    assert found == {24}
    with pytest.raises(SceneError, match=r"stages.set.accuracy.flank_element_size"):
        train_from_text(text.replace('"0.2 mm"', '"0.2 kg"'))


def test_meshes_that_move_together_have_one_target():
    """Before anything is computed."""
    stages = '[stages.first.accuracy]\ntarget = "1 %"\n[bearings]\nstiffness = "2e5 N/mm"\n'
    with pytest.raises(SceneError, match="one target"):
        train_model_of(two_stages(more=stages))
