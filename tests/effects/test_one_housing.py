"""Two shafts in one housing from a file."""

from dataclasses import replace

import numpy as np
import pytest
from tests.dynamics.test_shaft_elements import by_textbook, coupled
from tests.elastic_shaft_scenes import ELASTIC, FEW, INPUT, OUTPUT, PINION, ROLLING, VIBRATING, WHEEL
from tests.hard_cases.invariants import cycle_of, run_of
from tests.helical import helical_scene, on_stand_in_bodies

from fenics_gears import SceneError, model_of, scene_from_text
from fenics_gears.dynamics.bearings import Bearing
from fenics_gears.dynamics.march import Marcher
from fenics_gears.dynamics.rolling_bearing import reaction, secant_stiffness

HOUSED = '[shafts]\nhousing = "housing.txt"\n'
# The housing of the seats without their turns, which bearings do not hold.
TURNING = np.arange(24) % 6 == 5


def whole(housing):
    found = np.zeros((24, 24))
    found[np.ix_(~TURNING, ~TURNING)] = housing
    return found


def scene_in(folder, shafts, matrix, housed=HOUSED, **more):
    np.savetxt(folder / "housing.txt", matrix, fmt="%.17e")
    plain = shafts.replace('housing = "housing.txt"\n', "")
    text = helical_scene(plain, accuracy=FEW, offset=2.0, **more).text
    return scene_from_text(text.replace(plain, housed + shafts), directory=folder)


def test_gears_and_rolling_bearings_in_one_housing_are_in_balance(tmp_path):
    """Brute force: a textbook's elements with a node for each seat, on springs that give what rolling bearings carry by
    their law; a very stiff seat is extrapolated to a rigid one."""
    housing = coupled()
    model = model_of(scene_in(tmp_path, ROLLING + OUTPUT + WHEEL, whole(housing)))
    train, cycle = model.drivetrain, cycle_of(model, on_stand_in_bodies(model))
    record = Marcher(cycle, model.equations_of_motion).run(model.steps, model.steps + 1).records[-1]
    columns = [train.coordinates.index(name) for name in train.systems[0].moved]
    motions = record.state.position / train.radii
    pinion, wheel = train.elastic
    rolling = motions[[train.coordinates.index(name) for name in pinion.in_rolling]].reshape(2, 5)
    secants = [secant_stiffness(each.rolling, motion) for each, motion in zip(pinion.bearings, rolling)]
    springs = [Bearing(each.at, stiffness_matrix=secant.tolist()) for each, secant in zip(pinion.bearings, secants)]
    shafts = replace(pinion, bearings=tuple(springs)), wheel
    stiffness = 2.0 * by_textbook(shafts, housing, 2e4) - by_textbook(shafts, housing, 1e4)
    loads = -(record.position.operator.jacobian.T @ record.solution.forces)[columns] * train.radii[columns]
    moved = np.linalg.solve(stiffness, loads)
    assert motions[columns] == pytest.approx(moved, abs=1e-6 * np.abs(moved).max())
    laws = np.array([reaction(each.rolling, motion).loads for each, motion in zip(pinion.bearings, rolling)])
    assert laws.sum(axis=0)[:3] == pytest.approx(loads[:3], rel=1e-7, abs=1e-6)


def test_shafts_that_vibrate_in_one_housing_keep_the_balance_of_energy(tmp_path):
    """Exact: the account closes; slow motion is that at rest."""
    housing = 1e2 * coupled()
    model = model_of(scene_in(tmp_path, VIBRATING, whole(housing), frequency=800.0))
    result = run_of(model, on_stand_in_bodies(model)).result
    assert np.abs(result["energy_defect"].values).max() <= 1e-10 * result["energy"].values.max()
    assert {name.rpartition("_")[2] for name in model.drivetrain.systems[0].own_modes} == {"pinion", "wheel"}


def test_a_housing_of_both_shafts_that_is_given_to_one_is_told_where_it_belongs(tmp_path):
    """What to do."""
    of_input = ELASTIC.replace("torque_at", 'housing = "housing.txt"\ntorque_at', 1)
    scene = scene_in(tmp_path, of_input, np.diag(np.where(TURNING, 0.0, 1e6)), housed="")
    with pytest.raises(SceneError, match=r"24 rows for 2 bearings; allowed are 12.* is the housing of \[shafts\]"):
        model_of(scene)


@pytest.mark.parametrize(
    ("shafts", "rows", "said"),
    [
        (ELASTIC, 12, "shafts.housing = .* has 12 rows for 4 bearings; allowed are 24"),
        (INPUT + PINION, 12, "shafts.housing.* is the housing of both shafts, which then have sections"),
        (
            ELASTIC.replace("torque_at", 'housing = "housing.txt"\ntorque_at', 1),
            24,
            "shafts.input.housing .* is given together with the housing of \\[shafts\\]",
        ),
        (ELASTIC.replace('axial_stiffness = "0.1e6 N/mm"', ""), 24, "bearings.pinion: 2 bearings hold .* its axis"),
    ],
)
def test_a_housing_of_both_shafts_that_does_not_fit_is_refused(tmp_path, shafts, rows, said):
    """What is wrong, and where."""
    with pytest.raises(SceneError, match=f"(?s){said}"):
        model_of(scene_in(tmp_path, shafts, np.diag(np.where(TURNING, 0.0, 1e6)[:rows])))
