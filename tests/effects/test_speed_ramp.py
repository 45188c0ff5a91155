"""``[speed_ramp]``."""

import re
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from tests.coarse import COARSE, cycle_of, frictionless
from tests.frozen_gears import frozen_marcher
from tests.paper_text import PAPER as DEMO

from fenics_gears import Load, SceneError, model_of, scene_from_text, simulate
from fenics_gears.contact.errors import ContactNotConverged
from fenics_gears.dynamics.march import Marcher
from fenics_gears.dynamics.speed_ramp import RampClock, inertia_forces
from fenics_gears.effects.speed_ramp import SpeedRamp
from fenics_gears.scene.data import Motion

UP, DOWN = RampClock(100.0, 300.0, 80, 480, 40), RampClock(300.0, 100.0, 0, 400, 40)


def coarse(scene, cycles, recorded=None, start=200.0):
    return replace(scene, accuracy=COARSE, motion=Motion(start, cycles, recorded or cycles))


@pytest.mark.parametrize(
    ("lines", "said"),
    [
        ("", "end_frequency\n    is missing"),
        ('end_frequency = "200 Hz"', "is the frequency at the start"),
        ('end_frequency = "260 Hz"\nhold_cycles = 30', "leaves no cycle of motion.mesh_cycles = 30"),
        ('end_frequency = "0 Hz"', "is zero"),
    ],
)
def test_a_wrong_section_is_refused(lines, said):
    """House rule 7."""
    with pytest.raises(SceneError) as refused:
        scene_from_text(DEMO + f"[speed_ramp]\n{lines}\n")
    assert said in str(refused.value) and "Allowed: " in str(refused.value)


@pytest.mark.parametrize("clock", [UP, DOWN], ids=["up after a hold", "down"])
def test_the_clock_is_that_of_a_frequency_linear_in_time(clock):
    """Other solver: the integral of f, linear in t, reaches each step at the clock's time."""
    begins, ends = clock.time(clock.held), clock.time(clock.last)
    assert begins == pytest.approx(clock.held / 40 / clock.start, rel=1e-14)
    slope = (clock.end - clock.start) / (ends - begins)
    assert slope == pytest.approx(clock.acceleration, rel=1e-12)

    def frequency(t):
        return clock.start + slope * np.maximum(t - begins, 0.0)

    steps = np.linspace(0, clock.last, 23)
    times = [clock.time(step) for step in steps]
    phases = solve_ivp(
        lambda t, n: [frequency(t)], (0.0, ends), [0.0], t_eval=times[:-1], rtol=1e-11, atol=1e-12, max_step=ends / 50
    ).y[0]
    assert phases * 40 == pytest.approx(steps[:-1], rel=1e-8, abs=1e-8)
    assert [clock.mesh_frequency(step) for step in steps] == pytest.approx(frequency(np.array(times)), rel=1e-12)


def test_result_tells_time_and_frequency(paper_scene):
    """Exact: 2 n/(f0 + f1); equal phases, not equal times."""
    result = simulate(replace(coarse(paper_scene, 4, start=100.0), speed_ramp=SpeedRamp(300.0)))
    assert float(result.time[-1]) == pytest.approx(2 * 4 / (100.0 + 300.0), rel=1e-13)
    assert [float(result.mesh_frequency[i]) for i in (0, -1)] == pytest.approx([100.0, 300.0], rel=1e-14)
    assert np.diff(result.mesh_phase.values) == pytest.approx(1 / 40)
    slopes = np.diff(result.mesh_frequency.values) / np.diff(result.time.values)
    assert slopes == pytest.approx(slopes[0], rel=1e-9)


@pytest.mark.parametrize("absent", [(), ("shafts",), ("shafts", "bearings")], ids=["all", "without shafts", "rigid"])
def test_spin_up_at_rest_changes_the_mesh_force_by_inertia_times_acceleration(
    paper_scene, paper_pair, stand_in_flanks, absent
):
    """Exact: the mesh carries T/rb2 and J alpha/rb2 of all that turns behind it."""
    scene = replace(paper_scene, friction=None, damping=None, **dict.fromkeys(absent))
    for clock in (UP, DOWN):
        marcher, shafts = frozen_marcher(scene, paper_pair, stand_in_flanks, 1e-4)
        marcher.stepper.loads = (
            inertia_forces(clock, 2.0 * np.pi / paper_pair.pinion.teeth * shafts.nominal_momentum),
        )
        behind = 1 if "shafts" in absent else 2
        alpha = 2.0 * np.pi * clock.acceleration / 24
        expected = (437e3 + behind * 24.5 * alpha) / paper_pair.wheel.base_radius
        step = clock.held + 10
        for at, force in (
            (step, expected),
            (clock.held, expected if clock.held == 0 else 0.5 * (expected + 437e3 / paper_pair.wheel.base_radius)),
        ):
            rest = marcher.stepper.in_balance(at, marcher.cycle.position(at))
            n = rest.position.operator.nodes
            assert rest.solution.forces[:n].sum() == pytest.approx(force, rel=1e-10)


def test_a_slow_ramp_follows_the_steady_runs(paper_scene):
    """Known limit: from 300 to 350 Hz in 200 mesh cycles, T_EPP of a steady run at each cycle's frequency, within 2
    %."""
    scene = frictionless(paper_scene)
    model = model_of(replace(coarse(scene, 200, 1, start=300.0), speed_ramp=SpeedRamp(350.0)))
    cycle = cycle_of(model)
    # Every step is kept, but without pressures.
    marcher = Marcher(cycle, model.equations_of_motion)
    records = marcher.run(model.steps, model.steps + 1).records
    states = np.array([record.state.position for record in records])
    error = model.drivetrain.value(states, "rotation_2") + 16 / 24 * model.drivetrain.value(states, "rotation_1")
    frequency = np.array([model.clock.mesh_frequency(record.step) for record in records])
    for number in (100, 190):
        within = slice(40 * number, 40 * (number + 1) + 1)
        steady = simulate(coarse(scene, 60, 1, start=float(frequency[within].mean())))
        assert np.ptp(error[within]) == pytest.approx(steady.attrs["peak_to_peak_transmission_error"], rel=0.02)


def test_a_ramp_to_a_crawl_says_what_its_slow_end_does_to_the_whole_run(paper_scene):
    """The rule of `dynamics.clock`, half the slowest period, on the ramp's true steps."""
    crawl = replace(coarse(paper_scene, 20), speed_ramp=SpeedRamp(0.01))
    assert not model_of(crawl).time_scales.samples_vibration
    (said,) = [warning for warning in model_of(crawl).warnings if "backward Euler" in warning]
    needed = float(re.search(r"above ([\d.e+]+) Hz", said)[1])
    assert model_of(replace(crawl, speed_ramp=SpeedRamp(1.01 * needed))).time_scales.samples_vibration
    steady = 1.0 / (0.01 * model_of(crawl).resolution.steps_per_mesh_cycle)
    assert model_of(crawl).time_step < 0.01 * steady


def test_a_ramp_that_pulls_the_flanks_apart_is_named(paper_scene):
    """Mechanics: a falling speed decelerates the wheel by more than its torque does."""
    scene = replace(
        coarse(frictionless(paper_scene), 2, start=5000.0),
        speed_ramp=SpeedRamp(500.0),
        load=Load(500.0),
        damping=None,
        shafts=None,
        bearings=None,
    )
    with pytest.raises(
        ContactNotConverged, match=r"pulls the flanks apart.*\[speed_ramp\] with .* N, .*motion.mesh_cycles"
    ):
        simulate(scene)
