"""Runs of trains."""

from dataclasses import replace
from functools import reduce

import numpy as np
import pytest
from tests.trains import COARSE, helical_row, row, stage, two_stages

from fenics_gears import model_of, simulate, simulate_train, train_from_text
from fenics_gears.dynamics.march import Marcher
from fenics_gears.dynamics.mesh_in_train import drivetrain_of_mesh
from fenics_gears.dynamics.steps import Steps
from fenics_gears.model.row_model import RowModel
from fenics_gears.scene.train_mesh import layout_of
from fenics_gears.simulation.train import row_cycle
from fenics_gears.system.progress import SilentProgress

FRICTION = "\n[friction]\ncoefficient = {}\n"
LOAD = f'[load]\noutput_torque = "400 N m"\n[accuracy]\n{COARSE}'
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


def test_helical_stages_have_what_helical_pairs_have():
    """A stage over the face: its face load factor and line loads are those of its pair."""
    helical = stage("one", 3.0, (20, 30), 'helix_angle = "15 deg"\n[stages.one.accuracy]\nslices = 6\nlayers = 4')
    scene = train_from_text(f"{helical}{stage('two', 3.0, (20, 40))}\n{LOAD}")
    found = simulate_train(scene)
    alone = simulate(scene.meshes[0].scene)
    assert float(found["face_load_factor"][0]) == alone.attrs["face_load_factor"]
    assert np.isnan(found["face_load_factor"][1])
    for place in (0, 5):
        force = found["line_load"].isel(mesh=0, face_position=place).values
        assert np.array_equal(force, alone["line_load"].isel(face_position=place).values)


def marched(row: RowModel) -> Steps:
    """Two mesh cycles of a row."""
    cycle = row_cycle(row, SilentProgress(), None)
    blocks: list[Steps] = []
    Marcher(cycle, row.equations_of_motion).run(cycle.steps, 1, observe=lambda solved, march: blocks.append(solved))
    return reduce(Steps.followed_by, blocks)


@pytest.mark.parametrize("friction", [0.0, 0.08])
def test_a_row_of_one_mesh_is_a_pair(friction):
    """The contact equations of a row of a single mesh, marched as those of a row, give the pair step by step."""
    shared = FRICTION.format(friction) if friction else ""
    (pair,) = train_from_text(f"{stage('one', 3.0, (20, 40))}{shared}\n{LOAD}").meshes
    own = model_of(pair.scene)
    row = RowModel((pair,), (replace(own, drivetrain=drivetrain_of_mesh(own.pair, own.scene.load.wheel_torque)),))
    steps = marched(row)
    expected = simulate(pair.scene)["transmission_error"].values
    assert steps.states[:, 0, 0] / own.pair.wheel.base_radius == pytest.approx(expected, rel=1e-10)


def test_forces_of_an_idler_follow_from_the_torque():
    """Without friction an idler hands on its force: both meshes carry torque over base radius, at every step."""
    scene = row([24, 31, 40], [0, 60], 300)
    found = simulate_train(scene)
    expected = 300e3 / scene.meshes[1].pair.wheel.base_radius
    assert found["normal_force"].values == pytest.approx(np.full((21, 2), expected), rel=1e-9)


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


def test_an_idler_that_both_meshes_load_is_softer():
    """An idler's force in one mesh turns its teeth in the other the same way: T_E is larger than without coupling."""
    coupled = simulate_train(row([24, 31, 40], [0, 60], 300)).attrs["mean_overall_transmission_error"]
    alone = simulate_train(row([24, 31, 40], [0, 60], 300, accuracy="elastic_teeth = 1"))
    assert coupled > 1.05 * alone.attrs["mean_overall_transmission_error"]


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
