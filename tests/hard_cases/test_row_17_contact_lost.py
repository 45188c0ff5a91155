"""Row 17: the teeth part, fly free, cross the backlash, touch behind and come back."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import expm
from tests.coarse import COARSE, coarse_scene, cycle_of, frictionless, quasi_static
from tests.frozen_gears import frozen_marcher

from fenics_gears import model_of, simulate
from fenics_gears.dynamics.march import Marcher
from fenics_gears.effects.coast_flanks import CoastFlanks
from fenics_gears.results.dataset import RunResult
from fenics_gears.results.recorder import Recorder
from fenics_gears.scene.data import Motion
from fenics_gears.show.motion import pair_forces
from fenics_gears.show.run import ShownRun

FINE = replace(COARSE, steps_per_mesh_cycle=100)


@pytest.fixture(scope="module")
def both_flanks(paper_scene):
    return replace(frictionless(coarse_scene(paper_scene)), coast_flanks=CoastFlanks(), motion=Motion(200.0, 1, 1))


def backwards(scene):
    return replace(scene, load=replace(scene.load, wheel_torque=-scene.load.wheel_torque))


def with_torque(scene, part):
    """The result of a scene whose load is multiplied by `part(step)`; it starts in equilibrium under the whole load."""
    model = model_of(scene)
    cycle = cycle_of(model)
    change = (lambda step: (part(step) - 1.0) * model.drivetrain.load,)
    marcher = Marcher(cycle, replace(model.equations_of_motion, loads=change))
    recorder = Recorder(model, cycle, loads=change)
    return RunResult(recorder, marcher.run(model.steps, 1, observe=recorder.take)).dataset


@pytest.mark.parametrize("absent", [("shafts", "bearings"), ()], ids=["teeth alone", "whole drivetrain"])
def test_reversed_torque_is_the_mirror_image(both_flanks, paper_pair, absent, measured):
    """Symmetry, after crossing the backlash; only to 0.5 %, since the tips pass 0.1 mm beside where small
    displacements have them, 0.75 % of a base pitch."""
    scene = replace(quasi_static(both_flanks), accuracy=FINE, **dict.fromkeys(absent))
    forward, backward = simulate(scene), simulate(backwards(scene))
    assert np.all(backward.normal_force.values == 0.0)
    assert backward.coast_normal_force.values == pytest.approx(forward.normal_force.values, rel=1e-9)
    crossed = -backward.transmission_error.values - paper_pair.backlash / paper_pair.wheel.base_radius
    apart = [abs(of(crossed) / of(forward.transmission_error.values) - 1.0) for of in (np.mean, np.min, np.max)]
    measured(
        f"static reversal, {'without shafts and bearings' if absent else 'with shafts and bearings'}: relative"
        " difference from the mirror image",
        max(apart),
        5e-3,
    )
    assert backward.reaction_couple.sel(gear="wheel").values == pytest.approx(scene.load.wheel_torque, rel=1e-9)
    assert backward.coast_flank_opening.values.max() <= 1e-12
    lowest = min(np.nanmin(curve.y) for curve in next(pair_forces(ShownRun(backward))).curves)
    assert lowest == pytest.approx(-backward.pair_coast_normal_force.values.max())


def test_sudden_release_flies_to_the_coast_flanks_and_comes_back(both_flanks, paper_pair, measured):
    """Newton's first law: on rigid shafts the wheel crosses the backlash at constant speed."""
    scene = replace(both_flanks, damping=None, bearings=None, shafts=None, accuracy=FINE, motion=Motion(200.0, 12, 12))
    result = with_torque(scene, lambda step: 0.0 if step > 20 else 1.0)
    driving, coasting = result.normal_force.values > 0.0, result.coast_normal_force.values > 0.0
    free = ~driving & ~coasting
    assert not np.any(driving & coasting)
    touches = [flank for before, now, flank in _touches(driving, coasting)]
    assert {"drive", "coast"} <= set(touches) and touches.index("coast") < len(touches) - 1 - touches[::-1].index(
        "drive"
    )
    place = result.rotation.sel(gear="wheel").values * paper_pair.wheel.base_radius
    inside = free[:-2] & free[1:-1] & free[2:] & (np.arange(len(free) - 2) > 20)
    bend = np.abs(np.diff(place, 2))[inside].max() / np.ptp(place)
    measured("sudden release: change of the motion per step in flight / motion per step", bend, 1e-12)
    openings = (result.drive_flank_opening.values + result.coast_flank_opening.values)[
        free & (np.arange(len(free)) > 20)
    ]
    apart = np.abs(openings / paper_pair.backlash - 1.0).max()
    measured("sudden release: gaps of both flanks in flight / backlash - 1", apart, 0.01)
    assert result.attrs["contact_loss_count"] >= 1 and result.attrs["contact_loss_opening"] >= paper_pair.backlash


