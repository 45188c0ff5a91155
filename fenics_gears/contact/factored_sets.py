"""The mixed form over a face without friction: compliances of closed nodes are factored once, and sets that differ
border the system (P. E. Gill, W. Murray, M. A. Saunders, M. H. Wright, A Schur-complement method for sparse quadratic
programming, 1990).

With the compliance C of the nodes A that were factored, forces p of them, p_N of nodes N that closed since, and the
openings o of nodes R that opened since,

    C p + C_AN p_N + E o - G_A q = -g_A
    C_NA p + C_NN p_N - G_N q    = -g_N
    E^T p                        = 0
    G_A^T p + G_N^T p_N + K q    = F

where E takes R out of A. Designs of a search, loads and mesh cycles close nearly the same nodes at a position.
"""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import numpy as np
from numba import carray, cfunc, njit
from numba.extending import get_cython_function_address

from fenics_gears.contact.addresses import call, to_integer, to_number
from fenics_gears.system.memory import pages

# More changes than this part of the closed nodes are factored anew.
MOST_CHANGED = 0.2
# Of the largest pivot: a compliance with smaller ones is not factored.
LEAST_PIVOT = 1e-6
# What LAPACK is told: the factor stands left of the right sides and is a lower one, as it is or transposed; its
# diagonal is not of ones.
LEFT, LOWER, PLAIN, TRANSPOSED = (ord(letter) for letter in "LLNT")
# Bytes of its integers.
INT = 4


class _Problem(NamedTuple):
    """Arrays of the mixed form, and its `closed` nodes in increasing order; forces are carried in units of `unit` N
    per mm, so that all entries of contact rows are near one."""

    compliance: np.ndarray
    jacobian: np.ndarray
    gap: np.ndarray
    stiffness: np.ndarray
    load: np.ndarray
    closed: np.ndarray
    unit: float


class _Factors(NamedTuple):
    """Cholesky factor L of the compliance between the nodes (a,) factored, in units of the first entry: `columns`
    (a, a), row j being column j of L; `triangular`: address of dtrsm."""

    nodes: np.ndarray
    columns: np.ndarray
    triangular: int


class Factors:
    """Room for the factors of sets of n nodes, which takes memory as far as it is used; `table` is for compiled code:
    addresses of the room, of how many nodes are factored and which, and of functions of BLAS and LAPACK."""

    def __init__(self, nodes: int):
        self._arrays = pages(nodes, nodes), np.zeros(nodes + 1, dtype=np.int64)
        self.table = np.array([*(array.ctypes.data for array in self._arrays), *_library()])


@cache
def _library() -> tuple[int, int]:
    """Addresses of BLAS' dtrsm and LAPACK's dpotrf, which numpy in compiled code has not."""
    return (
        get_cython_function_address("scipy.linalg.cython_blas", "dtrsm"),
        get_cython_function_address("scipy.linalg.cython_lapack", "dpotrf"),
    )


@cache
def sets_solver():
    """The C function behind `mixed_form.solve_factored`, compiled or loaded where there is a face: a plane run does without."""
    return cfunc("int64(int64)", cache=True, error_model="numpy")(_solve)


def _solve(address):
    """Returns 1, or 0 where there is no solution this way; what is raised in a C function is caught here."""
    at = carray(to_integer(address), 12)
    n, k, table = at[1], at[2], carray(to_integer(at[0]), 4)
    compliance = carray(to_number(at[5]), (n, n))
    problem = _Problem(
        compliance,
        carray(to_number(at[6]), (n, k)),
        carray(to_number(at[7]), n),
        carray(to_number(at[8]), (k, k)),
        carray(to_number(at[9]), k),
        carray(to_integer(at[4]), at[3]),
        1.0 / compliance[0, 0],
    )
    room, nodes = carray(to_number(table[0]), n * n), carray(to_integer(table[1]), n + 1)
    iterate = carray(to_number(at[10]), n), carray(to_number(at[11]), k)
    opened, added = _changes(nodes[1 : nodes[0] + 1], problem.closed)
    if len(opened) + len(added) > MOST_CHANGED * len(problem.closed):
        if not _factor(problem, room, nodes, table[3]):
            return 0
        opened, added = opened[:0], added[:0]
    factored = nodes[0]
    factors = _Factors(nodes[1 : factored + 1], room[: factored * factored].reshape(factored, factored), table[2])
    return _solve_bordered(problem, factors, (opened, added), iterate)


@njit(cache=True)
def _changes(factored, closed):
    """Places in `factored` of nodes that are not closed, and closed nodes that are not factored; both increase."""
    opened, added = np.empty(len(factored), dtype=np.int64), np.empty(len(closed), dtype=np.int64)
    i, j, gone, new = 0, 0, 0, 0
    while i < len(factored) or j < len(closed):
        if j == len(closed) or i < len(factored) and factored[i] < closed[j]:
            opened[gone] = i
            gone, i = gone + 1, i + 1
        elif i == len(factored) or closed[j] < factored[i]:
            added[new] = closed[j]
            new, j = new + 1, j + 1
        else:
            i, j = i + 1, j + 1
    return opened[:gone], added[:new]


