"""Row 25: order in time, 2 while the contact status stands and where it changes through stick."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import expm
from tests.contact.sliding_block import SlidingBlock
from tests.frozen_gears import frozen_marcher, pushed

from fenics_gears.contact.laws import SLIP_BACKWARD, SLIP_FORWARD, STICK, Tolerance
from fenics_gears.contact.mixed_form import StepEquations
from fenics_gears.contact.step_solver import NEWTON, StepSolution
from fenics_gears.dynamics.drivetrain import Drivetrain
from fenics_gears.dynamics.march import Marcher
from fenics_gears.dynamics.stepping import EquationsOfMotion
from fenics_gears.dynamics.steps import Record
from fenics_gears.dynamics.time_integration import BACKWARD_EULER, Scheme, State


def tied_solution(rest, shafts, closed, push, duration):
    """Motion (k,), mm, from rest with the nodes `closed` held closed: the matrix exponential of a linear system."""
    operator = rest.position.operator
    rigid = operator.jacobian[closed]
    contact = rigid.T @ np.linalg.solve(operator.compliance[np.ix_(closed, closed)], rigid)
    k = len(push)
    inverse = np.linalg.inv(shafts.mass)
    system = np.block(
        [[np.zeros((k, k)), np.eye(k)], [-inverse @ (shafts.stiffness + contact), -inverse @ shafts.damping]]
    )
    return (expm(system * duration) @ np.concatenate([np.zeros(k), push]))[:k]


def orders_of(marcher_with, duration, counts, scheme=None):
    """Of the relative error after a time (s), for numbers of steps; the closed nodes stay the same throughout."""
    errors = []
    for steps in counts:
        marcher, shafts = marcher_with(duration / steps)
        # Small enough a push that no node changes its status.
        rest = record = pushed(marcher, shafts, rotation_1=0.2)
        closed = np.flatnonzero(rest.solution.status == SLIP_FORWARD)
        stepped = marcher.stepper.dynamic if scheme is None else Scheme(shafts, duration / steps, scheme)
        exact = tied_solution(rest, shafts, closed, record.state.velocity, duration)
        for step in range(1, steps + 1):
            record = marcher.stepper.step(stepped, record, step)
            assert np.array_equal(np.flatnonzero(record.solution.status == SLIP_FORWARD), closed)
        errors.append(np.abs(record.state.position - rest.state.position - exact).max() / np.abs(exact).max())
    return np.log2(np.divide(errors[:-1], errors[1:]))


@pytest.mark.parametrize(
    ("words", "order", "coarsest", "scheme"),
    [("while the contact status is unchanged", 2, 100, None), ("of backward Euler", 1, 400, BACKWARD_EULER)],
)
def test_order_while_the_status_stands(
    paper_scene, paper_pair, stand_in_flanks, measured, words, order, coarsest, scheme
):
    """Exact solution: while the closed nodes stay closed, the matrix exponential."""
    scene = replace(paper_scene, friction=None)
    marcher_with = partial(frozen_marcher, scene, paper_pair, stand_in_flanks)
    orders = orders_of(marcher_with, 4e-3, (coarsest, 2 * coarsest, 4 * coarsest), scheme)
    measured(f"order {words}", orders[-1], f"{order} +- 0.1")
    assert orders == pytest.approx(2 * [order], abs=0.1)


def bounce(scene, pair, flanks, steps, speed):
    """Position after 4 ms of a hub pushed at `speed`, and how often the closed nodes changed and the teeth parted."""
    marcher, shafts = frozen_marcher(replace(scene, damping=None), pair, flanks, 4e-3 / steps)
    record = pushed(marcher, shafts, rotation_1=speed)
    touching, changes, parted = record.solution.status, 0, 0
    for step in range(1, steps + 1):
        record = marcher.stepper.step(marcher.stepper.dynamic, record, step)
        changes += bool(np.any(record.solution.status != touching))
        parted += not record.solution.status.any() and touching.any()
        touching = record.solution.status
    return record.state.position, changes, parted


BOUNCES = {
    "nodes open and close": (-150.0, 0.0, 0, 200),
    "teeth separate and touch again": (-300.0, 0.0, 1, 400),
    "nodes stick, slip, open and close": (-150.0, 0.1, 0, 200),
}


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[pytest.mark.nightly] if "separate" in name else []) for name in BOUNCES]
)
def test_order_across_changes_of_status(paper_scene, paper_pair, stand_in_flanks, name, measured):
    """Known order: forces kink at the end of a step and slip over it is exact, so that the order stays 2. Mean order
    over two halvings, against steps 8 times finer."""
    speed, coefficient, least, coarsest = BOUNCES[name]
    friction = replace(paper_scene.friction, coefficient=coefficient) if coefficient else None
    scene = replace(paper_scene, friction=friction)
    exact, changes, parted = bounce(scene, paper_pair, stand_in_flanks, 32 * coarsest, speed)
    counts = coarsest * 2 ** np.arange(3)
    errors = [
        np.abs(bounce(scene, paper_pair, stand_in_flanks, int(steps), speed)[0] - exact).max() for steps in counts
    ]
    order = -np.polyfit(np.log(counts), np.log(errors), 1)[0]
    measured(f"order where {name}, {changes} changes of status", order, "about 2")
    assert changes > 5 and parted >= least
    assert order >= 1.5


# A block on a spring, pressed on a surface whose speed rises in proportion to time and turns, as that of flanks at the
# pitch point. N, mm, s.
FORCE, FRICTION, NORMAL, TANGENTIAL, MASS, RISE, TURN, LAST = 1000.0, 0.3, 1e-5, 2e-5, 1e-3, 4000.0, 2.5e-3, 10e-3


def slid(time):
    """Way (mm) of the surface since its speed turned."""
    return 0.5 * RISE * (time - TURN) ** 2


class TurningSurface(SlidingBlock):
    """The sliding block on this surface, `duration` (s) a step."""

    def __init__(self, problem, duration):
        super().__init__(problem)
        self.duration = duration

    def between(self, step, before):
        position = super().between(step, before)
        position.operator.rigid_slip = np.array([slid(step * self.duration) - slid(before * self.duration)])
        return position


def marched_block(spring: float, inert: bool, steps: int):
    """Friction forces (steps,) of the block, its last position, and its sequence of statuses."""
    duration, bound = LAST / steps, FRICTION * FORCE
    stiffness = np.diag([0.0, spring])
    problem = StepEquations(
        stiffness,
        np.array([FORCE, 0.0]),
        np.diag([NORMAL, TANGENTIAL]),
        np.eye(2),
        np.zeros(1),
        np.zeros(1),
        FRICTION,
        np.empty(0),
        Tolerance.of_load(FORCE),
    )
    block = Drivetrain(
        ("rotation_2", "centre_y1"), np.ones(2), stiffness, problem.load, MASS * np.eye(2) if inert else None, None
    )
    marcher = Marcher(TurningSurface(problem, duration), EquationsOfMotion(block, duration, FRICTION))
    place, rest = np.array([NORMAL * FORCE, bound / spring]), np.zeros(2)
    start = StepSolution(
        np.array([FORCE, -bound]),
        place,
        np.array([0.0, place[1] + TANGENTIAL * bound]),
        np.array([SLIP_BACKWARD]),
        0,
        NEWTON,
    )
    record, passed, forces = Record(0, State(place, rest, rest), marcher.cycle.position(0), start), [SLIP_BACKWARD], []
    for step in range(1, steps + 1):
        record = marcher.stepper.step(marcher.stepper.dynamic, record, step)
        forces.append(record.solution.forces[1])
        if record.solution.status[0] != passed[-1]:
            passed.append(int(record.solution.status[0]))
    return np.array(forces), record.state.position[1], passed


def exact_block(spring: float):
    """The same by a Runge-Kutta method of order 8, phase by phase between located changes of status."""
    bound, time, state, status, held = FRICTION * FORCE, 0.0, [FRICTION * FORCE / spring, 0.0], SLIP_BACKWARD, 0.0

    def force(time, place):
        return (
            (place + slid(time) - held) / TANGENTIAL
            if status == STICK
            else bound * (1.0 if status == SLIP_FORWARD else -1.0)
        )

    def turns(time, state):
        return state[1] + RISE * (time - TURN)

    def gives(time, state):
        return bound - abs(force(time, state[0]))

    while time < LAST:
        event = gives if status == STICK else turns
        event.terminal, event.direction = True, 1.0 if status == SLIP_BACKWARD else -1.0
        found = solve_ivp(
            lambda t, y: [y[1], -(spring * y[0] + force(t, y[0])) / MASS],
            (time, LAST),
            state,
            "DOP853",
            events=event,
            rtol=1e-12,
            atol=1e-14,
        )
        time, state, last = found.t[-1], found.y[:, -1], force(found.t[-1], found.y[0, -1])
        if found.status == 1:
            held = state[0] + slid(time) - TANGENTIAL * last
            status = STICK if status != STICK else SLIP_FORWARD if last > 0.0 else SLIP_BACKWARD
    return last, state[0]


def test_order_two_through_stick_and_reversal(measured):
    """Exact solution by pieces: a block slips back, sticks as the surface turns, and is carried into slip."""
    spring, counts, errors = 1e5, 200 * 2 ** np.arange(4), []
    force, place = exact_block(spring)
    for steps in counts:
        forces, last, passed = marched_block(spring, True, int(steps))
        errors.append(max(abs(forces[-1] - force), spring * abs(last - place)))
    order = -np.polyfit(np.log(counts), np.log(errors), 1)[0]
    measured(
        f"order of a sliding block with inertia, {len(passed) - 1} changes between slip and stick", order, "2 or better"
    )
    assert STICK in passed and SLIP_FORWARD in passed and order > 1.8
