"""``[speed_ramp]``: the clock, the inertia forces of the accelerating frame, and what the section says when it is
wrong."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from tests.coarse import COARSE, frictionless
from tests.frozen_gears import GRID, frozen_marcher

from fenics_gears.contact.errors import ContactNotConverged
from fenics_gears.contact.mesh import elastic_mesh
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.dynamics.clock import SteadyClock
from fenics_gears.dynamics.energy_account import account
from fenics_gears.dynamics.march import Marcher
from fenics_gears.dynamics.speed_ramp import RampClock, inertia_forces
from fenics_gears.dynamics.stepping import EquationsOfMotion
from fenics_gears.dynamics.steps import Steps
from fenics_gears.dynamics.torque_ripple import varying_load
from fenics_gears.effects import effect_named, result_variables
from fenics_gears.effects.speed_ramp import SpeedRamp
from fenics_gears.effects.torque_ripple import Harmonic, TorqueRipple
from fenics_gears.elasticity.cache import user_cache
from fenics_gears.errors import SceneError
from fenics_gears.model.drivetrain import drivetrain
from fenics_gears.model.model import model_of
from fenics_gears.results.energy_variables import energy_variables
from fenics_gears.scene.data import Load, Motion
from fenics_gears.scene.read import scene_from_text
from fenics_gears.simulation.routes import prepared
from fenics_gears.simulation.simulate import simulate
from fenics_gears.system.progress import SilentProgress

DEMO = (Path(__file__).parents[2] / "demos" / "lundvall2004.toml").read_text(encoding="utf-8")
UP, DOWN = RampClock(100.0, 300.0, 80, 480, 40), RampClock(300.0, 100.0, 0, 400, 40)


def coarse(scene, cycles, recorded=None, start=200.0):
    """The scene on a coarse mesh, every cycle kept unless said."""
    return replace(scene, accuracy=COARSE, motion=Motion(start, cycles, recorded or cycles))


def test_the_section_is_read():
    """Authority: the section's own words; the ramp begins at once unless it is held."""
    assert scene_from_text(DEMO + '[speed_ramp]\nend_frequency = "260 Hz"\n').speed_ramp == SpeedRamp(260.0, 0)
    assert scene_from_text(DEMO + '[speed_ramp]\nend_frequency = "0.1 kHz"\nhold_cycles = 3\n').speed_ramp == SpeedRamp(
        100.0, 3
    )


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
    """Authority: house rule 7."""
    with pytest.raises(SceneError) as refused:
        scene_from_text(DEMO + f"[speed_ramp]\n{lines}\n")
    assert said in str(refused.value) and "Allowed: " in str(refused.value)


def test_a_ramp_needs_inertia():
    """Authority: without mass nothing depends on speed."""
    bare = re.sub(r"^\[(inertia|damping)\].*?(?=^\[)", "", DEMO, flags=re.M | re.S)
    with pytest.raises(SceneError) as refused:
        scene_from_text(bare + '[speed_ramp]\nend_frequency = "260 Hz"\n')
    assert "[speed_ramp]\n    needs the section [inertia]" in str(refused.value)


@pytest.mark.parametrize("clock", [UP, DOWN], ids=["up after a hold", "down"])
def test_the_clock_is_that_of_a_frequency_linear_in_time(clock):
    """Other solver: the phase n(t) = integral of f, f linear in t, integrated numerically, reaches each step at the
    clock's time."""
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


@pytest.mark.parametrize("clock", [UP, DOWN, SteadyClock(1e-4)], ids=["up", "down", "steady"])
def test_durations_add_up(clock):
    """Exact identity: parts of a step, and steps, add up to the time between; before the start the speed is the first
    one."""
    for first, middle, last in ((0, 0.25, 1), (70, 80, 90), (-1, 0, 1), (100, 200.5, 399)):
        whole = clock.duration(first, last)
        assert clock.duration(first, middle) + clock.duration(middle, last) == pytest.approx(whole, rel=1e-13)
        assert clock.time(last) - clock.time(first) == pytest.approx(whole, rel=1e-12)