def _touches(driving, coasting):
    """Steps at which a flank begins to touch: (step before, step, "drive" or "coast"), in order."""
    found = []
    for name, touching in (("drive", driving), ("coast", coasting)):
        found += [(step, step + 1, name) for step in np.flatnonzero(~touching[:-1] & touching[1:])]
    return sorted(found)


def test_flight_of_the_whole_drivetrain_follows_the_matrix_exponential(
    paper_scene, paper_pair, stand_in_flanks, measured
):
    """Exact solution: the exponential of the linear system, approached with order 2; each step is that of the
    drivetrain without gears."""
    errors = []
    for count in (100, 200, 400):
        step = 2e-3 / count
        marcher, shafts = frozen_marcher(paper_scene, paper_pair, stand_in_flanks, step)
        away = -np.eye(len(shafts.coordinates))[shafts.coordinates.index("rotation_2")]
        start = marcher.start()[0]
        inverse = np.linalg.inv(shafts.mass)
        position, velocity = start.state.position + 0.5 * away, 50.0 * away
        marcher.stepper.loads = (lambda step, shafts=shafts: -shafts.load,)
        acceleration = -inverse @ (shafts.stiffness @ position + shafts.damping @ velocity)
        nothing = replace(start.solution, status=0 * start.solution.status, forces=0.0 * start.solution.forces)
        record = replace(start, state=type(start.state)(position, velocity, acceleration), solution=nothing)
        k, worst = len(position), 0.0
        for number in range(1, count + 1):
            dynamic = marcher.stepper.dynamic
            load = dynamic.load(record.state, 0.0 * shafts.load)
            alone = dynamic.advance(record.state, np.linalg.solve(dynamic.stiffness, load))
            record = marcher.stepper.step(dynamic, record, number)
            apart = record.state.position - alone.position, step * (record.state.velocity - alone.velocity)
            worst = max(worst, np.abs(apart).max() / np.abs(position).max())
            assert not record.solution.status.any()
        system = np.block([[np.zeros((k, k)), np.eye(k)], [-inverse @ shafts.stiffness, -inverse @ shafts.damping]])
        exact = (expm(2e-3 * system) @ np.concatenate([position, velocity]))[:k]
        errors.append(np.abs(record.state.position - exact).max() / np.abs(position).max())
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    measured("flight: relative difference of a step from the drivetrain without gears", worst, 2.5e-15, row=18)
    measured("flight: order of convergence to the exact solution (matrix exponential)", orders[-1], "2 +- 0.1")
    assert orders == pytest.approx([2.0, 2.0], abs=0.1)


def test_undamped_resonance_crosses_the_backlash_and_comes_back(both_flanks, paper_pair, measured):
    """Claim 10 and what the paper's model lacks: in free flight, centres fixed, both openings sum to the backlash
    but for the hat average."""
    fine = replace(COARSE, steps_per_mesh_cycle=160)
    result = simulate(replace(both_flanks, damping=None, bearings=None, accuracy=fine, motion=Motion(270.0, 40, 40)))
    driving, coasting = result.normal_force.values > 0.0, result.coast_normal_force.values > 0.0
    free = ~driving & ~coasting
    order = [name for _, _, name in _touches(driving, coasting)]
    returns = sum(before == "coast" and after == "drive" for before, after in zip(order[:-1], order[1:]))
    openings = (result.drive_flank_opening.values + result.coast_flank_opening.values)[free]
    measured("undamped resonance: returns from the coast flanks in 40 mesh cycles", returns, "1 or more")
    measured(
        "undamped resonance: gaps of both flanks in flight / backlash - 1",
        np.abs(openings / paper_pair.backlash - 1.0).max(),
        "0.01",
    )
    measured(
        "undamped resonance: share of the time without drive contact", result.attrs["contact_loss_share"], "reported"
    )
    assert returns >= 1 and not np.any(driving & coasting)
    assert openings == pytest.approx(paper_pair.backlash, rel=0.01)
    assert "lose contact" in result.attrs["warnings"] and "no meaning" not in result.attrs["warnings"]
    assert result.attrs["contact_loss_share"] == pytest.approx((~driving[1:]).mean(), rel=1e-12)
