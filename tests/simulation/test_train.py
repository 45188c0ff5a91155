"""Runs of trains."""

import numpy as np
import pytest
from tests.trains import helical_row, row, two_stages

from fenics_gears import SceneError, simulate, simulate_train
from fenics_gears.scene.train_mesh import layout_of

FRICTION = "\n[friction]\ncoefficient = {}\n"
CURVES = ("normal_force", "pair_normal_force", "transmission_error", "largest_contact_pressure", "mesh_stiffness")


def test_stages_on_rigid_shafts_are_pairs_by_themselves():
    """Rigid shafts hand on torques and rotations alone: each stage has what its pair has under its torque, and the
    whole lags by the sum of what its stages lag, each through the ratios behind it."""
    scene = two_stages(more=FRICTION.format(0.08))
    found = simulate_train(scene)
    left = 1.0
    for number, mesh in enumerate(scene.meshes):
        alone = simulate(mesh.scene)
        own = found.isel(mesh=number)
        for name in CURVES:
            expected = alone[name].values
            assert np.array_equal(own[name].values[tuple(slice(size) for size in expected.shape)], expected), name
        assert float(own["mean_transmission_error"]) == alone.attrs["mean_transmission_error"]
        left *= 1.0 - alone.attrs["friction_loss"]
    assert found.attrs["friction_loss"] == pytest.approx(1.0 - left, rel=1e-12)
    first, second = (float(found["mean_transmission_error"][number]) for number in (0, 1))
    ratio = scene.meshes[1].pair.rotation_ratio
    assert found.attrs["mean_overall_transmission_error"] == pytest.approx(second + ratio * first, rel=1e-12)
    start = [float(found["transmission_error"].isel(mesh=number)[-1]) for number in (0, 1)]
    assert float(found["overall_transmission_error"][0]) == pytest.approx(start[1] + ratio * start[0], rel=1e-9)


def test_thrusts_on_a_helical_idler_cancel():
    """Its hand is one in both meshes, in which opposite flanks carry: the axial forces of both meshes on it cancel, on
    the other gears they remain, F tan(beta_b) each. Flanks that stand back at one end carry at the same end in both."""
    leaning = '[stages.row.lead_modifications.pinion]\nhelix_slope = "20 um"'
    scene = helical_row([24, 31, 40], [0, 60], 300, more=leaning)
    found = simulate_train(scene)
    thrust = found["reaction_z"].transpose("step", "mesh", "gear").values
    force = 300e3 / scene.meshes[1].pair.wheel.base_radius
    expected = force * scene.meshes[0].pair.slope
    assert thrust[:, 0, 1] + thrust[:, 1, 0] == pytest.approx(np.zeros(len(thrust)), abs=1e-9 * force)
    assert np.abs(thrust[:, [0, 1], [0, 1]]) == pytest.approx(np.full((len(thrust), 2), expected), rel=1e-9)
    assert (found["face_load_factor"].values > 1.1).all()
    load = found["line_load"].sum("slot").mean("contact_step").transpose("mesh", "face_position").values
    assert ((load[:, 0] > load[:, -1]) == (load[0, 0] > load[0, -1])).all()
    assert "the first gear of the stage" in found["face_position_of_mesh"].attrs["long_name"]


def test_results_of_different_stages_stand_side_by_side():
    """Curves that one mesh alone has, of its relief, are there too, and not a number in the other."""
    found = simulate_train(two_stages(of_first='tip_relief = { depth = "10 um", start = "HPSTC" }'))
    assert list(found["mesh"].values) == ["first", "second"]
    assert np.isfinite(found["largest_kink_pressure"].isel(mesh=0)).all()
    assert np.isnan(found["largest_kink_pressure"].isel(mesh=1)).all()
    for name, variable in found.variables.items():
        assert "long_name" in variable.attrs, name


def test_pairs_of_both_meshes_of_an_idler_touch_along_their_paths():
    """Phase less number is the way of a pair since the start of its path, also where the second mesh begins 0.19 cycles
    after a start: deflection brings pairs into contact a little before their path and keeps them a little behind it, by
    about as much."""
    scene = row((24, 31, 40), (0, 60), 300.0)
    found = simulate_train(scene)
    assert layout_of(scene.meshes).phases[1] == pytest.approx(0.193, abs=1e-3)
    for number, mesh in enumerate(scene.meshes):
        own = found.isel(mesh=number).transpose("step", "slot", ...)
        way = (
            own["mesh_phase"].values[:, None]
            - own["pair_number"].values
            + own["pair_number"].attrs["number_at_phase_0"]
        )
        loaded = way[own["pair_normal_force"].values > 0.0]
        early = -loaded.min()
        late = loaded.max() - mesh.pair.contact_ratio
        assert 0.0 < early < 0.15
        assert late == pytest.approx(early, abs=0.05)


@pytest.mark.parametrize(
    ("run", "given", "words"),
    [
        (simulate, two_stages(), "load_train and run by simulate_train"),
        (simulate, "pair.toml", "from load_scene, not an object of type str"),
        (simulate_train, two_stages().meshes[0].scene, "load_scene and run by simulate"),
    ],
)
def test_what_is_no_scene_of_theirs_is_refused_in_words(run, given, words):
    """The call that reads what was meant is named."""
    with pytest.raises(SceneError, match=words):
        run(given)
