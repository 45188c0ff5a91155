"""The mixed form over a face without friction, by Cholesky's factors of the compliance C between closed nodes:

    G q - C p   = g,    K q + G^T p = F    give    (K + G^T C^-1 G) q = F + G^T C^-1 g,    p = C^-1 (G q - g)

A position's factors last until other nodes are closed. Runs of a search begin with the nodes that the run before
closed, so that their first iteration finds its factors; and what they give is the same to the last digit whatever came
before.
"""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import numpy as np
from numba import carray, cfunc, njit
from numba.extending import get_cython_function_address

from fenics_gears.contact.addresses import call, to_integer, to_number
from fenics_gears.system.memory import pages

# Of the largest pivot: a compliance with smaller ones is left to elimination with a search for pivots.
LEAST_PIVOT = 1e-6
# What LAPACK is told: the factor stands left of the right sides and is a lower one, as it is or transposed; its
# diagonal is not of ones. And bytes of its integers.
LEFT, LOWER, PLAIN, TRANSPOSED = (ord(letter) for letter in "LLNT")
INT = 4


class Factors:
    """Room for the factors between some of n nodes, which takes memory as far as it is used; `table` is for compiled
    code: addresses of the room, of how many nodes are factored and which, and of BLAS' dtrsm and LAPACK's dpotrf."""

    def __init__(self, nodes: int):
        self._arrays = pages(nodes, nodes), np.zeros(nodes + 1, dtype=np.int64)
        self.table = np.array([*(array.ctypes.data for array in self._arrays), *_library()])


@cache
def _library() -> tuple[int, int]:
    # Numpy in compiled code has neither of them by itself.
    blas, lapack = "scipy.linalg.cython_blas", "scipy.linalg.cython_lapack"
    return get_cython_function_address(blas, "dtrsm"), get_cython_function_address(lapack, "dpotrf")


class _Problem(NamedTuple):
    """Arrays of the mixed form, and its `closed` nodes (a,); forces are in units of `unit` N per mm, so that entries
    of the compliance are near one."""

    compliance: np.ndarray
    jacobian: np.ndarray
    gap: np.ndarray
    stiffness: np.ndarray
    load: np.ndarray
    closed: np.ndarray
    unit: float


@cache
def factored_solver():
    """The C function behind `mixed_form.solve_factored`, compiled or loaded where there is a face: a plane run does
    without."""
    return cfunc("int64(int64)", cache=True, error_model="numpy")(_solve)


def _solve(address):
    """Returns 1, or 0 where the compliance is not safely positive or the drivetrain is loose."""
    at = carray(to_integer(address), 12)
    n, k, size, table = at[1], at[2], at[3], carray(to_integer(at[0]), 4)
    compliance = carray(to_number(at[5]), (n, n))
    problem = _Problem(
        compliance,
        carray(to_number(at[6]), (n, k)),
        carray(to_number(at[7]), n),
        carray(to_number(at[8]), (k, k)),
        carray(to_number(at[9]), k),
        carray(to_integer(at[4]), size),
        1.0 / compliance[0, 0],
    )
    room, nodes = carray(to_number(table[0]), n * n), carray(to_integer(table[1]), n + 1)
    columns = room[: size * size].reshape(size, size)
    if not _are_factored(nodes, problem.closed) and not _factor(problem, columns, nodes, table[3]):
        return 0
    # Right sides G and g.
    sides = np.empty((k + 1, size))
    for a in range(size):
        node = problem.closed[a]
        for c in range(k):
            sides[c, a] = problem.jacobian[node, c]
        sides[k, a] = problem.gap[node]
    _put_solution(table[2], columns, sides, PLAIN)
    products = np.dot(sides, sides.T)
    try:
        position = np.linalg.solve(
            problem.stiffness / problem.unit + products[:k, :k], problem.load / problem.unit + products[:k, k]
        )
    except Exception:
        # Singular; compiled code tells no kinds of errors apart.
        return 0
    found = (np.dot(position, sides[:k]) - sides[k]).reshape(1, size)
    _put_solution(table[2], columns, found, TRANSPOSED)
    forces, coordinates = carray(to_number(at[10]), n), carray(to_number(at[11]), k)
    forces[:], coordinates[:] = 0.0, position
    for a in range(size):
        forces[problem.closed[a]] = problem.unit * found[0, a]
    return 1


@njit(cache=True)
def _are_factored(nodes, closed):
    if nodes[0] != len(closed):
        return False
    for a in range(len(closed)):
        if nodes[a + 1] != closed[a]:
            return False
    return True


@njit(cache=True)
def _factor(problem, columns, nodes, cholesky):
    """Put Cholesky's factor L of the compliance between the closed nodes into `columns`, whose row j is column j of L,
    by dpotrf, whose address is `cholesky`; returns whether it is safely positive."""
    closed, size, least, largest = problem.closed, len(problem.closed), np.inf, 0.0
    for a in range(size):
        _put_entries(columns[a], problem.compliance[closed[a]], closed, a, problem.unit)
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
def _put_entries(entries, values, places, first, unit):
    """Put the values at the places from the `first` on, times the unit."""
    # A function of its own, and unsigned places: so no entry is looked at for a negative index.
    for b in range(np.uint64(first), np.uint64(len(places))):
        entries[b] = unit * values[np.uint64(places[b])]


@njit(cache=True)
def _put_solution(triangular, columns, sides, kind):
    """Put L^-1 b, or L^-T b if the `kind` is TRANSPOSED, of right sides b (s, a) in their place, by dtrsm, whose
    address is `triangular`."""
    # By columns as BLAS reads them: a right side is a column. A letter is the first byte of its number.
    numbers, one = np.array([LEFT, LOWER, kind, PLAIN, len(columns), len(sides)], dtype=np.int32), np.ones(1)
    at, scale = np.int64(numbers.ctypes.data), np.int64(one.ctypes.data)
    rows, count = at + 4 * INT, at + 5 * INT
    matrix, result = columns.ctypes.data, sides.ctypes.data
    call(triangular, (at, at + INT, at + 2 * INT, at + 3 * INT, rows, count, scale, matrix, rows, result, rows))
    # Named once more, for compiled code gives back an array as soon as nothing names it.
    numbers[0] = one[0] = 0
