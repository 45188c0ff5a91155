"""Row 22: teeth entering and leaving; contact at a sharp tip."""

from dataclasses import replace

import numpy as np
import pytest
from tests.coarse import COARSE, frictionless, quasi_static, teeth_alone

from fenics_gears import simulate
from fenics_gears.scene.data import Motion


def one_cycle(scene, steps, size=0.12):
    """The scene over a mesh cycle of `steps` steps, flank elements and contact nodes of one size (mm)."""
    accuracy = replace(COARSE, steps_per_mesh_cycle=steps, flank_element_size=size, contact_nodes=round(3.0 / size) + 1)
    return replace(scene, accuracy=accuracy, motion=Motion(200.0, 1, 1))


def largest_step(scene, steps, size=0.12):
    """Largest change of the transmission error from one step to the next, in parts of its peak-to-peak value."""
    error = simulate(one_cycle(scene, steps, size)).transmission_error.values
    return np.abs(np.diff(error)).max() / np.ptp(error)


@pytest.mark.parametrize(
    "kind",
    [
        *(pytest.param(each, marks=pytest.mark.nightly) for each in ("teeth alone", "paper's drivetrain")),
        "with friction",
    ],
)
def test_transmission_error_is_continuous_in_time(coarse, kind, measured):
    """Continuity: the largest change from step to step halves with the step, hand-over included."""
    scene = {
        "teeth alone": teeth_alone(frictionless(coarse)),
        "paper's drivetrain": quasi_static(frictionless(coarse)),
        "with friction": quasi_static(coarse),
    }[kind]
    changes = [largest_step(scene, steps) for steps in (60, 120, 240)]
    orders = np.log2(np.array(changes[:-1]) / changes[1:])
    measured(
        f"{kind}: largest change of the transmission error in 1/240 mesh cycle / peak-to-peak value",
        changes[-1],
        "proportional to the step",
    )
    measured(f"{kind}: order of this change in the step", orders[-1], "1 +- 0.2")
    assert orders[-1] == pytest.approx(1.0, abs=0.2)


@pytest.mark.nightly
def test_transmission_error_stays_continuous_as_the_mesh_is_refined(coarse, measured):
    """Continuity as h goes to 0: the steepest slope does not grow, as that of a jump would (as 1/h)."""
    slopes = [100 * largest_step(teeth_alone(frictionless(coarse)), 100, size) for size in (0.16, 0.08, 0.04)]
    measured(
        "steepest slope, in peak-to-peak values per mesh cycle, with elements of 0.16, 0.08, 0.04 mm",
        ", ".join(f"{slope:.3g}" for slope in slopes),
        "bounded",
    )
    assert slopes[2] <= 1.25 * slopes[0]


def at_the_edge(scene, size):
    """Largest pressure (MPa) at a node on a tip's edge, the mean transmission error, and warnings."""
    result = simulate(one_cycle(scene, 100, size))
    pressure, roll = result.contact_pressure.values, result.contact_roll_angle.values
    # The pinion's tip ends its flank at the largest roll angle that any node reaches.
    edge = np.abs(roll - np.nanmax(roll)) <= 1e-9
    return float(pressure[edge].max()), result.attrs["mean_transmission_error"], result.attrs["warnings"]


@pytest.mark.nightly
def test_pressure_at_a_sharp_edge_grows_without_bound_and_is_flagged(coarse, measured):
    """Elasticity: a stress singularity at the corner; the transmission error converges."""
    found = [at_the_edge(teeth_alone(frictionless(coarse)), size) for size in (0.16, 0.08, 0.04)]
    pressures, errors = np.array([each[0] for each in found]), np.array([each[1] for each in found])
    measured(
        "pressure on the pinion's tip edge with elements of 0.16, 0.08, 0.04 mm",
        ", ".join(f"{p:.0f}" for p in pressures),
        "grows: no limit",
        "MPa",
    )
    measured(
        "relative change of the mean transmission error at the last halving",
        abs(errors[2] / errors[1] - 1.0),
        "smaller than at the halving before",
    )
    assert np.all(np.diff(pressures) > 0.0)
    assert abs(errors[2] - errors[1]) < abs(errors[1] - errors[0])
    assert all(
        "sharp edge of the pinion's and the wheel's tip" in said and "does not converge with the mesh" in said
        for *_, said in found
    )