@njit(cache=True)
def _gathered(values, rows, columns, unit):
    """Entries of a matrix at some rows and columns, times the unit."""
    found = np.empty((len(rows), len(columns)))
    for a in range(len(rows)):
        row = values[rows[a]]
        for b in range(len(columns)):
            found[a, b] = unit * row[columns[b]]
    return found


@njit(cache=True)
def _factor(problem, room, nodes, cholesky):
    """Factor the compliance between the closed nodes by dpotrf, whose address is `cholesky`; returns whether it is
    safely positive."""
    closed, size, unit = problem.closed, len(problem.closed), problem.unit
    columns, least, largest = room[: size * size].reshape(size, size), np.inf, 0.0
    for a in range(size):
        row = problem.compliance[closed[a]]
        for b in range(a, size):
            columns[a, b] = unit * row[closed[b]]
    nodes[0] = 0
    # A letter is the first byte of its number.
    numbers = np.array([LOWER, size, 0], dtype=np.int32)
    at = np.int64(numbers.ctypes.data)
    call(cholesky, (at, at + INT, columns.ctypes.data, at + INT, at + 2 * INT))
    for j in range(size):
        least, largest = min(least, columns[j, j]), max(largest, columns[j, j])
    # Not positive where nodes depend on each other.
    if numbers[2] != 0 or least**2 < LEAST_PIVOT * largest**2:
        return False
    nodes[0], nodes[1 : size + 1] = size, closed
    return True


@njit(cache=True)
def _put_solution(factors, sides, kind):
    """Put L^-1 b, or L^-T b if the `kind` is TRANSPOSED, of right sides b (s, a) in their place, by dtrsm."""
    # By columns as LAPACK reads them: a right side is a column. A letter is the first byte of its number.
    numbers, one = np.array([LEFT, LOWER, kind, PLAIN, len(factors.nodes), len(sides)], dtype=np.int32), np.ones(1)
    at, scale = np.int64(numbers.ctypes.data), np.int64(one.ctypes.data)
    rows, columns = at + 4 * INT, at + 5 * INT
    matrix, result = factors.columns.ctypes.data, sides.ctypes.data
    call(
        factors.triangular, (at, at + INT, at + 2 * INT, at + 3 * INT, rows, columns, scale, matrix, rows, result, rows)
    )
    # Named once more, for compiled code gives back an array as soon as nothing names it.
    numbers[0] = one[0] = 0


@njit(cache=True)
def _solve_bordered(problem, factors, changes, iterate):
    """Solve for the nodes factored, with the openings of those `opened` and the forces of those `added`."""
    (opened, added), (forces, coordinates), unit = changes, iterate, problem.unit
    nodes, k, e, size = factors.nodes, len(problem.load), len(opened), len(added)
    # Right sides: of added nodes, opened ones, coordinates and the gap.
    border = size + e + k
    sides = np.zeros((border + 1, len(nodes)))
    sides[:size] = _gathered(problem.compliance, added, nodes, unit)
    for place in range(e):
        sides[size + place, opened[place]] = 1.0
    for a in range(len(nodes)):
        for c in range(k):
            sides[size + e + c, a] = -problem.jacobian[nodes[a], c]
        sides[border, a] = problem.gap[nodes[a]]
    _put_solution(factors, sides, PLAIN)
    products = np.dot(sides, sides.T)
    # Forces of nodes factored are -C^-1 of what the border's unknowns t and the gap give: the border's own equations
    # are B - S^T S of these.
    matrix, right_side = -products[:border, :border], products[:border, border].copy()
    matrix[:size, :size] += _gathered(problem.compliance, added, added, unit)
    for a in range(size):
        for c in range(k):
            matrix[a, size + e + c] -= problem.jacobian[added[a], c]
            matrix[size + e + c, a] -= problem.jacobian[added[a], c]
        right_side[a] -= problem.gap[added[a]]
    for c in range(k):
        for d in range(k):
            matrix[size + e + c, size + e + d] -= problem.stiffness[c, d] / unit
        right_side[size + e + c] -= problem.load[c] / unit
    try:
        solution = np.linalg.solve(matrix, right_side)
    except Exception:
        # Sets that leave the system singular; the general way says so.
        return 0
    of_factored = -(np.dot(solution, sides[:border]) + sides[border]).reshape(1, -1)
    _put_solution(factors, of_factored, TRANSPOSED)
    found = of_factored[0]
    forces[:] = 0.0
    for a in range(len(nodes)):
        forces[nodes[a]] = unit * found[a]
    for place in opened:
        forces[nodes[place]] = 0.0
    for a in range(size):
        forces[added[a]] = unit * solution[a]
    coordinates[:] = solution[size + e :]
    return 1
