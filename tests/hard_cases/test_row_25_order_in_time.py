"""Row 25: order in time, 2 while the contact status stands, about 1 across its changes."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import expm
from tests.frozen_gears import frozen_marcher

from fenics_gears.contact.laws import SLIP_FORWARD
from fenics_gears.dynamics.average_acceleration import State
from fenics_gears.dynamics.backward_euler import BackwardEuler
from fenics_gears.dynamics.steps import Record


def pushed(marcher, shafts, speed):
    """Static equilibrium with the pinion's hub pushed at `speed` (mm/s along its base circle); acceleration from the equations of motion."""
    rest = marcher.start()
    push = np.zeros(len(shafts.coordinates))
    push[shafts.coordinates.index("rotation_1")] = speed
    acceleration = np.zeros_like(push) if shafts.damping is None else -np.linalg.solve(shafts.mass, shafts.damping @ push)
    return rest, Record(0, State(rest.state.position, push, acceleration), rest.position, rest.solution)


def tied_solution(rest, shafts, closed, push, duration):
    """Motion (k,), mm, from rest with the nodes `closed` held closed: the matrix exponential of a linear system."""
    operator = rest.position.operator
    rigid = operator.jacobian[closed]
    contact = rigid.T @ np.linalg.solve(operator.compliance[np.ix_(closed, closed)], rigid)
    k = len(push)
    inverse = np.linalg.inv(shafts.mass)
    system = np.block([[np.zeros((k, k)), np.eye(k)], [-inverse @ (shafts.stiffness + contact), -inverse @ shafts.damping]])
    return (expm(system * duration) @ np.concatenate([np.zeros(k), push]))[:k]


def tied_errors(paper_scene, paper_pair, stand_in_flanks, counts, scheme=None):
    """Relative error after 4 ms, for numbers of steps; the closed nodes stay the same throughout."""
    scene, duration, errors = replace(paper_scene, friction=None), 4e-3, []
    for steps in counts:
        marcher, shafts = frozen_marcher(scene, paper_pair, stand_in_flanks, duration / steps)
        # Small enough a push that no node changes its status.
        rest, record = pushed(marcher, shafts, 0.2)
        closed = np.flatnonzero(rest.solution.status == SLIP_FORWARD)
        stepped = marcher.dynamic if scheme is None else scheme(shafts, duration / steps)
        exact = tied_solution(rest, shafts, closed, record.state.velocity, duration)
        for step in range(1, steps + 1):
            record = marcher.step(stepped, record, step)
            assert np.array_equal(np.flatnonzero(record.solution.status == SLIP_FORWARD), closed)
        errors.append(np.abs(record.state.position - rest.state.position - exact).max() / np.abs(exact).max())
    return np.array(errors)


def test_order_two_while_the_status_stands(paper_scene, paper_pair, stand_in_flanks, measured):
    """Exact solution: while the closed nodes stay closed the system is linear; the matrix exponential solves it."""
    errors = tied_errors(paper_scene, paper_pair, stand_in_flanks, (100, 200, 400))
    orders = np.log2(errors[:-1] / errors[1:])
    measured("order while the contact status is unchanged", orders[-1], "2 +- 0.1")
    assert orders == pytest.approx([2.0, 2.0], abs=0.1)


def test_backward_euler_is_of_order_one(paper_scene, paper_pair, stand_in_flanks, measured):
    """Known order of the method that steps where no vibration is sampled: 1."""
    errors = tied_errors(paper_scene, paper_pair, stand_in_flanks, (800, 1600, 3200), BackwardEuler)
    orders = np.log2(errors[:-1] / errors[1:])
    measured("order of backward Euler", orders[-1], "1 +- 0.1")
    assert orders == pytest.approx([1.0, 1.0], abs=0.1)


def bounce(scene, pair, flanks, steps, speed):
    """Position after 4 ms of a hub pushed at `speed`, the steps at which the closed nodes changed, and those at which the teeth parted."""
    marcher, shafts = frozen_marcher(replace(scene, damping=None), pair, flanks, 4e-3 / steps)
    _, record = pushed(marcher, shafts, speed)
    touching, changes, parted = record.solution.status, 0, 0
    for step in range(1, steps + 1):
        record = marcher.step(marcher.dynamic, record, step)
        changes += bool(np.any(record.solution.status != touching))
        parted += not record.solution.status.any() and touching.any()
        touching = record.solution.status
    return record.state.position, changes, parted


BOUNCES = {
    "nodes open and close": (-150.0, 0.0, 0),
    "teeth separate and touch again": (-300.0, 0.0, 1),
    "nodes stick, slip, open and close": (-150.0, 0.1, 0),
}


@pytest.mark.parametrize("name", BOUNCES)
def test_order_across_changes_of_status(paper_scene, paper_pair, stand_in_flanks, name, measured):
    """Known order: a change of status is met at the end of its step. Forces of elastic teeth do not jump but kink there, which leaves
    the order at 2 or little below; slip by backward Euler is of order 1. Mean order over four halvings, against steps 8 times finer."""
    speed, coefficient, least = BOUNCES[name]
    friction = replace(paper_scene.friction, coefficient=coefficient) if coefficient else None
    scene = replace(paper_scene, friction=friction)
    exact, changes, parted = bounce(scene, paper_pair, stand_in_flanks, 12800, speed)
    counts = 100 * 2 ** np.arange(5)
    errors = [np.abs(bounce(scene, paper_pair, stand_in_flanks, int(steps), speed)[0] - exact).max() for steps in counts]
    order = -np.polyfit(np.log(counts), np.log(errors), 1)[0]
    measured(f"order where {name}, {changes} changes of status", order, "at least about 1")
    assert changes > 5 and parted >= least
    assert order >= 0.9
