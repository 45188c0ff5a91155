"""Row 4: energy over a step, and the account of where it goes."""

from dataclasses import replace

import numpy as np
import pytest
from tests.coarse import COARSE
from tests.frozen_gears import frozen_marcher, pushed

from fenics_gears import gear_pair, simulate
from fenics_gears.dynamics.energy_account import contact_work
from fenics_gears.dynamics.steps import Record, Steps
from fenics_gears.dynamics.time_integration import State
from fenics_gears.dynamics.torque_ripple import Harmonic, TorqueRipple
from fenics_gears.effects.speed_ramp import SpeedRamp
from fenics_gears.results.contact_variables import energy_variables
from fenics_gears.scene.data import Motion


def march(marcher, record, steps):
    records = [record]
    for step in range(1, steps + 1):
        records.append(marcher.stepper.step(marcher.stepper.dynamic, records[-1], step))
    return records


@pytest.mark.parametrize("damped", [True, False])
@pytest.mark.parametrize("speed", [200.0, 2000.0])
def test_frozen_frictionless_step_balances(paper_scene, paper_pair, stand_in_flanks, measured, damped, speed):
    """Exact identity of average acceleration with Signorini contact: change of energy = work of the loads + 1/2
    sum(p0 g1 - p1 g0) - damping."""
    scene = replace(paper_scene, friction=None, damping=paper_scene.damping if damped else None)
    marcher, shafts = frozen_marcher(scene, paper_pair, stand_in_flanks, 2e-5)
    records = march(marcher, pushed(marcher, shafts, rotation_1=speed), 400)
    steps = Steps.of(records)
    energy = energy_variables(scene, shafts, steps)["energy"]
    changes, defect, work = [], [], []
    for (last, record), gained in zip(zip(records[:-1], records[1:]), np.diff(energy)):
        n = record.position.operator.nodes
        opening = [each.position.operator.gap - each.solution.displacement[:n] for each in (last, record)]
        moved = record.state.position - last.state.position
        lost = 0.0 if shafts.damping is None else moved @ shafts.damping @ moved / marcher.stepper.time_step
        changes.append(0.5 * (last.solution.forces @ opening[1] - record.solution.forces @ opening[0]))
        defect.append(gained - (shafts.load @ moved + changes[-1] - lost))
        work.append(abs(shafts.load @ moved) + abs(gained) + lost)
    assert contact_work(steps).changes == pytest.approx(changes, abs=1e-9 * max(work))
    closed = [np.count_nonzero(record.solution.status) for record in records]
    assert len(set(closed)) > 1
    worst = np.abs(defect).max() / max(work)
    measured(
        f"{'damped' if damped else 'undamped'}, started with {speed:g} mm/s: defect of a step / work of the step",
        worst,
        1e-11,
    )


@pytest.mark.parametrize("most", [60, pytest.param(400, marks=pytest.mark.nightly)])
def test_undamped_bounce_is_bounded(paper_scene, paper_pair, stand_in_flanks, measured, most):
    """Known: what the algorithm takes at impacts it gives back at releases."""
    scene = replace(paper_scene, friction=None, damping=None, shafts=None, bearings=None)
    marcher, shafts = frozen_marcher(scene, paper_pair, stand_in_flanks, 2e-5)
    rest = marcher.start()[0]
    lifted = State(rest.state.position - 0.1, np.zeros(1), shafts.load / shafts.mass[0])
    nothing = replace(rest.solution, forces=0.0 * rest.solution.forces, status=np.zeros_like(rest.solution.status))
    record = Record(0, lifted, rest.position, nothing)
    energies, flights, flying, dropped = [], 0, True, 0.1 * shafts.load[0]
    for _ in range(100_000):
        record = marcher.stepper.step(marcher.stepper.dynamic, record, 1)
        energies.append(total_energy(record, shafts) - total_energy(rest, shafts))
        loaded = bool(np.any(record.solution.forces))
        flights += flying and loaded
        flying = not loaded
        if flights == most:
            break
    largest, smallest = max(energies) / dropped, min(energies) / dropped
    measured(f"undamped bounce, {most} flights: largest energy / initial energy", largest, "1.1")
    measured(f"undamped bounce, {most} flights: smallest energy / initial energy", smallest, "at least 0.9")
    assert flights == most
    assert 0.9 <= smallest <= largest <= 1.1