def test_a_vanishing_ramp_is_a_steady_speed(paper_scene):
    """Exact limit: a ramp from 200 Hz to 200 Hz and 1e-12 of it leaves the result of a scene without the section, to
    round-off."""
    scene = coarse(paper_scene, 2)
    off, on = (simulate(replace(scene, speed_ramp=ramp)) for ramp in (None, SpeedRamp(200.0 * (1.0 + 1e-12))))
    assert set(on) - set(off) == {"mesh_frequency"} and set(on.coords) == set(off.coords)
    for name in [*off, "time"]:
        size = np.nanmax(np.abs(off["work_input" if name.startswith(("work_", "energy")) else name].values)) or 1.0
        assert on[name].values == pytest.approx(off[name].values, rel=1e-8, abs=1e-8 * size, nan_ok=True), name


def test_a_ramp_that_has_not_begun_is_a_steady_speed(paper_scene):
    """Exact: steps before the end of the hold are those of a scene without the section, bit by bit but for the load of
    zeros."""
    scene = coarse(paper_scene, 3, 3)
    off, on = (simulate(replace(scene, speed_ramp=ramp)) for ramp in (None, SpeedRamp(400.0, hold_cycles=2)))
    before = slice(0, 2 * 40)
    assert on.transmission_error.values[before] == pytest.approx(off.transmission_error.values[before], rel=1e-9)
    assert np.abs(on.transmission_error.values - off.transmission_error.values)[2 * 40 :].max() > 1e-6


def test_result_tells_time_and_frequency(paper_scene):
    """Exact: the last step stands at 2 n/(f0 + f1), at the frequency asked for; steps stand at equal phases, not at
    equal times."""
    result = simulate(replace(coarse(paper_scene, 4, start=100.0), speed_ramp=SpeedRamp(300.0)))
    assert float(result.time[-1]) == pytest.approx(2 * 4 / (100.0 + 300.0), rel=1e-13)
    assert [float(result.mesh_frequency[i]) for i in (0, -1)] == pytest.approx([100.0, 300.0], rel=1e-14)
    assert np.diff(result.mesh_phase.values) == pytest.approx(1 / 40)
    slopes = np.diff(result.mesh_frequency.values) / np.diff(result.time.values)
    assert slopes == pytest.approx(slopes[0], rel=1e-9)


def test_the_right_side_is_minus_mass_times_acceleration_by_finite_differences(paper_scene, paper_pair):
    """Finite differences: kinetic energy of all wheels in the nominal motion; its rate is the power against the inertia
    forces."""
    shafts = drivetrain(paper_scene, paper_pair)
    forces = inertia_forces(DOWN, shafts, 24)(100)
    inertia, step = paper_scene.inertia.moment_of_inertia, 1e-3

    def energy(at):
        pinion, wheel = (2.0 * np.pi * DOWN.mesh_frequency(at) / teeth for teeth in (16, 24))
        return 0.5 * inertia * (pinion**2 + 2.0 * wheel**2)

    power = (energy(100 + step) - energy(100 - step)) / DOWN.duration(100 - step, 100 + step)
    arc = paper_pair.base_pitch * DOWN.mesh_frequency(100)
    velocity = np.array([{"rotation_1": arc, "rotation_2": -arc}.get(name, 0.0) for name in shafts.coordinates])
    assert -forces @ velocity == pytest.approx(power, rel=1e-8)
    wheel_angular_acceleration = -2.0 * np.pi * DOWN.acceleration / 24
    twist = shafts.coordinates.index("shaft_twist")
    assert forces[twist] * shafts.radii[twist] == pytest.approx(-inertia * wheel_angular_acceleration, rel=1e-12)


@pytest.mark.parametrize("absent", [(), ("shafts",), ("shafts", "bearings")], ids=["all", "without shafts", "rigid"])
def test_spin_up_at_rest_changes_the_mesh_force_by_inertia_times_acceleration(
    paper_scene, paper_pair, stand_in_flanks, absent
):
    """Exact: in a frame that accelerates evenly, gears that do not roll stand still, and the mesh carries T/rb2 and J
    alpha/rb2 of all
    that turns behind it: the wheel, and the shaft's end where there is one."""
    scene = replace(paper_scene, friction=None, damping=None, **dict.fromkeys(absent))
    for clock in (UP, DOWN):
        marcher, shafts = frozen_marcher(scene, paper_pair, stand_in_flanks, 1e-4)
        marcher.loads = (inertia_forces(clock, shafts, 24),)
        behind = 1 if "shafts" in absent else 2
        alpha = 2.0 * np.pi * clock.acceleration / 24
        expected = (437e3 + behind * 24.5 * alpha) / paper_pair.wheel.base_radius
        step = clock.held + 10
        for at, force in (
            (step, expected),
            (clock.held, expected if clock.held == 0 else 0.5 * (expected + 437e3 / paper_pair.wheel.base_radius)),
        ):
            rest = marcher._static_start(at)
            n = rest.position.operator.nodes
            assert rest.solution.forces[:n].sum() == pytest.approx(force, rel=1e-10)


