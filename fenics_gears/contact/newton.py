"""Semi-smooth Newton for the mixed form: active sets over the contact nodes, solved with the centre coordinates.

One iteration solves the mixed form (`contact.mixed_form`) and reads the new sets off the projections [24], [25]. The
laws are piecewise linear, so a set that repeats is the exact solution.
"""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import numpy as np
from numba import carray, cfunc, njit

from .addresses import (
    call,
    close_as_factored,
    from_afar,
    not_inlined,
    solver_of,
    to_integer,
    to_number,
    to_set,
)  # fmt: skip
from .laws import OPEN, SLIP_BACKWARD, SLIP_FORWARD, STICK, Tolerance, measure, next_status, presses, within
from .mixed_form import Iterate, StepEquations, relative_displacement, solve_sets

CONVERGED, CYCLED, SINGULAR = 0, 1, 2
OUTCOMES = {CONVERGED: "converged", CYCLED: "the sets repeat", SINGULAR: "no solution with the last sets"}
COUNT, FAILED = len(OUTCOMES), -1
# Sizes, addresses and settings that the C function takes.
NUMBERS = 21
MOST_ITERATIONS = 40
# Of a free motion that moves other meshes than a node's, mm per mm: round-off.
LEAST_APPROACH = 1e-9
# How sets change: every node by its projection; the same with reversals of slip stopping at stick first; or only the
# first node that wants to change. The last is Murty's least-index rule, which cannot cycle where the matrix is a
# P-matrix (K. G. Murty, Linear Complementarity, Linear and Nonlinear Programming, 1988, chapter 4).
ALL_AT_ONCE, THROUGH_STICK, ONE_AT_A_TIME = 0, 1, 2


class Method(NamedTuple):
    """How sets change: `r_scale` of the projections, and the `rule`."""

    r_scale: float
    rule: int


@njit(cache=True, error_model="numpy")
def _update_status(equations, iterate, new, r_scale, rule):
    """Put the new sets by the projections into `new` (n,); `r` per node from the elastic compliance. Returns whether
    they changed."""
    _, _, compliance, _, gap, slip_before, friction, _, _, _ = equations
    status, forces, _, displacement = iterate
    n, tangential = len(gap), len(slip_before) > 0
    changed = False
    for j in range(n):
        trial, pressed = 0.0, presses(status[j] != OPEN, forces[j], displacement[j], gap[j])
        if tangential and pressed:
            # A node in a set satisfies that set's equation exactly; round-off must not decide in its place.
            slip = 0.0 if status[j] == STICK else displacement[n + j] + slip_before[j]
            # Of an open node, whose rows need not be formed, only the sign counts.
            r_t = r_scale / compliance[n + j, n + j] if status[j] != OPEN else 1.0
            trial = forces[n + j] + r_t * slip
        new[j] = next_status(status[j], forces[j], pressed, tangential, trial, friction, rule != ALL_AT_ONCE)
        if new[j] != status[j]:
            if rule == ONE_AT_A_TIME and changed:
                new[j] = status[j]
            changed = True
    return changed


@njit(cache=True)
def _approach(equations, free, node):
    """How fast a free motion, by its number, brings a node to contact, mm per mm."""
    k = len(equations.load)
    approach = 0.0
    for c in range(k):
        approach += equations.jacobian[node, c] * equations.free_motion[free * k + c]
    return approach


@njit(cache=True)
def _holds(status, equations, free, meshes):
    """Whether a closed node stops a free motion; of a single mesh each closed node does."""
    for j in range(len(status)):
        if status[j] != OPEN and (meshes == 1 or abs(_approach(equations, free, j)) > LEAST_APPROACH):
            return True
    return False


