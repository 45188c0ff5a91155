"""The march through many steps in one call of compiled code, as far as Newton's method solves them; same equations as
`march.Marcher.step`.

A step that Newton does not solve at once is left to the plain march, which has the fallbacks.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit

from fenics_gears.contact.addresses import (
    CARRIED,
    COMPLIANCE,
    GAP,
    JACOBIAN,
    PREVIOUS_COMPLIANCE,
    PREVIOUS_JACOBIAN,
    RIGID_SLIP,
    integers_at,
    matrix_at,
    vector_at,
)
from fenics_gears.contact.laws import OPEN, Tolerance
from fenics_gears.contact.newton import ALL_AT_ONCE, CONVERGED, MOST_ITERATIONS, newton
from fenics_gears.dynamics.average_acceleration import with_history
from fenics_gears.dynamics.drivetrain import Drivetrain
from fenics_gears.dynamics.steps import Steps

STATIC, AVERAGE_ACCELERATION, BACKWARD_EULER = range(3)
# Sets of a mesh cycle before, where there are none.
NO_SETS = np.empty(0, dtype=np.int8)
POSITION, VELOCITY, ACCELERATION = range(3)


@dataclass(frozen=True)
class Motion:
    """What of the equations of motion is the same at every step: the `method` in time, matrices (k, k) of the
    drivetrain, friction, tolerance.

    `free_motion` (k,): how a load moves the drivetrain where only contact holds it, else empty.
    """

    method: int
    stiffness: np.ndarray
    mass: np.ndarray
    damping: np.ndarray
    free_motion: np.ndarray
    friction: float
    tolerance: Tolerance

    @classmethod
    def of(cls, drivetrain: Drivetrain, method: int, friction: float, tolerance: Tolerance) -> Motion:
        """The motion of a drivetrain by a method of time stepping, with its matrices as compiled code takes them."""
        nothing = np.zeros_like(drivetrain.stiffness)
        mass, damping = (
            nothing if matrix is None else np.ascontiguousarray(matrix)
            for matrix in (drivetrain.mass, drivetrain.damping)
        )
        free = drivetrain.free_motion if method == STATIC else np.empty(0)
        return cls(method, np.ascontiguousarray(drivetrain.stiffness), mass, damping, free, friction, tolerance)


def solve_steps(
    steps: Steps,
    first: int,
    end: int,
    motion: Motion,
    durations: np.ndarray,
    loads: np.ndarray,
    cycle_before: np.ndarray = NO_SETS,
) -> int:
    """Solve the steps from place `first` on, each from the one before it, to before `end`; returns the first place that
    is not solved.

    `durations` (s,), s, and `loads` (s, k), N, of all steps; `cycle_before` (N,): sets as `begin` takes them, also of
    all steps, or none.
    """
    done = np.full(1, first)
    m = motion
    try:
        _solve_steps(
            done, end, steps.table, steps.starts, steps.kinds, m.method, m.stiffness, m.mass, m.damping, m.free_motion,
            m.friction, m.tolerance.length, m.tolerance.force, durations, loads, cycle_before,
            steps.states, steps.forces, steps.displacement, steps.status, steps.iterations,
        )  # fmt: skip
    except np.linalg.LinAlgError:
        # Sets that leave the system singular: the step after the last one done.
        pass
    return int(done[0])


@njit(cache=True)
def _solve_steps(
    done, end, table, starts, kinds, method, stiffness, mass, damping, free_motion, friction, length_tolerance,
    force_tolerance,
    durations, loads, cycle_before, states, forces, displacement, status, iterations,
):  # fmt: skip
    effective, history, duration = stiffness, np.zeros((3, len(stiffness), len(stiffness))), -1.0
    for s in range(done[0], end):
        if durations[s] != duration and method != STATIC:
            duration = durations[s]
            effective = _matrices_of_step(method, duration, stiffness, mass, damping, history)
        load = loads[s] if method == STATIC else with_history(loads[s], history, states[s - 1])
        now = slice(kinds * starts[s], kinds * starts[s + 1])
        nodes, last_nodes = status[starts[s] : starts[s + 1]], status[starts[s - 1] : starts[s]]
        n, k = len(nodes), len(load)
        begin(
            nodes,
            last_nodes,
            integers_at(table[s, CARRIED], n),
            cycle_before[starts[s] : starts[s + 1]],
            cycle_before[starts[s - 1] : starts[s]],
        )
        slip_before = np.empty(0)
        if table[s, RIGID_SLIP] != 0:
            before = forces[kinds * starts[s - 1] : kinds * starts[s]]
            slip_before = slip_at_start(
                vector_at(table[s, RIGID_SLIP], n), matrix_at(table[s, PREVIOUS_JACOBIAN], n, k),
                matrix_at(table[s, PREVIOUS_COMPLIANCE], len(before), n), states[s - 1, POSITION], before,
            )  # fmt: skip
        residuals, sets = np.empty((MOST_ITERATIONS, 5)), np.empty((MOST_ITERATIONS, n), dtype=np.int8)
        outcome, count, found, coordinates, moved = newton(
            effective, load, matrix_at(table[s, COMPLIANCE], kinds * n, kinds * n),
            matrix_at(table[s, JACOBIAN], kinds * n, k),
            vector_at(table[s, GAP], n), slip_before, friction, nodes, _turned(free_motion, loads[s]),
            1.0, ALL_AT_ONCE, length_tolerance, force_tolerance, residuals, sets,
        )  # fmt: skip
        if outcome != CONVERGED:
            return
        forces[now], displacement[now], iterations[s] = found, moved, count
        _advance(method, duration, states[s - 1], states[s], coordinates)
        done[0] = s + 1


@njit(cache=True)
def _matrices_of_step(method, duration, stiffness, mass, damping, history):
    """The effective stiffness of a step; and, in place, what position, velocity and acceleration at its start add to
    the load."""
    if method == AVERAGE_ACCELERATION:
        history[POSITION] = 4.0 / (duration * duration) * mass + 2.0 / duration * damping
        history[VELOCITY] = 4.0 / duration * mass + damping
        history[ACCELERATION] = mass
    else:
        history[POSITION] = mass / (duration * duration) + damping / duration
        history[VELOCITY] = mass / duration
    return stiffness + history[POSITION]


@njit(cache=True)
def begin(status, before, carried, now_then, before_then):
    """Begin with the sets `before` (n before,) of the step before; nodes that are new are open. `carried` (n,): as of a
    Position.

    `now_then` (n,) and `before_then` (n before,): sets of the same two positions a mesh cycle ago, negative or empty
    where they are not known. A node that was then as it is in the step before goes on as it did then.
    """
    for node in range(len(status)):
        last = carried[node]
        status[node] = before[last] if last >= 0 else OPEN
        if (
            len(now_then)
            and now_then[node] >= 0
            and (last < 0 or len(before_then) and before_then[last] == before[last])
        ):
            status[node] = now_then[node]


@njit(cache=True)
def slip_at_start(rigid_slip, previous_jacobian, columns, position, forces):
    """w_old of [25] (n,), mm: rigid slip less the tangential displacement that the same material points had a step
    before.

    Arrays as of ContactOperator, `columns` (m before, n) of the `previous_compliance`; `position` (k,) and `forces` of
    the step before.
    """
    displaced = np.zeros(len(rigid_slip))
    for node in range(len(displaced)):
        for c in range(len(position)):
            displaced[node] += previous_jacobian[node, c] * position[c]
    for loaded in np.flatnonzero(forces):
        for node in range(len(displaced)):
            displaced[node] -= columns[loaded, node] * forces[loaded]
    return rigid_slip - displaced


@njit(cache=True)
def _turned(free_motion, load):
    """The free motion in the sense in which the load moves the drivetrain."""
    work = 0.0
    for c in range(len(free_motion)):
        work += free_motion[c] * load[c]
    return -free_motion if work < 0.0 else free_motion


@njit(cache=True)
def _advance(method, duration, before, after, coordinates):
    """The state (3, k) at the end of a step, from its position (k,), as `AverageAcceleration.advance` and
    `BackwardEuler.advance` have it."""
    for c in range(len(coordinates)):
        change = coordinates[c] - before[POSITION, c]
        velocity, acceleration = before[VELOCITY, c], before[ACCELERATION, c]
        if method == AVERAGE_ACCELERATION:
            change *= 2.0 / duration
            acceleration = 2.0 / duration * (change - 2.0 * velocity) - acceleration
            velocity = change - velocity
        elif method == BACKWARD_EULER:
            acceleration = (change / duration - velocity) / duration
            velocity = change / duration
        after[POSITION, c], after[VELOCITY, c], after[ACCELERATION, c] = coordinates[c], velocity, acceleration
