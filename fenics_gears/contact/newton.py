"""Semi-smooth Newton for the mixed form: active sets over the contact nodes, solved with the centre coordinates.

One iteration solves, for the closed nodes (normals), the sticking ones (tangents) and all centre coordinates,

    K q + G^T p = F
    G q - C p   = gap        normal rows of closed nodes
    G q - C p   = -w_old     tangential rows of sticking nodes
    p_t = +-mu p_n           slipping nodes, inserted

and reads the new sets off the projections [24], [25]. The laws are piecewise linear, so a set that repeats is the
exact solution. Eliminating q first would divide by a stiffness that vanishes with growing time step (model.md section
4).
"""

from __future__ import annotations

import numpy as np
from numba import njit

from fenics_gears.contact.laws import OPEN, SLIP_BACKWARD, SLIP_FORWARD, STICK, next_status, opens

CONVERGED, CYCLED, SINGULAR = 0, 1, 2
OUTCOMES = {CONVERGED: "converged", CYCLED: "the sets repeat", SINGULAR: "no solution with the last sets"}
ROUND_OFF = 1e-12
MOST_ITERATIONS = 40
# Unknowns up to which elimination in compiled code is faster than LAPACK.
SMALL_SYSTEM = 40
# How sets change: every node by its projection; the same with reversals of slip stopping at stick first; or only the
# first node that wants to change. The last is Murty's least-index rule, which cannot cycle where the matrix is a
# P-matrix (K. G. Murty, Linear Complementarity, Linear and Nonlinear Programming, 1988, chapter 4).
ALL_AT_ONCE, THROUGH_STICK, ONE_AT_A_TIME = 0, 1, 2
PENETRATION, TENSION, CONE_EXCESS, STICK_SLIP, EQUILIBRIUM = range(5)
RESIDUAL_NAMES = ("penetration", "tension", "cone excess", "stick slip", "equilibrium")
RESIDUAL_UNITS = ("mm", "N", "N", "mm", "N")


@njit(cache=True)
def _slip_factor(status, friction):
    """Tangential force per normal force of a slipping node."""
    if status == SLIP_FORWARD:
        return friction
    if status == SLIP_BACKWARD:
        return -friction
    return 0.0


@njit(cache=True)
def solve_sets(stiffness, load, compliance, jacobian, gap, slip_before, friction, status, forces, coordinates):
    """Solve the linear system of given sets for `forces` (m,) and `coordinates` (k,), in place.

    Raises numpy.linalg.LinAlgError where the sets leave the system singular.
    """
    n, k, tangential = len(gap), len(load), len(slip_before) > 0
    closed = np.flatnonzero(status != OPEN)
    stick = np.flatnonzero(status == STICK) if tangential else closed[:0]
    n_closed, n_stick = len(closed), len(stick)
    rows = np.concatenate((closed, n + stick))
    size = n_closed + n_stick
    # Forces are carried as lengths, `unit` N each, so that all entries are of the size of a stiffness.
    unit = 1.0 / compliance[0, 0] if len(compliance) else 1.0
    matrix = np.empty((size + k, size + k))
    right_side = np.empty(size + k)
    factors = np.zeros(n_closed)
    if tangential:
        for b in range(n_closed):
            factors[b] = _slip_factor(status[closed[b]], friction)
    for a in range(size):
        row, values, entries = rows[a], compliance[rows[a]], matrix[a]
        for b in range(size):
            entries[b] = -values[rows[b]] * unit * unit
        if tangential:
            for b in range(n_closed):
                entries[b] -= factors[b] * values[n + closed[b]] * unit * unit
        for c in range(k):
            matrix[a, size + c] = jacobian[row, c] * unit
        right_side[a] = (gap[row] if row < n else -slip_before[row - n]) * unit
    for c in range(k):
        for b in range(size):
            entry = jacobian[rows[b], c]
            if tangential and b < n_closed:
                entry += factors[b] * jacobian[n + closed[b], c]
            matrix[size + c, b] = entry * unit
        for d in range(k):
            matrix[size + c, size + d] = stiffness[c, d]
        right_side[size + c] = load[c]
    solution = solved(matrix, right_side)
    forces[:] = 0.0
    for a in range(n_closed):
        node = closed[a]
        forces[node] = solution[a] * unit
        if tangential:
            forces[n + node] = factors[a] * forces[node]
    for a in range(n_stick):
        forces[n + stick[a]] = solution[n_closed + a] * unit
    coordinates[:] = solution[size:]