@njit(cache=True)
def _with_one_closed(status, equations, displacement):
    """Where only contact holds the load and no node of a mesh is closed, close the one that touches first as the
    drivetrain moves freely, or else the nearest to contact; returns whether it did."""
    gap = equations.gap
    closed = False
    meshes = len(equations.free_motion) // len(equations.load)
    for free in range(meshes if len(gap) else 0):
        if _holds(status, equations, free, meshes):
            continue
        first, distance, nearest, least = -1, np.inf, -1, np.inf
        for j in range(len(gap)):
            approach = _approach(equations, free, j)
            left = gap[j] - displacement[j]
            if approach > (0.0 if meshes == 1 else LEAST_APPROACH) and left / approach < distance:
                first = j
                distance = left / approach
            if (meshes == 1 or abs(approach) > LEAST_APPROACH) and left < least:
                nearest = j
                least = left
        if first >= 0 or nearest >= 0:
            status[first if first >= 0 else nearest] = SLIP_FORWARD
            closed = True
    return closed


@njit(cache=True)
def _same(one, other):
    for j in range(len(one)):
        if one[j] != other[j]:
            return False
    return True


@njit(cache=True)
def _newton(equations, iterate, method, history, sets):
    """As `newton`, without tangential displacement where there is no friction; raises numpy.linalg.LinAlgError where
    the sets leave the system singular."""
    not_inlined()
    status, displacement = iterate.status, iterate.displacement
    n = len(equations.gap)
    outcome, iteration, limit, new = CYCLED, 0, len(history), np.empty_like(status)
    # A number that is written out in the call has it compiled once more.
    none = np.int64(0)
    while iteration < limit:
        _with_one_closed(status, equations, displacement)
        sets[iteration] = status
        solve_sets(equations, iterate)
        relative_displacement(equations, iterate, none, n + len(equations.slip_before))
        measure(history[iteration], equations, iterate)
        changed = _update_status(equations, iterate, new, method.r_scale, method.rule)
        if _with_one_closed(new, equations, displacement):
            changed = not _same(new, status)
        repeated = not changed
        for earlier in range(iteration + 1):
            repeated = repeated or _same(sets[earlier], new)
        iteration += 1
        if repeated:
            outcome = CYCLED if changed else SINGULAR
            if within(history[iteration - 1], equations, iterate.coordinates):
                # Sets may also alternate between solutions that are the same within the tolerance.
                outcome = CONVERGED
            break
        status[:] = new
    return outcome, iteration


@njit(cache=True)
def _without_friction(equations):
    """The equations without friction."""
    slip_before = equations.slip_before[:0]
    return StepEquations(
        equations.stiffness, equations.load, equations.compliance, equations.jacobian, equations.gap, slip_before,
        0.0, equations.free_motion, equations.tolerance, equations.rows,
    )  # fmt: skip


@njit(cache=True)
def _slip_as_they_move(equations, iterate):
    """Each closed node slips the way that it moves."""
    status, displacement, n = iterate.status, iterate.displacement, len(iterate.status)
    relative_displacement(equations, iterate, n, 2 * n)
    for j in range(n):
        if status[j] != OPEN:
            forward = displacement[n + j] + equations.slip_before[j] > 0.0
            status[j] = SLIP_FORWARD if forward else SLIP_BACKWARD


@njit(cache=True)
def _newton_over_face(equations, iterate, method, history, sets):
    """As `newton`; with friction over a face it begins at the sets without friction, where those of a solution that is
    near are not known, and goes on through stick where sets repeat. Fallbacks do neither: they begin at what the step
    before had."""
    n, status, (solver, factors) = len(equations.gap), iterate.status, solver_of(equations.rows)
    first = method.rule == ALL_AT_ONCE and method.r_scale == 1.0
    frictional = len(equations.slip_before) and first and solver != 0
    if frictional and from_afar(factors, status):
        before, room = status.copy(), (np.empty_like(history), np.empty_like(sets))
        close_as_factored(factors, status)
        # Called from here, for a function of its own would have Newton compiled into it too.
        if _newton(_without_friction(equations), iterate, method, *room)[0] == CONVERGED:
            _slip_as_they_move(equations, iterate)
        else:
            status[:] = before
    outcome, done = _newton(equations, iterate, method, history, sets)
    if frictional and outcome == CYCLED and done < len(history):
        through = Method(method.r_scale, np.int64(THROUGH_STICK))
        outcome, more = _newton(equations, iterate, through, history[done:], sets[done:])
        done += more
    if not len(equations.slip_before):
        relative_displacement(equations, iterate, n, len(equations.compliance))
    return outcome, done


