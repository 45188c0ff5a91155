"""Scenes that need no speed: quasi-static equilibrium and Coulomb's law know no rate."""

import numpy as np
import pytest
from tests.paper_text import PAPER, without
from tests.stand_in import stand_in_compliance

from fenics_gears import scene_from_text, simulate
from fenics_gears.elasticity.compliance import Body
from fenics_gears.results import shown
from fenics_gears.scene.data import Motion
from fenics_gears.simulation.elastic_route import mesh_cycle

TIMES = ("time_mesh", "time_compile", "time_condense")
STATIC = without(PAPER, "inertia", "damping")
SPEEDLESS = without(STATIC, "motion")


@pytest.mark.parametrize(
    ("added", "expected"),
    [
        ("", Motion(1.0, 1, 1, speed_given=False)),
        ("[motion]", Motion(1.0, 1, 1, speed_given=False)),
        ("[motion]\nmesh_cycles = 3", Motion(1.0, 3, 2, speed_given=False)),
        ("[motion]\nrecorded_cycles = 3", Motion(1.0, 3, 3, speed_given=False)),
        ('[motion]\nmesh_frequency = "200 Hz"', Motion(200.0, 1, 1)),
        (
            '[eccentricity.wheel]\ndistance = "10 um"',
            Motion(1.0, 48, 48, fewer_where_too_large=True, speed_given=False),
        ),
        ("[flank_errors]\ntolerance_class = 6\n[motion]\nmesh_cycles = 5", Motion(1.0, 5, 2, speed_given=False)),
    ],
)
def test_motion_of_a_scene_without_inertia(added, expected):
    """One mesh cycle, or lcm(16, 24) where teeth differ; what is given goes first."""
    assert scene_from_text(f"{SPEEDLESS}\n{added}\n").motion == expected


def run(text):
    return simulate(scene_from_text(text), preparation=on_stand_ins)


def on_stand_ins(model, progress, cache):
    """Contact operators on teeth without finite elements."""
    gears = [
        Body(stand_in_compliance(gear), timings=dict.fromkeys(TIMES, 0.0))
        for gear in (model.pair.pinion, model.pair.wheel)
    ]
    return gears, mesh_cycle(model, gears)


def test_one_mesh_cycle_without_speed_is_the_last_of_many_at_any_speed():
    """Every number of the last cycle but the time, bit for bit."""
    alone = run(SPEEDLESS)
    many = shown(
        run(STATIC.replace("recorded_cycles = 2", "recorded_cycles = 1").replace("mesh_cycles = 30", "mesh_cycles = 4"))
    )
    for name in ("transmission_error", "normal_force", "friction_force", "closed_nodes"):
        np.testing.assert_array_equal(alone[name].values, many[name].values)
    assert np.ptp(alone["time"].values) == pytest.approx(1.0, rel=1e-12)
    assert alone["time"].attrs["long_name"].startswith("nominal time") and many["time"].attrs["long_name"] == "time"
    assert alone.attrs["peak_to_peak_transmission_error"] == many.attrs["peak_to_peak_transmission_error"] > 0.0