@njit(cache=True)
def solved(matrix, right_side):
    """Solution of a linear system, in place of both; small ones without LAPACK, whose call costs more than they do."""
    size = len(right_side)
    if size > SMALL_SYSTEM:
        return np.linalg.solve(matrix, right_side)
    for column in range(size):
        pivot, largest = column, abs(matrix[column, column])
        for row in range(column + 1, size):
            if abs(matrix[row, column]) > largest:
                pivot, largest = row, abs(matrix[row, column])
        if largest == 0.0:
            raise np.linalg.LinAlgError("Matrix is singular to machine precision.")
        if pivot != column:
            for other in range(column, size):
                matrix[column, other], matrix[pivot, other] = matrix[pivot, other], matrix[column, other]
            right_side[column], right_side[pivot] = right_side[pivot], right_side[column]
        for row in range(column + 1, size):
            factor = matrix[row, column] / matrix[column, column]
            if factor != 0.0:
                for other in range(column + 1, size):
                    matrix[row, other] -= factor * matrix[column, other]
                right_side[row] -= factor * right_side[column]
    for column in range(size - 1, -1, -1):
        for other in range(column + 1, size):
            right_side[column] -= matrix[column, other] * right_side[other]
        right_side[column] /= matrix[column, column]
    return right_side


@njit(cache=True)
def relative_displacement(displacement, first, end, compliance, jacobian, forces, coordinates):
    """u = G q - C p, mm, into rows `first` to `end` of `displacement` (m,); only loaded nodes are summed, by rows of
    the symmetric compliance."""
    for i in range(first, end):
        displacement[i] = _product(jacobian[i], coordinates)
    for j in np.flatnonzero(forces):
        row, force = compliance[j], forces[j]
        for i in range(first, end):
            displacement[i] -= row[i] * force


@njit(cache=True)
def _tangents(displacement, compliance, jacobian, forces, coordinates, status, gap, r_scale):
    """As `relative_displacement`, the tangential rows of the few nodes that are closed or close next; no other has a
    slip that counts."""
    n = len(gap)
    rows = np.empty(n, dtype=np.int64)
    count = 0
    for j in range(n):
        if status[j] != OPEN or not opens(forces[j], displacement[j], gap[j], r_scale / compliance[j, j]):
            rows[count] = n + j
            count += 1
    rows = rows[:count]
    for i in rows:
        displacement[i] = _product(jacobian[i], coordinates)
    for j in np.flatnonzero(forces):
        row, force = compliance[j], forces[j]
        for i in rows:
            displacement[i] -= row[i] * force


@njit(cache=True, inline="always")
def _product(row, vector):
    total = 0.0
    for c in range(len(vector)):
        total += row[c] * vector[c]
    return total


@njit(cache=True)
def _update_status(status, forces, displacement, compliance, gap, slip_before, friction, r_scale, rule):
    """New sets by the projections; `r` per node from the elastic compliance. Returns (changed, new status)."""
    n, tangential = len(gap), len(slip_before) > 0
    new = np.empty_like(status)
    changed = False
    for j in range(n):
        r_n, r_t, p_t, slip = r_scale / compliance[j, j], 0.0, 0.0, 0.0
        if tangential:
            r_t, p_t = r_scale / compliance[n + j, n + j], forces[n + j]
            slip = displacement[n + j] + slip_before[j]
        # A node in a set satisfies that set's equation exactly; round-off must not decide in its place.
        u_n = gap[j] if status[j] != OPEN else displacement[j]
        if status[j] == STICK:
            slip = 0.0
        new[j] = next_status(status[j], forces[j], p_t, u_n, gap[j], slip, r_n, r_t, friction, rule != ALL_AT_ONCE)
        if new[j] != status[j]:
            if rule == ONE_AT_A_TIME and changed:
                new[j] = status[j]
            changed = True
    return changed, new


@njit(cache=True)
def _force_round_off(stiffness, load, compliance, gap, coordinates):
    """Round-off (N) of the forces: that of the load, and that of the lengths times the stiffnesses of springs and
    teeth."""
    largest_load, largest_spring, length = 0.0, 0.0, 0.0
    for c in range(len(load)):
        spring = 0.0
        for d in range(len(load)):
            spring += abs(stiffness[c, d] * coordinates[d])
        largest_load, largest_spring = max(largest_load, abs(load[c])), max(largest_spring, spring)
        length = max(length, abs(coordinates[c]))
    terms = largest_load + largest_spring
    if len(gap):
        for each in gap:
            length = max(length, abs(each))
        terms += 1e-2 * length / compliance[0, 0]
    return ROUND_OFF * terms


@njit(cache=True)
def measure(
    residual,
    stiffness,
    load,
    compliance,
    jacobian,
    gap,
    slip_before,
    friction,
    status,
    forces,
    coordinates,
    displacement,
):
    """Violation of the laws and of equilibrium by the present solution, into `residual` (5,).

    Equilibrium is solved, not iterated: a residual within the round-off of a row's terms is no violation. A slip
        against its
    friction counts in proportion to that friction, as far as it exceeds the round-off of the forces.
    """
    n, tangential = len(gap), len(slip_before) > 0
    residual[:] = 0.0
    negligible = ROUND_OFF + _force_round_off(stiffness, load, compliance, gap, coordinates) if len(load) else ROUND_OFF
    for j in range(n):
        residual[PENETRATION] = max(residual[PENETRATION], displacement[j] - gap[j])
        residual[TENSION] = max(residual[TENSION], -forces[j])
        if tangential:
            limit = friction * max(forces[j], 0.0)
            residual[CONE_EXCESS] = max(residual[CONE_EXCESS], abs(forces[n + j]) - limit)
            slip = displacement[n + j] + slip_before[j]
            if status[j] == STICK:
                residual[STICK_SLIP] = max(residual[STICK_SLIP], abs(slip))
            elif status[j] != OPEN and forces[n + j] * slip < 0.0 and abs(forces[n + j]) > negligible:
                residual[STICK_SLIP] = max(residual[STICK_SLIP], abs(slip))
    balance, terms = -load, np.abs(load)
    for c in range(len(load)):
        for d in range(len(load)):
            balance[c] += stiffness[c, d] * coordinates[d]
            terms[c] += abs(stiffness[c, d] * coordinates[d])
    for i in range(len(forces)):
        if forces[i] != 0.0:
            for c in range(len(load)):
                balance[c] += jacobian[i, c] * forces[i]
                terms[c] += abs(jacobian[i, c] * forces[i])
    for c in range(len(load)):
        residual[EQUILIBRIUM] = max(residual[EQUILIBRIUM], abs(balance[c]) - ROUND_OFF * terms[c])