def test_mean_mesh_force_while_rolling_is_the_momentum_balance(paper_scene, paper_pair, stand_in_flanks):
    """Exact identity of average acceleration: over any time the mean mesh force, by trapezoids, is (T + J alpha)/rb2
    less J/rb2^2 times
    the change of the wheel's own velocity over the time passed; rigid shafts, no friction."""
    scene = replace(paper_scene, friction=None, damping=None, shafts=None, bearings=None)
    shafts, clock = drivetrain(scene, paper_pair), RampClock(100.0, 140.0, 0, 6 * 50, 50)
    cycle = Cycle(elastic_mesh(stand_in_flanks, GRID), 50, shafts.indices, tangential=False)
    marcher = Marcher(
        cycle, EquationsOfMotion(shafts, clock.duration(0, 1), clock=clock, loads=(inertia_forces(clock, shafts, 24),))
    )
    records = list(marcher.run(6 * 50, 6 * 50 + 1).records)
    force = np.array([record.solution.forces.sum() for record in records])
    steps = np.array([clock.duration(a.step, b.step) for a, b in zip(records[:-1], records[1:])])
    mean = float((0.5 * (force[1:] + force[:-1]) * steps).sum() / steps.sum())
    radius, alpha = paper_pair.wheel.base_radius, 2.0 * np.pi * clock.acceleration / 24
    gained = shafts.mass[0, 0] * float(records[-1].state.velocity[0] - records[0].state.velocity[0]) / steps.sum()
    assert mean + gained == pytest.approx((437e3 + 24.5 * alpha) / radius, rel=1e-10)
    assert 24.5 * alpha > 1e-3 * 437e3


def test_a_slow_ramp_follows_the_steady_runs(paper_scene):
    """Known limit: a ramp that takes 200 mesh cycles from 300 to 350 Hz, clear of resonance, has in each cycle the
    peak-to-peak transmission error
    of a steady run at the cycle's frequency, within 2 %."""
    scene = frictionless(paper_scene)
    model = model_of(replace(coarse(scene, 200, 1, start=300.0), speed_ramp=SpeedRamp(350.0)))
    _, cycle = prepared(model, SilentProgress(), user_cache())
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


@pytest.mark.parametrize("absent", [(), ("friction",), ("damping",), ("shafts",), ("shafts", "bearings", "friction")])
@pytest.mark.parametrize("ramp", [SpeedRamp(150.0), SpeedRamp(600.0, hold_cycles=1)], ids=["down", "up after a hold"])
def test_the_energy_account_closes(paper_scene, ramp, absent):
    """Exact identity: with steps of unequal length and inertia forces as a load the account closes to round-off."""
    result = simulate(replace(coarse(paper_scene, 3), speed_ramp=ramp, **dict.fromkeys(absent)))
    taken = result.work_output + result.get("work_damping", 0.0) + result.get("work_friction", 0.0)
    defect = result.energy - result.energy[0] - (result.work_input - taken + result.work_contact_changes)
    done = float(result.work_input[-1])
    assert float(np.abs(defect).max()) <= 1e-9 * done
    assert float(np.abs(result.energy_defect).max()) <= 1e-9 * done


def test_the_energy_account_closes_over_divided_steps(paper_scene, paper_pair, stand_in_flanks):
    """Exact identity: where every step is divided, into parts of unequal length under loads that vary, the account
    closes as well."""
    shafts = drivetrain(paper_scene, paper_pair)
    cycle = Cycle(elastic_mesh(stand_in_flanks, GRID), 50, shafts.indices, tangential=True)
    clock = RampClock(100.0, 400.0, 0, 2 * 50, 50)
    ripple = varying_load(TorqueRipple((Harmonic(30.0, 50e3),)), shafts, 2.0 * np.pi / (24 * 50))
    loads = (inertia_forces(clock, shafts, 24), ripple)
    marcher = Marcher(cycle, EquationsOfMotion(shafts, clock.duration(0, 1), 0.1, clock=clock, loads=loads))
    records = [marcher.start()]
    for step in range(1, 101):
        records.append(marcher._divided(marcher.scheme(step), records[-1], step, None, 1))
    assert all(len(record.parts) == 2 for record in records[1:])
    steps = Steps.of(records)
    work = account(shafts, clock, steps, energy_variables(paper_scene, shafts, steps)["energy"], loads)
    assert np.abs(work.defect).max() <= 1e-9 * np.abs(np.diff(work.load)).sum()


