"""Runs of trains."""

import numpy as np
import pytest
from tests.trains import row, train_from, two_stages

from fenics_gears import build_scene, simulate
from fenics_gears.dynamics.energy_account import account
from fenics_gears.dynamics.march import Marcher
from fenics_gears.inputs.written import as_toml
from fenics_gears.model.train import train_model_of
from fenics_gears.results.contact_variables import energy_of_teeth
from fenics_gears.simulation.train import simulate_train, train_cycle
from fenics_gears.system.progress import SilentProgress

GEAR = {"profile_shift": 0.1, "bore_diameter": "20 mm"}
PAIR = {
    "module": "3 mm",
    "pressure_angle": "20 deg",
    "face_width": "25 mm",
    "pinion": GEAR | {"teeth": 20},
    "wheel": GEAR | {"teeth": 40},
    "material": "steel",
}
EFFECTS = {"tip_relief": {"depth": "15 um", "start": "HPSTC"}}
ACCURACY = {"steps_per_mesh_cycle": 20, "flank_element_size": "0.1 mm"}
CURVES = ("normal_force", "pair_normal_force", "transmission_error", "largest_contact_pressure", "mesh_stiffness")


@pytest.mark.parametrize("friction", [None, {"coefficient": 0.08}])
def test_a_train_of_one_mesh_is_a_pair(friction):
    """The pair by itself, step by step."""
    shared = {"accuracy": ACCURACY} | ({} if friction is None else {"friction": friction})
    train = train_from(as_toml({"stages": {"one": PAIR | EFFECTS}, "load": {"output_torque": "200 N m"}, **shared}))
    pair = build_scene({"gears": PAIR, **EFFECTS, "load": {"wheel_torque": "200 N m"}, **shared})
    found = simulate_train(train)
    expected = simulate(pair)
    for name in CURVES:
        of_pair = expected[name].values
        of_train = found[name].isel(mesh=0).values
        assert of_train == pytest.approx(of_pair, rel=1e-10, abs=1e-12 * of_pair.max()), name
    overall = found["overall_transmission_error"].values
    assert overall == pytest.approx(expected["transmission_error"].values, rel=1e-10)
    if friction is not None:
        assert found.attrs["friction_loss"] == pytest.approx(expected.attrs["friction_loss"], rel=1e-6)


def test_stages_on_rigid_shafts_are_pairs_by_themselves():
    """Rigid shafts hand on torques and rotations alone: each mesh has the forces and the transmission error of its pair
    under its torque, and the whole lags by the sum of what its stages lag, each through the ratios behind it."""
    scene = two_stages()
    found = simulate_train(scene)
    for number, mesh in enumerate(scene.meshes):
        alone = simulate(mesh.scene)
        own = found.isel(mesh=number, time=slice(alone.sizes["time"]))
        for name in CURVES:
            expected = alone[name].values
            assert own[name].values == pytest.approx(expected, rel=1e-9, abs=1e-9 * np.nanmax(expected)), name
    first, second = (found["transmission_error"].isel(mesh=number).values for number in (0, 1))
    there = np.isfinite(first)
    ratio = scene.meshes[1].pair.rotation_ratio
    overall = found["overall_transmission_error"].values
    assert overall[there] == pytest.approx((second + ratio * first)[there], rel=1e-10)


def test_forces_of_an_idler_follow_from_the_torque():
    """Without friction an idler hands on its force: both meshes carry torque over base radius, at every step."""
    found = simulate_train(row([24, 31, 40], [0, 60], 300))
    expected = 300e3 / train_model_of(row([24, 31, 40], [0, 60], 300)).models[1].pair.wheel.base_radius
    assert found["normal_force"].values == pytest.approx(np.full((21, 2), expected), rel=1e-9)


def test_an_idler_that_both_meshes_load_is_softer():
    """An idler's force in one mesh turns its teeth in the other the same way: T_E is larger than without coupling."""
    coupled = simulate_train(row([24, 31, 40], [0, 60], 300)).attrs["mean_overall_transmission_error"]
    alone = simulate_train(row([24, 31, 40], [0, 60], 300, accuracy="elastic_teeth = 1"))
    assert coupled > 1.05 * alone.attrs["mean_overall_transmission_error"]


def test_the_energy_account_of_a_train_closes():
    """Work of drive, load and friction is the change of the teeth's energy, to round-off: also what one mesh displaces
    in the other a step before has to be counted."""
    model = train_model_of(row([24, 31, 40], [0, 60], 300, more="[friction]\ncoefficient = 0.1"))
    cycle, _ = train_cycle(model, SilentProgress(), None)
    blocks = []
    Marcher(cycle, model.equations_of_motion).run(40, 1, observe=lambda solved, march: blocks.append(solved))
    steps = blocks[0]
    for block in blocks[1:]:
        steps = steps.followed_by(block)
    energy = energy_of_teeth(steps)
    work = account(model.drivetrain, model.models[0].clock, steps, energy)
    assert work.friction[-1] > 0.01 * energy.max()
    assert np.abs(work.defect).max() < 1e-9 * energy.max()


def test_results_of_stages_with_different_cycles_stand_side_by_side():
    """A faster mesh passes whole cycles of its own; beyond them its curves are not a number. Curves that one mesh alone
    has, of its relief, are there too."""
    found = simulate_train(two_stages(of_first='tip_relief = { depth = "10 um", start = "HPSTC" }'))
    assert dict(found.sizes)["mesh"] == 2
    assert list(found["mesh"].values) == ["first", "second"]
    assert found["mesh_phase"].values[-1, 1] == 1.0
    phase = found["mesh_phase"].isel(mesh=0)
    assert np.nanmax(phase.values) == np.floor(np.nanmax(phase.values))
    for name, variable in found.variables.items():
        assert "long_name" in variable.attrs, name
