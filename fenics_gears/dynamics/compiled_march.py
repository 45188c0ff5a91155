"""The march through many steps in one call of compiled code, as far as Newton's method solves them; same equations as
`stepping.Stepper.step`.

A step that Newton does not solve at once is left to the stepper, which has the fallbacks.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from fenics_gears.contact.addresses import arrays_of, form_rows, not_inlined
from fenics_gears.contact.compliance_product import subtract_displaced
from fenics_gears.contact.laws import OPEN, Tolerance
from fenics_gears.contact.mixed_form import Iterate, StepEquations, product
from fenics_gears.contact.newton import ALL_AT_ONCE, CONVERGED, MOST_ITERATIONS, Method, newton, newton_solver
from fenics_gears.contact.rigid_step import Sides, rigid_step

from .steps import Steps, in_block
from .time_integration import STATIC, Scheme, advanced, history_of, in_turned_frame, turned_velocities, with_history

# Sets of a mesh cycle before, where there are none.
NO_SETS = np.empty(0, dtype=np.int8)


class Motion(NamedTuple):
    """The constants of the equations of motion: the `method` in time, the drivetrain's matrices (k, k), the coefficient
    of friction, the tolerance.

    `free_motion` (f k,): how a load moves the drivetrain where only contact holds it, else empty; `rigid`: steps are
    those of `contact.rigid_step`; `modes`: how many of the coordinates, the last ones, are modes of shafts, which
    contact does not move: they are eliminated before each step. `frame` (2, k, k): the matrices of a frame that turns,
    else empty, and `frame_step` as it has it.
    """

    method: int
    stiffness: np.ndarray
    mass: np.ndarray
    damping: np.ndarray
    free_motion: np.ndarray
    friction: float
    tolerance: Tolerance
    rigid: bool = False
    modes: int = 0
    frame: np.ndarray = np.empty((0, 0, 0))
    frame_step: float = 0.0

    @classmethod
    def of(cls, scheme: Scheme, friction: float, tolerance: Tolerance, rigid: bool = False) -> Motion:
        """The motion by a method of time stepping, with its drivetrain's matrices as compiled code takes them."""
        drivetrain = scheme.drivetrain
        nothing = np.zeros_like(drivetrain.stiffness)
        stiffness, mass, damping = (
            nothing if matrix is None else np.ascontiguousarray(matrix)
            for matrix in (drivetrain.stiffness, drivetrain.mass, drivetrain.damping)
        )
        free = np.empty(0) if scheme.inert else drivetrain.free_motion
        numbers = float(friction), tolerance, rigid, drivetrain.modes
        frame = drivetrain.frame
        if frame is None or not scheme.inert:
            return cls(scheme.method, stiffness, mass, damping, free, *numbers)
        return cls(scheme.method, stiffness, mass, damping, free, *numbers, np.array(frame[:2]), frame.step)

    @property
    def packed(self) -> np.ndarray:
        """All in one array for compiled code, which `_unpacked` takes apart: to find the types of many arrays takes
        numba longer than a step."""
        numbers = self.method, self.friction, *self.tolerance, self.rigid, self.modes
        arrays = (*self[1:4], self.frame, self.free_motion)
        return np.concatenate([numbers, [self.frame_step], *(array.ravel() for array in arrays)])


class Course(NamedTuple):
    """What differs from step to step: `durations` (s,), s, `loads` (s, k), N, and the sets (N,) of a mesh cycle before,
    with which `begin` begins, or none. `at_rest`: steps are static, and the sets of a position do not depend on the
    step before it."""

    durations: np.ndarray
    loads: np.ndarray
    cycle_before: np.ndarray = NO_SETS
    at_rest: bool = False


def solve_steps(steps: Steps, first: int, end: int, motion: Motion, course: Course) -> int:
    """Solve the steps from place `first` on, each from the one before it, to before `end`; returns the first place that
    is not solved. The course is that of all steps."""
    # The first moves on with every step that is solved.
    places = np.array([first, end])
    try:
        _solve_steps(places, steps.in_memory, motion.packed, *course, newton_solver().address)
    except np.linalg.LinAlgError:
        # Sets that leave the system singular: the step after the last one done.
        pass
    return int(places[0])


