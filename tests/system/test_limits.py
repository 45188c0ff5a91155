"""Limits that the drivetrain and the load must have (hard cases, rows 13, 15, 16, 23), on the paper's pair at a coarse mesh."""

from dataclasses import replace

import numpy as np
import pytest

from fenics_gears.scene.data import Accuracy, Motion
from fenics_gears.simulation import simulate

COARSE = Accuracy(element="P1", flank_element_size=0.12, contact_length=3.0, contact_nodes=26, steps_per_mesh_cycle=40)


@pytest.fixture(scope="module")
def coarse(paper_scene):
    return replace(paper_scene, accuracy=COARSE, motion=Motion(200.0, 2, 1))


def quasi_static(scene):
    return replace(scene, inertia=None, damping=None)


def stiffened(scene, factor):
    return replace(
        scene,
        shafts=replace(scene.shafts, torsional_stiffness=factor * scene.shafts.torsional_stiffness),
        bearings=replace(scene.bearings, stiffness=factor * scene.bearings.stiffness),
    )


@pytest.mark.parametrize("make", [quasi_static, lambda scene: replace(quasi_static(scene), friction=None)])
def test_stiff_springs_tend_to_the_rigid_drivetrain(coarse, make):
    """Row 15: with shafts and bearings 1 ... 1e12 times as stiff the transmission error tends to that of the scene without, as 1/k."""
    rigid = simulate(replace(make(coarse), shafts=None, bearings=None)).transmission_error.values
    distances = []
    for factor in (1.0, 1e3, 1e6, 1e9, 1e12):
        error = simulate(stiffened(make(coarse), factor)).transmission_error.values
        distances.append(np.abs(error - rigid).max())
    assert np.all(np.diff(distances) <= 0.0)
    assert distances[1:4] == pytest.approx([distances[0] / 1e3, distances[0] / 1e6, distances[0] / 1e9], rel=0.3)
    assert distances[-1] <= 1e-12


@pytest.mark.parametrize("factor", [1e-3, 1e6, 1e12])
def test_springs_of_any_stiffness_march_in_time(coarse, factor):
    """Row 15: with inertia every step converges, whatever the springs."""
    result = simulate(stiffened(coarse, factor))
    assert np.all(np.isfinite(result.transmission_error.values))


@pytest.mark.parametrize("torque", [0.0, 1e-12, 1.0, 4370e3])
@pytest.mark.parametrize("absent", [(), ("bearings",), ("shafts",), ("shafts", "bearings")])
def test_any_torque_is_carried_with_friction(coarse, torque, absent):
    """Row 16: torque 0, 1e-12, 1 N mm and 10 x nominal: the wheel's couple is the load, nothing is added, no step fails."""
    scene = replace(quasi_static(coarse), load=replace(coarse.load, wheel_torque=torque), **dict.fromkeys(absent))
    result = simulate(scene)
    assert result.reaction_couple.sel(gear="wheel").values == pytest.approx(-torque, rel=1e-9, abs=1e-9)


def test_load_and_modulus_scale_out(coarse):
    """Row 13: E x 7 and torque x 7 leave every displacement as it is, springs apart, with the same iterations."""
    scene = replace(quasi_static(coarse), shafts=None, bearings=None)
    gears = scene.gears
    stiff = replace(
        scene,
        gears=replace(gears, material=replace(gears.material, youngs_modulus=7.0 * gears.material.youngs_modulus)),
        load=replace(scene.load, wheel_torque=7.0 * scene.load.wheel_torque),
    )
    first, second = simulate(scene), simulate(stiff)
    assert second.transmission_error.values == pytest.approx(first.transmission_error.values, rel=1e-9)
    assert np.array_equal(first.newton_iterations.values, second.newton_iterations.values)


def test_fast_mesh_leaves_the_gears_where_they_are(coarse):
    """Row 23: at 20 kHz, far above every natural frequency, the gears keep their mean position: nothing rings, nothing separates."""
    result = simulate(replace(coarse, friction=None, motion=Motion(20e3, 30, 2)))
    static = simulate(replace(quasi_static(coarse), friction=None))
    assert result.attrs["peak_to_peak_transmission_error"] < 0.05 * static.attrs["peak_to_peak_transmission_error"]
    assert result.attrs["mean_transmission_error"] == pytest.approx(static.attrs["mean_transmission_error"], rel=0.01)
    assert "lose contact" not in result.attrs["warnings"]
