"""Housings of trains' shafts, from files with matrices in space."""

import numpy as np
import pytest
from scipy.linalg import block_diag
from tests.dynamics.test_shaft_elements import coupled
from tests.elastic_shaft_scenes import ELASTIC
from tests.simulation.test_train_shafts import ON_ROLLING, pair_and_train
from tests.trains import bent_two_stages

from fenics_gears import SceneError, scene_from_text, simulate, simulate_train, train_from_text
from fenics_gears.model.train import train_model_of
from fenics_gears.results.mesh_of_train import carried_train

BOTH = 'housing = "housing.txt"\n'
TURNING = np.arange(24) % 6 == 5
NAMES = ("transmission_error", "normal_force", "line_load", "tilt_x", "axial_position", "axis_inclination_in_plane")


def written(folder, matrix):
    np.savetxt(folder / "housing.txt", matrix, fmt="%.17e")


def in_space(matrix, along):
    """A housing in the frame of a line of action, which is turned by an angle (rad) in space."""
    turn = np.eye(3)
    turn[:2, :2] = [[np.cos(along), -np.sin(along)], [np.sin(along), np.cos(along)]]
    whole = block_diag(*[turn] * (len(matrix) // 3))
    return whole @ matrix @ whole.T


@pytest.mark.parametrize(
    ("shafts", "vibrating"), [(ELASTIC, False), pytest.param(ON_ROLLING, True, marks=pytest.mark.nightly)]
)
def test_a_train_of_one_mesh_in_one_housing_is_the_pair(tmp_path, shafts, vibrating):
    """Two ways to the same equations: both shafts in a housing in which every seat moves every other one."""
    pair, train = pair_and_train(15.0, shafts, vibrating)
    housing = np.zeros((24, 24))
    housing[np.ix_(~TURNING, ~TURNING)] = coupled()
    written(tmp_path, housing)
    head = f"[shafts]\n{BOTH}"
    expected = simulate(scene_from_text(pair.replace("[shafts.input]", f"{head}[shafts.input]"), directory=tmp_path))
    scene = train_from_text(train)
    along = np.deg2rad(25.0 + 90.0) - scene.meshes[0].pair.operating_pressure_angle
    written(tmp_path, in_space(housing, along))
    found = simulate_train(train_from_text(train.replace("[shafts.a]", f"{head}[shafts.a]"), directory=tmp_path))
    alone = simulate_train(scene)
    for name in NAMES:
        size = np.nanmax(np.abs(expected[name].values))
        values = found.isel(mesh=0)[name].values
        assert values == pytest.approx(expected[name].values, rel=1e-8, abs=1e-8 * size), name
    off = found["tilt_x"].values - alone["tilt_x"].values
    assert np.abs(off).max() > 1e-2 * np.abs(alone["tilt_x"].values).max()


def test_a_housing_of_springs_is_in_series_with_the_bearings(tmp_path):
    """Exact: seats that do not move each other, on h in all directions across the axis and along it: bearings of
    k h / (k + h)."""
    spring = 4e5
    written(tmp_path, np.diag([spring, spring, spring, 0.0, 0.0, 0.0] * 2))
    in_series = bent_two_stages(1.0).text
    housed = in_series.replace("gears_at =", f"{BOTH}gears_at =")
    for each in (1e6, 1e5):
        in_series = in_series.replace(f'"{each!r} N/mm"', f'"{each * spring / (each + spring)!r} N/mm"')
    found, wanted = (simulate_train(train_from_text(each, directory=tmp_path)) for each in (housed, in_series))
    for name in ("transmission_error", "line_load", "bearing_force_x", "bearing_force_z", "shaft_deflection_y"):
        size = np.nanmax(np.abs(wanted[name].values))
        assert found[name].values == pytest.approx(wanted[name].values, rel=1e-9, abs=1e-9 * size), name
    # The result is read again with its files.
    assert carried_train(found).shafts.bent[0].own.housing.stiffness is not None


@pytest.mark.parametrize(
    ("of_all", "of_one", "rows", "words"),
    [
        ("", BOTH, 6, r"shafts.middle.housing = .* has 6 rows for 2 bearings; allowed are 12"),
        (f"[shafts]\n{BOTH}", "", 24, r"shafts.housing = .* has 24 rows for 2 bearings"),
        (f"[shafts]\n{BOTH}", BOTH, 12, r"shafts.middle.housing .* together with the housing of \[shafts\]"),
    ],
)
def test_a_housing_that_does_not_fit_is_refused(tmp_path, of_all, of_one, rows, words):
    """A user's expectation: what is wrong, where, and what is allowed."""
    written(tmp_path, 1e5 * np.eye(rows))
    text = bent_two_stages(1.0).text.replace("gears_at =", f"{of_one}gears_at =")
    text = text.replace("[shafts.middle]", f"{of_all}[shafts.middle]", 1)
    with pytest.raises(SceneError, match=f"(?s){words}"):
        train_model_of(train_from_text(text, directory=tmp_path))


def test_a_housing_that_leaves_a_shaft_free_is_refused(tmp_path):
    """Seats that move freely along the axis hold no shaft there, whatever its bearings."""
    written(tmp_path, np.diag([1e5, 1e5, 0.0, 0.0, 0.0, 0.0] * 2))
    text = bent_two_stages(1.0).text.replace("gears_at =", f"{BOTH}gears_at =")
    with pytest.raises(SceneError, match="(?s)shafts.middle.bearings: .* freely moves along its axis"):
        train_model_of(train_from_text(text, directory=tmp_path))
