"""Orders of a train over a speed ramp."""

import numpy as np
import pytest
import xarray as xr
from tests.simulation.test_train_motion import INERTIA
from tests.trains import two_stages

from fenics_gears.results.overall_orders import ramp_orders

RAMP = '[motion]\ninput_speed = "600 rpm"\nmesh_cycles = 8\n[speed_ramp]\nend_speed = "1200 rpm"\n'


def test_amplitudes_of_a_signal_are_found():
    """Exact: a sum of cosines of the phases of both meshes has their amplitudes in every window, whatever the speed."""
    train = two_stages(more=INERTIA + RAMP)
    frequencies = [mesh.scene.motion.mesh_frequency for mesh in train.meshes]
    steps = [40, 60]
    assert steps[0] * frequencies[0] == pytest.approx(steps[1] * frequencies[1])
    number = np.arange(8 * 60 + 1)
    phases = [2.0 * np.pi * number / each for each in steps]
    lag = 3e-4 + 2e-5 * np.cos(phases[0] + 0.3) + 1e-5 * np.cos(phases[1]) + 4e-6 * np.sin(3.0 * phases[0])
    speed = np.linspace(1.0, 2.0, len(number))
    result = xr.Dataset(
        {
            "steps_per_mesh_cycle": ("mesh", steps),
            "overall_transmission_error": ("time", lag),
            "mesh_frequency": (("step", "mesh"), np.outer(speed, frequencies)),
        }
    )
    found = {(each.mesh, each.harmonic): each for each in ramp_orders(result, train)}
    wanted = {("first", 1): 2e-5, ("second", 1): 1e-5, ("first", 3): 4e-6, ("first", 2): 0.0}
    for key, amplitude in wanted.items():
        assert found[key].amplitudes == pytest.approx([amplitude] * 4, rel=1e-9, abs=1e-16), key
    assert found["first", 1].order == pytest.approx(20.0)
    assert found["first", 1].speeds[0] == pytest.approx(10.0 * speed[:120].mean())