@cache
def newton_solver():
    """The C function behind `newton` and `newton_at`: so it is compiled once, not into each of their callers."""
    return cfunc("int64(int64, int64)", cache=True)(_newton_in_place)


def _newton_in_place(numbers, method):
    """Returns iterations times the number of outcomes, and the outcome; FAILED where sets leave the system singular."""
    numbers, method = carray(to_integer(numbers), NUMBERS), carray(to_number(method), 4)
    n, m, k, free, slips, most, rows, rule = numbers[:8]
    at = numbers[8:]
    equations = StepEquations(
        carray(to_number(at[0]), (k, k)),
        carray(to_number(at[1]), k),
        carray(to_number(at[2]), (m, m)),
        carray(to_number(at[3]), (m, k)),
        carray(to_number(at[4]), n),
        carray(to_number(at[5]), slips),
        method[0],
        carray(to_number(at[6]), free),
        Tolerance(method[2], method[3]),
        rows,
    )
    iterate = Iterate(
        carray(to_set(at[7]), n), carray(to_number(at[8]), m), carray(to_number(at[9]), k), carray(to_number(at[10]), m)
    )
    history, sets = carray(to_number(at[11]), (most, 5)), carray(to_set(at[12]), (most, n))
    how = Method(method[1], rule)
    try:
        outcome, iterations = _newton_over_face(equations, iterate, how, history, sets)
    except Exception:
        return FAILED
    return COUNT * iterations + outcome


@njit(cache=True, nogil=True)
def newton_at(solver, numbers, method):
    """As `newton`, from arrays given by their addresses: to find the types of many arrays takes numba longer than a
    small step.

    `numbers`: how many nodes, rows, coordinates, components of the free motion and slips there are, and most
    iterations; the address of what forms rows; the rule; then addresses, of the arrays of StepEquations, of Iterate,
    `history` and `sets`. `method` (4,): friction, the scale of r, and the tolerances.
    """
    done = call(solver, (numbers.ctypes.data, method.ctypes.data))
    if done == FAILED:
        return SINGULAR, FAILED
    return done % COUNT, done // COUNT


@njit(cache=True)
def newton(solver, equations, iterate, method, history, sets):
    """Active-set Newton from the sets of an `iterate`, which becomes the solution; its displacement is zero at first.
    `solver`: address of `newton_solver`.

    `history` (iterations, 5) and `sets` (iterations, n) are filled with residuals and sets. Returns (outcome,
    iterations), FAILED iterations where sets leave the system singular.
    """
    not_inlined()
    numbers = np.empty(NUMBERS, dtype=np.int64)
    numbers[0], numbers[1], numbers[2] = len(equations.gap), len(equations.compliance), len(equations.load)
    numbers[3], numbers[4], numbers[5] = len(equations.free_motion), len(equations.slip_before), len(history)
    numbers[6], numbers[7] = equations.rows, method.rule
    numbers[8], numbers[9] = equations.stiffness.ctypes.data, equations.load.ctypes.data
    numbers[10], numbers[11] = equations.compliance.ctypes.data, equations.jacobian.ctypes.data
    numbers[12], numbers[13] = equations.gap.ctypes.data, equations.slip_before.ctypes.data
    numbers[14] = equations.free_motion.ctypes.data
    numbers[15], numbers[16] = iterate.status.ctypes.data, iterate.forces.ctypes.data
    numbers[17], numbers[18] = iterate.coordinates.ctypes.data, iterate.displacement.ctypes.data
    numbers[19], numbers[20] = history.ctypes.data, sets.ctypes.data
    rest = np.array([equations.friction, method.r_scale, *equations.tolerance])
    return newton_at(solver, numbers, rest)