def total_energy(record, shafts):
    """Kinetic energy, that of the teeth and of the load (N mm) of a drivetrain without springs."""
    x, v, forces = record.state.position, record.state.velocity, record.solution.forces
    loaded = np.flatnonzero(forces)
    teeth = 0.5 * forces[loaded] @ record.position.operator.compliance[np.ix_(loaded, loaded)] @ forces[loaded]
    return 0.5 * v @ shafts.mass @ v + teeth - shafts.load @ x


RIPPLE = TorqueRipple((Harmonic(24.0, 30e3, 0.4), Harmonic(2.5, 10e3)))
RUNS = {
    "all effects": {},
    **{
        f"without {', '.join(absent)}": dict.fromkeys(absent)
        for absent in (("friction",), ("damping",), ("inertia", "damping"), ("shafts", "bearings", "friction"))
    },
    "torque ripple": {"torque_ripple": RIPPLE},
    "torque ripple, quasi-static": {"torque_ripple": RIPPLE, "inertia": None, "damping": None},
    "falling speed": {"speed_ramp": SpeedRamp(150.0)},
    "rising speed, rigid shafts": {"speed_ramp": SpeedRamp(600.0, hold_cycles=1), "shafts": None, "bearings": None},
}


def run_of_two_cycles(scene, name):
    return simulate(replace(scene, accuracy=COARSE, motion=Motion(200.0, 3, 2), **RUNS[name]))


def account_defect(result):
    """Energy gained less input, output, damping, friction and changes of contact, N mm, over time."""
    taken = result.work_output + result.get("work_damping", 0.0) + result.get("work_friction", 0.0)
    return result.energy - result.energy[0] - (result.work_input - taken + result.work_contact_changes)


@pytest.mark.parametrize("name", RUNS)
def test_account_of_a_run_closes(paper_scene, measured, name):
    """Exact identity, the geometry moving, also under a couple that varies and with steps of unequal length."""
    result = run_of_two_cycles(paper_scene, name)
    defect, done = account_defect(result), float(result.work_input[-1])
    measured(f"rotating gears, {name}: defect / work of the drive", float(np.abs(defect).max()) / done, "1e-9")
    assert float(np.abs(defect).max()) <= 1e-9 * done
    assert result.energy_defect.values == pytest.approx(defect.values, abs=1e-9 * done)


def test_friction_loss_is_that_of_the_literature(paper_scene, measured):
    """Niemann/Winter, Maschinenelemente 2: P/P0 = mu H_v, H_v = pi (u + 1)/(z1 u) (1 - e + e1^2 + e2^2), for a load
    whole on a single pair and half on each of two; elastic teeth share it more smoothly, by some per cent."""
    loss, factor = friction_loss(paper_scene), loss_factor(paper_scene)
    measured(
        "friction loss of the paper's pair at mu = 0.1 (quasi-static)",
        loss,
        f"{0.1 * factor:.4f} by Niemann/Winter, 5 %",
    )
    assert loss == pytest.approx(0.1 * factor, rel=0.05)


def friction_loss(scene):
    """Of a scene without inertia, over the drive's work."""
    still = replace(scene, inertia=None, damping=None, accuracy=COARSE, motion=Motion(200.0, 2, 2))
    return simulate(still).attrs["friction_loss"]


def loss_factor(scene):
    """H_v of the formula."""
    pair = gear_pair(scene.gears)
    z_1, ratio = scene.gears.pinion.teeth, scene.gears.wheel.teeth / scene.gears.pinion.teeth
    pitch_point = (
        pair.line_of_action_length * pair.pinion.base_radius / (pair.pinion.base_radius + pair.wheel.base_radius)
    )
    approach, recess = (
        (pitch_point - pair.path_start) / pair.base_pitch,
        (pair.path_end - pitch_point) / pair.base_pitch,
    )
    return np.pi * (ratio + 1.0) / (z_1 * ratio) * (1.0 - approach - recess + approach**2 + recess**2)