class Eliminated(NamedTuple):
    """Modes that are eliminated from equations of motion over c other coordinates and m modes: the `stiffness` (c, c)
    that is left, how the modes `follow` (m, c) the others, and their own `flexibility` (m, m)."""

    stiffness: np.ndarray
    follow: np.ndarray
    flexibility: np.ndarray


def eliminated(stiffness, modes):
    """Eliminate so many last coordinates from equations with a stiffness (k, k)."""
    c = len(stiffness) - modes
    if modes == 0:
        return Eliminated(stiffness, np.empty((0, c)), np.empty((0, 0)))
    flexibility = np.ascontiguousarray(np.linalg.inv(np.ascontiguousarray(stiffness[c:, c:])))
    follow = flexibility @ np.ascontiguousarray(stiffness[c:, :c])
    left = stiffness[:c, :c] - np.ascontiguousarray(stiffness[:c, c:]) @ follow
    return Eliminated(left, follow, flexibility)


def left_load(load, modes):
    """The load (c,) on the other coordinates, with what modes hand on to them, of that (k,) on all."""
    c = len(modes.stiffness)
    return load[:c] - load[c:] @ modes.follow if c < len(load) else load


def put_modes(coordinates, load, modes):
    """Put the modes' coordinates into place behind the others (k,), under the load (k,) on all."""
    c = len(modes.stiffness)
    if c < len(load):
        coordinates[c:] = modes.flexibility @ load[c:] - modes.follow @ coordinates[:c]


def with_modes(coordinates, load, modes):
    """All coordinates (k,), of the others (c,) under the load (k,) on all."""
    whole = np.zeros_like(load)
    whole[: len(coordinates)] = coordinates
    put_modes(whole, load, modes)
    return whole


_eliminated, _left_load, _put_modes = (njit(cache=True)(each) for each in (eliminated, left_load, put_modes))


@njit(cache=True)
def _unpacked(numbers, k):
    of_frame = 2 if numbers[6] > 0.0 else 0
    end = 7 + 3 * k * k
    matrices = numbers[7:end].reshape(3, k, k)
    frame = numbers[end : end + of_frame * k * k].reshape(of_frame, k, k)
    free_motion = numbers[end + of_frame * k * k :]
    return Motion(
        int(numbers[0]),
        matrices[0],
        matrices[1],
        matrices[2],
        free_motion,
        numbers[1],
        Tolerance(numbers[2], numbers[3]),
        numbers[4] != 0.0,
        int(numbers[5]),
        frame,
        numbers[6],
    )


