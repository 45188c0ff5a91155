"""Row 23: mesh frequencies from quasi-static (0.01 Hz) to the rigid mean motion (20 kHz), and no failed step
between."""

from dataclasses import replace

import numpy as np
import pytest
from tests.coarse import frictionless, quasi_static

from fenics_gears import simulate
from fenics_gears.contact.step_solver import NEWTON
from fenics_gears.effects.friction import Friction
from fenics_gears.scene.data import Motion

CYCLES = 3


def at(scene, mesh_frequency, cycles=CYCLES):
    return replace(scene, motion=Motion(mesh_frequency, cycles, cycles))


def difference(scene, mesh_frequency):
    """`apart` of a scene and the same without inertia."""
    dynamic = simulate(at(scene, mesh_frequency)).transmission_error.values
    return apart(dynamic, simulate(at(quasi_static(scene), mesh_frequency)).transmission_error.values)


def apart(dynamic, static):
    """Root of the mean square over each cycle of the difference to the quasi-static error, in parts of its mean."""
    each = (dynamic - static)[1:].reshape(CYCLES, -1)
    return np.sqrt(np.mean(each**2, axis=1)) / abs(static.mean())


@pytest.mark.parametrize(
    ("friction", "damping"),
    [
        ("friction", "undamped"),
        pytest.param("friction", "damped", marks=pytest.mark.nightly),
        pytest.param("frictionless", "undamped", marks=pytest.mark.nightly),
        ("frictionless", "damped"),
    ],
)
def test_low_end_is_quasi_static_and_does_not_ring(coarse, friction, damping, measured):
    """Limit: inertia and damping vanish; what the start left to ring would grow."""
    scene = coarse if friction == "friction" else frictionless(coarse)
    scene = scene if damping == "damped" else replace(scene, damping=None)
    does_not_ring(difference(scene, 0.01), f"0.01 Hz, {friction}, {damping}", measured)


def does_not_ring(cycles, case, measured):
    """What is `apart` in three cycles is little and does not grow."""
    measured(f"{case}: relative difference from quasi-static", cycles.max(), 1e-6, row=23)
    growth = cycles[2] / cycles[0] - 1.0
    measured(f"{case}: relative growth of this difference from first to third mesh cycle", growth, "0.05", row=23)
    assert cycles[2] <= 1.05 * cycles[0]


def test_high_end_is_the_rigid_mean_motion(coarse, measured):
    """Newton's law: the ripple meets mass alone and falls as 1/f^2; what the start leaves to ring shows as a drift
    of the cycles' means."""
    scene = frictionless(replace(coarse, damping=None))
    static = simulate(at(quasi_static(scene), 200.0)).transmission_error.values
    ripple = {}
    for mesh_frequency in (10e3, 20e3):
        cycles = int(mesh_frequency / 200.0)
        error = simulate(at(scene, mesh_frequency, cycles)).transmission_error.values
        means = error[1:].reshape(cycles, -1).mean(axis=1)
        ripple[mesh_frequency] = np.ptp(error[-41:])
        drift = np.ptp(means) / np.ptp(static)
        measured(
            f"{mesh_frequency / 1e3:g} kHz: vibration left from the start / static peak-to-peak value", drift, 0.01
        )
        assert means.mean() == pytest.approx(static.mean(), rel=0.01)
    order = np.log2(ripple[10e3] / ripple[20e3])
    measured("20 kHz: peak-to-peak value / static peak-to-peak value", ripple[20e3] / np.ptp(static), "0.01")
    measured("order of the peak-to-peak value in 1 / mesh frequency", order, "2")
    assert ripple[20e3] <= 0.01 * np.ptp(static)
    assert order == pytest.approx(2.0, abs=0.1)


def swept(scene, mesh_frequencies, frictions, cycles):
    """Runs, steps and steps by method of a sweep; raises where a step fails."""
    runs, steps, rungs = 0, 0, {}
    for mesh_frequency in mesh_frequencies:
        for friction in frictions:
            acting = None if friction == 0.0 else Friction(friction)
            result = simulate(replace(scene, friction=acting, motion=Motion(mesh_frequency, cycles, 1)))
            assert result.attrs["complete"] == 1 and np.all(np.isfinite(result.transmission_error.values))
            runs, steps = runs + 1, steps + result.attrs["steps"]
            for name, value in result.attrs.items():
                if name.startswith("steps_by_rung: "):
                    rungs[name[15:]] = rungs.get(name[15:], 0) + value
    return runs, steps, rungs


def _outcome(runs, steps, rungs):
    fallbacks = ", ".join(f"{name} {count}" for name, count in rungs.items() if name != NEWTON) or "none"
    return f"none in {steps} steps of {runs} runs; steps solved by fallbacks: {fallbacks}"


@pytest.mark.parametrize("count", [4, pytest.param(14, marks=pytest.mark.nightly)])
def test_no_step_fails_at_any_frequency_and_friction(coarse, measured, count):
    """Every step converges over six decades of mesh frequency, mu from 0 to 0.6."""
    pairs = zip(np.geomspace(0.01, 20e3, count), 2 * (0.0, 0.3, 0.05, 0.6, 0.1, 0.45, 0.2))
    told = [swept(coarse, [frequency], [friction], 3) for frequency, friction in pairs]
    rungs = {
        name: sum(found.get(name, 0) for _, _, found in told)
        for name in {name for _, _, found in told for name in found}
    }
    measured("failed steps, coarse", _outcome(sum(t[0] for t in told), sum(t[1] for t in told), rungs), "none")
    assert sum(t[0] for t in told) == count