@njit(cache=True)
def _within(residual, length_tolerance, force_tolerance, load, coordinates, stiffness, compliance, gap):
    # Equilibrium is solved, not iterated: only the round-off of its largest terms may be left. A gap is a difference of
    # displacements and is known to their round-off only.
    round_off = _force_round_off(stiffness, load, compliance, gap, coordinates)
    longest = 0.0
    for each in coordinates:
        longest = max(longest, abs(each))
    length_tolerance = length_tolerance + 1e-14 * longest
    return (
        residual[EQUILIBRIUM] <= 1e-2 * force_tolerance + round_off
        and residual[PENETRATION] <= length_tolerance
        and residual[STICK_SLIP] <= length_tolerance
        and residual[TENSION] <= force_tolerance
        and residual[CONE_EXCESS] <= force_tolerance
    )


@njit(cache=True)
def first_node(gap, displacement, jacobian, free_motion):
    """The node that touches first when the load moves the drivetrain along `free_motion` (k,), or else the nearest to
    contact."""
    first, distance = -1, np.inf
    for j in range(len(gap)):
        approach = 0.0
        for c in range(len(free_motion)):
            approach += jacobian[j, c] * free_motion[c]
        if approach > 0.0 and (gap[j] - displacement[j]) / approach < distance:
            first, distance = j, (gap[j] - displacement[j]) / approach
    return first if first >= 0 else np.argmax(displacement[: len(gap)] - gap)


@njit(cache=True)
def _same(one, other):
    for j in range(len(one)):
        if one[j] != other[j]:
            return False
    return True


@njit(cache=True)
def newton(
    stiffness, load, compliance, jacobian, gap, slip_before, friction, status,
    free_motion, r_scale, rule, length_tolerance, force_tolerance, history, sets,
):  # fmt: skip
    """Active-set Newton from the sets `status` (n,) int8, changed in place to those of the solution.

    `stiffness` (k, k) and `load` (k,): effective drivetrain; `slip_before` (n,): w_old, empty without friction;
    `free_motion` (k,): how the load moves the drivetrain where only contact holds it, in which case one node at least
    stays closed; empty where the drivetrain holds the load. `history` (iterations, 5) and
    `sets` (iterations, n) are filled with residuals and sets. Returns (outcome, iterations, forces, coordinates, u).
    """
    n, m, k = len(gap), len(compliance), len(load)
    forces, coordinates, displacement = np.zeros(m), np.zeros(k), np.zeros(m)
    outcome, iteration, limit = CYCLED, 0, len(history)
    while iteration < limit:
        if len(free_motion) and n > 0 and not np.any(status != OPEN):
            status[first_node(gap, displacement, jacobian, free_motion)] = SLIP_FORWARD
        sets[iteration] = status
        solve_sets(stiffness, load, compliance, jacobian, gap, slip_before, friction, status, forces, coordinates)
        relative_displacement(displacement, 0, n, compliance, jacobian, forces, coordinates)
        if len(slip_before):
            _tangents(displacement, compliance, jacobian, forces, coordinates, status, gap, r_scale)
        measure(
            history[iteration], stiffness, load, compliance, jacobian, gap, slip_before, friction,
            status, forces, coordinates, displacement,
        )  # fmt: skip
        changed, new = _update_status(
            status, forces, displacement, compliance, gap, slip_before, friction, r_scale, rule
        )
        if len(free_motion) and n > 0 and not np.any(new != OPEN):
            new[first_node(gap, displacement, jacobian, free_motion)] = SLIP_FORWARD
            changed = np.any(new != status)
        repeated = not changed
        for earlier in range(iteration + 1):
            repeated = repeated or _same(sets[earlier], new)
        iteration += 1
        if repeated:
            outcome = CYCLED if changed else SINGULAR
            if _within(
                history[iteration - 1], length_tolerance, force_tolerance, load, coordinates, stiffness, compliance, gap
            ):
                # Sets may also alternate between solutions that are the same within the tolerance.
                outcome = CONVERGED
            break
        status[:] = new
    relative_displacement(displacement, n, m, compliance, jacobian, forces, coordinates)
    return outcome, iteration, forces, coordinates, displacement