def test_the_drive_also_gives_the_kinetic_energy_of_the_nominal_motion(paper_scene):
    """Exact: of rigidly driven gears the output, less the couple's and the deviation's part, is the kinetic energy that
    the wheel gains."""
    scene = replace(
        coarse(frictionless(paper_scene), 4), shafts=None, bearings=None, damping=None, speed_ramp=SpeedRamp(300.0)
    )
    result = simulate(scene)
    turning, phase = 2.0 * np.pi * result.mesh_frequency.values / 24, result.mesh_phase.values
    nominal = 0.5 * 24.5 * (turning**2 - turning[0] ** 2)
    deviation = result.rotation.sel(gear="wheel").values
    alpha = 2.0 * np.pi * (300.0 - 200.0) / float(result.time[-1]) / 24
    expected = 437e3 * 2.0 * np.pi * phase / 24 + nominal - (437e3 + 24.5 * alpha) * (deviation - deviation[0])
    assert result.work_output.values == pytest.approx(expected, rel=1e-9, abs=1e-9 * expected[-1])


def test_warnings_and_steps_go_by_the_range_of_frequencies(paper_scene):
    """Authority: a run's longest step is at its lowest frequency, whichever end that is, and hardly shorter than a
    steady one there."""
    up = replace(
        paper_scene,
        motion=Motion(50.0, 30, 2),
        speed_ramp=SpeedRamp(500.0),
        accuracy=replace(COARSE, steps_per_mesh_cycle=None),
    )
    down = replace(up, motion=Motion(500.0, 30, 2), speed_ramp=SpeedRamp(50.0))
    slow = model_of(replace(up, speed_ramp=None))
    assert (
        model_of(up).resolution.steps_per_mesh_cycle
        == model_of(down).resolution.steps_per_mesh_cycle
        == slow.resolution.steps_per_mesh_cycle
    )
    for ramp in (model_of(up), model_of(down)):
        steps = [ramp.clock.duration(step, step + 1) for step in range(ramp.steps)]
        assert ramp.time_step == pytest.approx(max(steps), rel=1e-12)
        assert 0.9 * slow.time_step < ramp.time_step < slow.time_step
    # Inertia does not matter at 0.5 Hz, but it does at the other end.
    crawling = replace(up, motion=Motion(0.5, 30, 2), speed_ramp=None)
    assert any("inertia hardly matters" in said for said in model_of(crawling).warnings)
    assert not any(
        "inertia hardly matters" in said for said in model_of(replace(crawling, speed_ramp=SpeedRamp(200.0))).warnings
    )


def test_a_ramp_to_a_crawl_says_what_its_slow_end_does_to_the_whole_run(paper_scene):
    """Authority: the rule of `dynamics.time_scales`, half the slowest period, on the ramp's true steps; above the
    frequency that the warning
    names, which is that of a steady run, it is gone. A crawl is passed in few steps, none of them as long as its
    frequency would have."""
    crawl = replace(coarse(paper_scene, 20), speed_ramp=SpeedRamp(0.01))
    assert not model_of(crawl).time_scales.samples_vibration
    (said,) = [warning for warning in model_of(crawl).warnings if "backward Euler" in warning]
    needed = float(re.search(r"above ([\d.e+]+) Hz", said)[1])
    assert model_of(replace(crawl, speed_ramp=SpeedRamp(1.01 * needed))).time_scales.samples_vibration
    steady = 1.0 / (0.01 * model_of(crawl).resolution.steps_per_mesh_cycle)
    assert model_of(crawl).time_step < 0.01 * steady


def test_without_the_section_there_is_nothing_of_it(paper_scene):
    """House rule 9: no variable, one clock of equal steps. What is imported is told by test_every_effect.py."""
    model = model_of(paper_scene)
    assert isinstance(model.clock, SteadyClock) and model.loads == ()
    assert not {variable.name for variable in effect_named("speed_ramp").variables} & {
        variable.name for variable in result_variables(paper_scene)
    }


def test_a_ramp_that_pulls_the_flanks_apart_is_named(paper_scene):
    """Mechanics: a falling speed decelerates the wheel by more than its torque does, and nothing holds the flanks
    together at the start."""
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