@njit(cache=True, nogil=True)
def _solve_steps(places, block, packed, durations, loads, cycle_before, at_rest, solver):
    steps, motion = in_block(block), _unpacked(packed, loads.shape[1])
    starts, kinds, states, status = steps.starts, steps.kinds, steps.states, steps.status
    k, duration, moved = len(motion.stiffness), -1.0, len(motion.stiffness) - motion.modes
    history = np.zeros((3, k, k))
    turning = len(motion.frame) > 0
    frame, softened = np.zeros((2, 0, 0)), np.zeros((k, k))
    # A number that is written out has `newton` compiled once more.
    method = Method(1.0, np.int64(ALL_AT_ONCE))
    residuals, most = np.empty((MOST_ITERATIONS, 5)), np.diff(starts).max()
    all_sets, coordinates = np.empty(MOST_ITERATIONS * most, dtype=np.int8), np.empty(k)
    for s in range(places[0], places[1]):
        if durations[s] != duration:
            duration = durations[s]
            if motion.method != STATIC:
                history = history_of(motion.method, duration, motion.mass, motion.damping)
            if turning:
                speed = motion.frame_step / duration
                frame = turned_velocities(duration, motion.mass, motion.damping, speed * motion.frame[0])
                softened = (1.0 - speed**2) * motion.frame[1]
            modes = _eliminated(motion.stiffness + history[0] + softened, motion.modes)
        outer = loads[s]
        begun = states[s - 1]
        if turning:
            begun = in_turned_frame(begun, frame)
        load = outer if motion.method == STATIC else with_history(outer, history, begun)
        now, before = slice(starts[s], starts[s + 1]), slice(starts[s - 1], starts[s])
        contact = arrays_of(steps.rows[s], kinds, starts[s] - starts[s - 1])
        nodes, n = status[now], starts[s + 1] - starts[s]
        # A copy: of a step at rest another thread may write the one before it.
        sets_before = status[before].copy()
        begin(
            nodes, sets_before, contact.node_before, cycle_before[now], sets_before if at_rest else cycle_before[before]
        )
        slip_before = np.empty(0)
        if len(contact.rigid_slip):
            forces_before = steps.forces[kinds * starts[s - 1] : kinds * starts[s]]
            slip_before = slip_at_start(
                contact.rigid_slip, contact.previous_jacobian, contact.previous_columns, contact.rows_before,
                states[s - 1, 0], forces_before,
            )  # fmt: skip
        elif contact.rows_before != 0:
            # Friction will need them.
            closed_before = steps.forces[kinds * starts[s - 1] : kinds * starts[s - 1] + starts[s] - starts[s - 1]]
            form_rows(contact.rows_before, np.flatnonzero(closed_before))
        free = turned(motion.free_motion, outer)
        if motion.modes:
            free = moved_by_contact(free, len(outer), moved)
        equations = StepEquations(
            modes.stiffness, _left_load(load, modes), contact.compliance, contact.jacobian, contact.gap,
            slip_before, motion.friction, free, motion.tolerance, contact.rows,
        )  # fmt: skip
        both = slice(kinds * starts[s], kinds * starts[s + 1])
        iterate = Iterate(nodes, steps.forces[both], coordinates[:moved], steps.displacement[both])
        if motion.rigid:
            sides = Sides(contact.on_drive_flanks, contact.node_pair, contact.sliding)
            outcome, steps.iterations[s] = rigid_step(equations, sides, iterate)
        else:
            sets = all_sets[: MOST_ITERATIONS * n].reshape(MOST_ITERATIONS, n)
            outcome, steps.iterations[s] = newton(solver, equations, iterate, method, residuals, sets)
        if outcome != CONVERGED:
            return
        _put_modes(coordinates, load, modes)
        states[s] = advanced(motion.method, duration, begun, coordinates)
        places[0] = s + 1


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
def slip_at_start(rigid_slip, previous_jacobian, columns, rows_before, position, forces):
    """w_old of [25] (n,), mm: rigid slip less the tangential displacement that the same material points had a step
    before.

    Arrays as of ContactOperator, `columns` (m before, n) of the `previous_compliance`, with those loaded formed at the
    address `rows_before`; `position` (k,) and `forces` of the step before.
    """
    not_inlined()
    displaced = np.empty(len(rigid_slip))
    for node in range(len(displaced)):
        displaced[node] = product(previous_jacobian[node], position)
    if rows_before != 0:
        form_rows(rows_before, np.flatnonzero(forces[: len(forces) // 2]))
    subtract_displaced(displaced, forces, columns, np.int64(0))
    for node in range(len(displaced)):
        displaced[node] = rigid_slip[node] - displaced[node]
    return displaced


@njit(cache=True)
def moved_by_contact(free_motions, k, c):
    """Free motions (f k,) over the first c of their k coordinates, (f c,): the others are modes."""
    return free_motions.reshape(len(free_motions) // k, k)[:, :c].copy().ravel()


@njit(cache=True)
def turned(free_motions, load):
    """Free motions (f k,) in the sense in which the load (k,) moves the drivetrain."""
    k, sensed = len(load), free_motions.copy()
    for first in range(0, len(free_motions), k):
        work = 0.0
        for c in range(k):
            work += free_motions[first + c] * load[c]
        if work < 0.0:
            sensed[first : first + k] *= -1.0
    return sensed
