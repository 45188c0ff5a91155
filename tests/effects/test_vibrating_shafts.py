"""Shafts that bend and vibrate, on bodies without finite elements."""

import numpy as np
import pytest
from tests.elastic_shaft_scenes import FEW, INERTIA, VIBRATING
from tests.hard_cases.invariants import cycle_of, run_of
from tests.helical import helical_scene, on_stand_in_bodies

from fenics_gears import model_of
from fenics_gears.dynamics.march import Marcher
from fenics_gears.model.description import describe
from fenics_gears.results.summary import summary_rows


def test_a_shaft_that_vibrates_keeps_the_balance_of_energy():
    """Exact: the account closes; the mesh's natural frequency is there."""
    more = VIBRATING + "[friction]\ncoefficient = 0.05\n[damping]\nratio = 0.05\n"
    model = model_of(helical_scene(more, offset=2.0, accuracy=FEW.replace("= 8", "= 64"), frequency=800.0))
    found = run_of(model, on_stand_in_bodies(model))
    assert found.failure is None
    assert any("_mode_" in name for name in model.drivetrain.coordinates)
    result = found.result
    assert np.abs(result["energy_defect"].values).max() <= 1e-10 * result["energy"].values.max()
    assert result["energy_kinetic"].values.max() > 1e-3 * result["energy"].values.max()
    lines = result.attrs["natural_frequencies"].splitlines()
    assert sum("mesh springs" in line for line in lines) >= 1
    assert float(lines[-1].split()[0]) <= model.drivetrain.right_up_to


def test_what_is_said_of_shafts_that_vibrate():
    """Closed forms: density times volume, the reduced mass along the line of action, the condensed shaft's
    compliance."""
    scene = helical_scene(VIBRATING, accuracy=FEW, frequency=800.0)
    said = {label: value for _, rows in describe(scene) for label, value, _ in rows}
    volume = 0.25 * np.pi * ((28.0**2 - 8.0**2) * 40.0 + 35.0**2 * 90.0)
    assert said["mass of the pinion's shaft"] == pytest.approx(7.85e-6 * volume, rel=1e-12)
    model = model_of(scene)
    along = [2000.0 / getattr(model.pair, gear).base_radius ** 2 for gear in ("pinion", "wheel")]
    reduced = said["reduced mass J1 J2/(J1 rb2^2 + J2 rb1^2)"]
    assert reduced == pytest.approx(along[0] * along[1] / sum(along), rel=1e-12)
    per_newton = np.linalg.inv(model.drivetrain.elastic[0].stiffness)
    words = said["its stiffness at the pinion"]
    assert [float(part.split()[0]) for part in words.split(", ")] == pytest.approx(
        [1e-3 / per_newton[axis, axis] for axis in range(3)], rel=1e-3
    )
    result = run_of(model, on_stand_in_bodies(model)).result
    result.attrs |= {"base_radius_wheel": model.pair.wheel.base_radius}
    printed = {label: value for label, value, *_ in summary_rows(result)}
    largest = np.sqrt(sum(result[f"bearing_force_{axis}"].values ** 2 for axis in "xyz")).max()
    assert float(printed["largest force of a bearing"].split()[0]) == pytest.approx(largest, rel=1e-3)
    lowest = result.attrs["natural_frequencies"].splitlines()[0].split()[0]
    assert float(printed["natural frequencies"].split()[0]) == pytest.approx(float(lowest), rel=1e-3)


def test_a_slow_run_with_inertia_is_the_quasi_static_one():
    """Limit: a hundredth of a mesh cycle a second."""
    runs = []
    for more in (VIBRATING, VIBRATING.replace(INERTIA, "")):
        model = model_of(helical_scene(more, offset=2.0, accuracy=FEW, frequency=0.01))
        runs.append(run_of(model, on_stand_in_bodies(model)).result)
    moving, still = runs
    for name in ("transmission_error", "bearing_force_x", "bearing_moment_y", "tilt_y", "shaft_deflection_x"):
        different = np.nanmax(np.abs(moving[name].values - still[name].values))
        assert different <= 1e-9 * np.nanmax(np.abs(still[name].values))


@pytest.mark.parametrize("more", ["", "[friction]\ncoefficient = 0.05\n"])
def test_a_march_that_eliminates_modes_is_the_one_that_keeps_them(more):
    """Brute force: plain steps solve for modes with all else."""
    model = model_of(helical_scene(VIBRATING + more, accuracy=FEW.replace("= 8", "= 64"), frequency=800.0))
    cycle, found = cycle_of(model, on_stand_in_bodies(model)), []
    for plain in (False, True):
        march = Marcher(cycle, model.equations_of_motion, plain).run(model.steps, model.steps + 1)
        states, step = [each.state for each in march.records], model.equations_of_motion.time_step
        found.append(np.array([[each.position, step * each.velocity] for each in states]))
    assert any("_mode_" in name for name in model.drivetrain.coordinates)
    one, other = found
    np.testing.assert_allclose(one, other, rtol=0.0, atol=1e-12 * np.abs(other[:, 0]).max())
