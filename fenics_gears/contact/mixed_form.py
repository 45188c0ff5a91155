"""The mixed form of the contact equations: the linear system of given sets, for forces of contact nodes and centre
coordinates.

For the closed nodes (normals), the sticking ones (tangents) and all centre coordinates,

    K q + G^T p = F
    G q - C p   = gap        normal rows of closed nodes
    G q - C p   = -w_old     tangential rows of sticking nodes
    p_t = +-mu p_n           slipping nodes, inserted

Eliminating q first would divide by a stiffness that vanishes with growing time step (model.md section 4).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from llvmlite.binding import add_symbol
from numba import carray, cfunc, njit, types

from .addresses import call, displacer_of, form_rows, not_inlined, solver_of, to_number
from .compliance_product import subtract_displaced
from .laws import OPEN, SLIP_BACKWARD, SLIP_FORWARD, STICK, Tolerance

SMALL_SYSTEM = 40  # unknowns up to which elimination in compiled code is faster than LAPACK
LEAST_PIVOT = 1e-2  # of forces, in parts of the first one: below it larger ones are looked for
WEAK_FRICTION = 0.25  # coefficient up to which the compliance's diagonal serves as pivots


class StepEquations(NamedTuple):
    """The equations of a step: `stiffness` K (k, k), `load` F (k,) of the effective drivetrain; `compliance` C (m, m),
    `jacobian` G (m, k), `gap` (n,) of the contact; `slip_before` (n,): w_old, empty without friction.

    `rows`: address of what forms the rows of nodes that are closed for the first time (`contact.formed_rows`), 0 where
    all are there. `free_motion` (f k,): how the load moves the drivetrain where only the contact of each of f meshes
    holds it, in which case one node of each at least stays closed; empty where the drivetrain holds the load.
    `tolerance`: within which an iterate is a solution.
    """

    stiffness: np.ndarray
    load: np.ndarray
    compliance: np.ndarray
    jacobian: np.ndarray
    gap: np.ndarray
    slip_before: np.ndarray
    friction: float
    free_motion: np.ndarray
    tolerance: Tolerance
    rows: int = 0


class Iterate(NamedTuple):
    """Sets (n,), forces p (m,), coordinates q (k,) and relative displacement u (m,); each iteration overwrites them."""

    status: np.ndarray
    forces: np.ndarray
    coordinates: np.ndarray
    displacement: np.ndarray


@njit(cache=True)
def _slip_factor(status, friction):
    """Tangential force per normal force of a slipping node."""
    if status == SLIP_FORWARD:
        return friction
    if status == SLIP_BACKWARD:
        return -friction
    return 0.0


@njit(cache=True)
def put_entries(entries, values, places, first, unit):
    """Put the values at the places from the `first` on, times the unit."""
    # uint64 avoids numba's wraparound check, in a function of its own.
    for b in range(np.uint64(first), np.uint64(len(places))):
        entries[b] = unit * values[np.uint64(places[b])]


@njit(cache=True)
def add_slip(entries, values, places, slip, unit):
    """Add what tangential forces give that are these parts of the normal ones."""
    for b in range(np.uint64(len(slip))):
        entries[b] += unit * slip[b] * values[np.uint64(places[b])]


@njit(cache=True, error_model="numpy")
def solve_sets(equations, iterate):
    """Solve the linear system of the sets of an iterate for its forces and coordinates, in place.

    Raises numpy.linalg.LinAlgError where the sets leave the system singular.
    """
    not_inlined()
    gap, slip_before, forces = equations.gap, equations.slip_before, iterate.forces
    n, k, compliance = len(gap), len(equations.load), equations.compliance
    rows, slip, closed = _unknown_forces(equations, iterate.status)
    size = len(rows)
    right_side = np.empty(size + k)
    for a in range(size):
        right_side[a] = gap[rows[a]] if rows[a] < n else -slip_before[rows[a] - n]
    # Strong friction leaves the diagonal no better than other pivots.
    weak = not len(slip) or equations.friction <= WEAK_FRICTION
    if weak and size > SMALL_SYSTEM and solve_factored(equations, iterate, rows, slip, right_side):
        return
    form_rows(equations.rows, rows[:closed])
    # Forces are carried as lengths, `unit` N each, so that all entries are of the size of a stiffness.
    unit = 1.0 / compliance[0, 0] if len(compliance) else 1.0
    matrix = system_of(size + k)
    _put_system(matrix, equations, rows, slip, unit)
    right_side[:size] *= unit
    right_side[size:] = equations.load
    solution = solved(matrix, right_side, size if weak else 0)
    forces[:] = 0.0
    for a in range(size):
        forces[rows[a]] = solution[a] * unit
    for b in range(len(slip)):
        if slip[b] != 0.0:
            forces[n + rows[b]] = slip[b] * forces[rows[b]]
    iterate.coordinates[:] = solution[size:]


@njit(cache=True)
def _unknown_forces(equations, status):
    """Rows of normal forces of closed nodes, then of tangential ones of those that stick; tangential forces per normal
    one of the closed nodes, none without friction; and how many nodes are closed."""
    n, tangential = len(equations.gap), len(equations.slip_before) > 0
    rows, slip, closed = np.empty(2 * n, dtype=np.int64), np.zeros(n), 0
    for node in range(n):
        if status[node] != OPEN:
            rows[closed], slip[closed] = node, _slip_factor(status[node], equations.friction)
            closed += 1
    size = closed
    if tangential:
        for b in range(closed):
            if status[rows[b]] == STICK:
                rows[size] = n + rows[b]
                size += 1
    return rows[:size], slip[: closed if tangential else 0], closed


@njit(cache=True)
def _put_system(matrix, equations, rows, slip, unit):
    """Put the matrix of the unknown forces and the coordinates into place; forces in `unit` N per mm."""
    compliance, jacobian, stiffness = equations.compliance, equations.jacobian, equations.stiffness
    n, k, size, scale = len(equations.gap), len(equations.load), len(rows), -unit * unit
    for a in range(size):
        row = rows[a]
        put_entries(matrix[a], compliance[row], rows, np.int64(0), scale)
        add_slip(matrix[a], compliance[row, n:], rows, slip, scale)
        for c in range(k):
            matrix[a, size + c] = jacobian[row, c] * unit
    for c in range(k):
        for b in range(size):
            entry = jacobian[rows[b], c]
            if b < len(slip):
                entry += slip[b] * jacobian[n + rows[b], c]
            matrix[size + c, b] = entry * unit
        for d in range(k):
            matrix[size + c, size + d] = stiffness[c, d]


@njit(cache=True)
def solve_factored(equations, iterate, rows, slip, opening):
    """As `solve_sets` for the unknown forces in `rows`, where the contact has room for factors
    (`contact.factored_compliance`); returns whether it has and did.

    `slip`: tangential forces per normal one, none without friction; `opening`: right sides of the rows, mm.
    """
    (solver, factors), (m, k) = solver_of(equations.rows), equations.jacobian.shape
    if solver == 0 or len(equations.compliance) != m:
        return False
    result = np.empty(m + k)
    # Of one kind of integers: numpy makes floats of both kinds together. The solver forms the rows that it reads.
    arrays = np.empty(14, dtype=np.int64)
    arrays[0], arrays[1], arrays[2], arrays[3], arrays[4] = factors, m, k, len(rows), len(slip)
    arrays[5], arrays[6] = equations.compliance.ctypes.data, equations.jacobian.ctypes.data
    arrays[7], arrays[8] = equations.stiffness.ctypes.data, equations.load.ctypes.data
    arrays[9], arrays[10], arrays[11] = rows.ctypes.data, slip.ctypes.data, opening.ctypes.data
    arrays[12], arrays[13] = result.ctypes.data, equations.rows
    done = call(solver, (arrays.ctypes.data,)) == 1
    # Read after the call, for compiled code gives back an array as soon as nothing names it.
    if done and len(arrays):
        iterate.forces[:], iterate.coordinates[:] = result[:m], result[m:]
    return done


@njit(cache=True)
def system_of(size):
    """Room for the matrix of a system that is to be `solved`: of a small one groups of four columns, the last zero."""
    width = size if size > SMALL_SYSTEM else (size + 3) // 4 * 4
    matrix = np.empty((size, width))
    matrix[:, size:] = 0.0
    return matrix


@njit(cache=True)
def solved(matrix, right_side, forces):
    """Solution of a linear system, in place of both; small ones without LAPACK, whose call costs more than they do.

    The first `forces` rows and columns are those of a compliance, which needs no other pivots than its diagonal: others
    are looked for where that comes near zero, as where nodes depend on each other, and in all columns after them.
    """
    if not put_solution(matrix, right_side, forces):
        raise np.linalg.LinAlgError("Matrix is singular to machine precision.")
    return right_side


@njit(cache=True)
def put_solution(matrix, right_side, forces):
    """As `solved`, but returns whether there is a solution."""
    size, width = matrix.shape
    return _solve(matrix.ctypes.data, right_side.ctypes.data, size, width, forces) != 0


@njit(cache=True)
def _bring_pivot(matrix, right_side, column):
    """Exchange a row of a matrix that is being eliminated for the one below it with the largest entry in `column`;
    returns whether there is one."""
    pivot, largest = column, abs(matrix[column, column])
    for row in range(column + 1, len(matrix)):
        if abs(matrix[row, column]) > largest:
            pivot, largest = row, abs(matrix[row, column])
    if largest == 0.0:
        return False
    if pivot != column:
        for other in range(column, len(matrix)):
            matrix[column, other], matrix[pivot, other] = matrix[pivot, other], matrix[column, other]
        right_side[column], right_side[pivot] = right_side[pivot], right_side[column]
    return True


@njit(cache=True)
def _subtract(numbers, first, end, factor, other):
    """Subtract from the numbers `first` to `end`, groups of four, the factor times those from `other` on."""
    # All four are read before one is written, and uint64 avoids numba's wraparound check: so they are compiled for four
    # numbers at a time.
    at, end, other = np.uint64(first), np.uint64(end), np.uint64(other)
    one, two, three, four = np.uint64(1), np.uint64(2), np.uint64(3), np.uint64(4)
    while at < end:
        a = numbers[at] - factor * numbers[other]
        b = numbers[at + one] - factor * numbers[other + one]
        c = numbers[at + two] - factor * numbers[other + two]
        d = numbers[at + three] - factor * numbers[other + three]
        numbers[at], numbers[at + one], numbers[at + two], numbers[at + three] = a, b, c, d
        at, other = at + four, other + four


@cfunc("int64(int64, int64, int64, int64, int64)", cache=True, error_model="numpy")
def _solve_in_place(matrix_address, right_address, size, width, forces):
    """`solved` from addresses; returns whether there is a solution."""
    matrix, right_side = carray(to_number(matrix_address), (size, width)), carray(to_number(right_address), size)
    if size > SMALL_SYSTEM:
        try:
            right_side[:] = np.linalg.solve(matrix, right_side)
        except Exception:
            # A singular matrix; compiled code tells no kinds of errors apart.
            return 0
        return 1
    numbers, least = matrix.reshape(-1), LEAST_PIVOT * abs(matrix[0, 0]) if size else 0.0
    for column in range(size):
        weak = column >= forces or abs(matrix[column, column]) <= least
        if weak and not _bring_pivot(matrix, right_side, column):
            return 0
        inverse, value = 1.0 / matrix[column, column], right_side[column]
        first = column // 4 * 4
        for row in range(column + 1, size):
            factor = matrix[row, column] * inverse
            right_side[row] -= factor * value
            _subtract(numbers, row * width + first, (row + 1) * width, factor, column * width + first)
    for column in range(size - 1, -1, -1):
        value = right_side[column] / matrix[column, column]
        right_side[column] = value
        for row in range(column):
            right_side[row] -= matrix[row, column] * value
    return 1


# Called by a name of the linker's: so it is compiled once, not into each function that solves linear systems.
add_symbol("fenics_gears_solve_in_place", _solve_in_place.address)
_solve = types.ExternalFunction("fenics_gears_solve_in_place", types.int64(*[types.int64] * 5))


@njit(cache=True)
def relative_displacement(equations, iterate, first, end):
    """u = G q - C p, mm, into rows `first` to `end` of the displacement."""
    # Taken out of the records once: in a loop that would cost more than the numbers.
    compliance, jacobian, displacement = equations.compliance, equations.jacobian, iterate.displacement[first:end]
    forces, coordinates = iterate.forces, iterate.coordinates
    for i in range(end - first):
        displacement[i] = product(jacobian[first + i], coordinates)
    displacer = displacer_of(equations.rows)
    if displacer == 0:
        subtract_displaced(displacement, forces, compliance, first)
    elif end > first:
        # Of normal forces alone, all rows of which are asked for.
        if not call(displacer, (equations.rows, forces.ctypes.data, displacement.ctypes.data)):
            raise MemoryError("no room for what contact forces displace")


@njit(cache=True, inline="always")
def product(row, vector):
    """Product of two vectors as far as both go: rows leave out what contact does not move, or have room behind them."""
    total = 0.0
    for c in range(min(len(row), len(vector))):
        total += row[c] * vector[c]
    return total
