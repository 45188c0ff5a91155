"""Row 15: shafts and bearings from far softer to far stiffer than the paper's."""

from dataclasses import replace

import numpy as np
import pytest
from tests.coarse import coarse_scene, frictionless, quasi_static

from fenics_gears.effects.bearings import BearingPlaces, Bearings
from fenics_gears.simulation.simulate import simulate


@pytest.fixture(scope="module")
def coarse(paper_scene):
    return coarse_scene(paper_scene)


def stiffened(scene, factor):
    return replace(
        scene,
        shafts=replace(scene.shafts, torsional_stiffness=factor * scene.shafts.torsional_stiffness),
        bearings=replace(scene.bearings, stiffness=factor * scene.bearings.stiffness),
    )


@pytest.mark.parametrize(
    "make", [quasi_static, lambda scene: frictionless(quasi_static(scene))], ids=["friction", "frictionless"]
)
def test_stiff_springs_tend_to_the_rigid_drivetrain(make, coarse, measured):
    """Exact limit: with shafts and bearings ever stiffer the transmission error tends to that of the scene without, as
    1/k."""
    rigid = simulate(replace(make(coarse), shafts=None, bearings=None)).transmission_error.values
    distances = []
    for factor in (1e-3, 1.0, 1e3, 1e6, 1e9, 1e12):
        error = simulate(stiffened(make(coarse), factor)).transmission_error.values
        distances.append(np.abs(error - rigid).max() / np.abs(rigid).max())
    measured(
        "relative difference from rigid shafts and bearings, stiffness 1e-3 of nominal",
        distances[0],
        "decreases with stiffness",
    )
    measured(
        "relative difference from rigid shafts and bearings, nominal stiffness",
        distances[1],
        "decreases with stiffness",
    )
    measured(
        "relative difference from rigid shafts and bearings, stiffness 1e9 of nominal",
        distances[-2],
        "1e-9 of that with nominal stiffness, within 30 %",
    )
    measured("relative difference from rigid shafts and bearings, stiffness 1e12 of nominal", distances[-1], "1e-10")
    assert np.all(np.diff(distances) <= 0.0)
    assert distances[2:5] == pytest.approx([distances[1] / 1e3, distances[1] / 1e6, distances[1] / 1e9], rel=0.3)
    assert distances[-1] <= 1e-10


def test_stiff_bearings_of_gears_that_tilt_tend_to_held_ones(coarse, measured):
    """Exact limit: with bearings along the shafts ever stiffer a helical pair's transmission error tends to that
    without bearings, as 1/k; soft ones are named."""
    accuracy = replace(
        coarse.accuracy, slices=3, layers=2, body_element_size=2.5, steps_per_mesh_cycle=4, contact_nodes=14
    )
    gears = replace(coarse.gears, module=4.35, helix_angle=np.deg2rad(15.0))
    held = replace(frictionless(quasi_static(coarse)), gears=gears, accuracy=accuracy, bearings=None)

    def distance(stiffness):
        return np.abs(run(stiffness).transmission_error.values - rigid).max() / np.abs(rigid).max()

    def run(stiffness):
        return simulate(
            replace(
                held,
                bearings=Bearings(
                    stiffness, axial_stiffness=stiffness, places=BearingPlaces((-40.0, 60.0), (-45.0, 45.0))
                ),
            )
        )

    rigid = simulate(held).transmission_error.values
    nominal, stiff, stiffest = (distance(each) for each in (1e5, 1e14, 1e17))
    measured(
        "gears that tilt: relative difference from held ones, stiffness 1e9 of nominal",
        stiff,
        "1e-9 of that with nominal stiffness, within 30 %",
    )
    measured("gears that tilt: relative difference from held ones, stiffness 1e12 of nominal", stiffest, "1e-10")
    assert stiff == pytest.approx(1e-9 * nominal, rel=0.3) and stiffest <= 1e-10
    assert "the pinion tilts by" in run(30.0).attrs["warnings"]


@pytest.mark.parametrize("factor", [1e-3, 1e3, 1e6, 1e9, 1e12])
def test_springs_of_any_stiffness_march_in_time(factor, coarse, measured):
    """From the task: with inertia every step converges, whatever the springs; the torque on the wheel stays of the size
    of the load."""
    result = simulate(stiffened(coarse, factor))
    torque = np.abs(result.reaction_couple.sel(gear="wheel").values).max() / coarse.load.wheel_torque
    measured(f"largest torque / load torque, stiffness {factor:g} of nominal", torque, "10")
    assert result.attrs["complete"]
    assert np.all(np.isfinite(result.transmission_error.values))
    assert torque < 10.0
