"""The mixed form over a face, by factors of the compliance between closed nodes that last from run to run.

With C the compliance of the unknown forces p, which with friction includes what slipping nodes add, and G~ the jacobian
of these forces,

    G q - C p = g,    K q + G~^T p = F    give    (K + G~^T C^-1 G) q = F + G~^T C^-1 g,    p = C^-1 (G q - g)

Factors are Cholesky's without friction, else those of elimination with pivots; with friction a position has both, for
Newton's method begins without it. They last until the sets change: the march finds there those of the mesh cycle
before; a run of a search, those of the run before. What they give is the same to the last digit whatever came before.
"""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import numpy as np
from numba import carray, cfunc, njit
from numba.extending import get_cython_function_address

from fenics_gears.system.memory import pages

from .addresses import KNOWN, OF_FRICTION, PIVOTS, ROOM, call, to_integer, to_number
from .mixed_form import add_slip, put_entries, put_solution, system_of

# Of the largest pivot: a compliance with smaller ones is left to elimination that looks for pivots in all unknowns.
LEAST_PIVOT = 1e-6
# What LAPACK is told; and bytes of its integers.
LOWER, TRANSPOSED = ord("L"), ord("T")
INT = 4
# After the addresses of rooms in the table of Factors those of LAPACK's functions.
POTRF, POTRS, GETRF, GETRS = range(5, 9)


class Factors:
    """Room for factors between some of m forces of n nodes, without and with friction, which takes memory as far as it
    is used; `table` is for compiled code."""

    def __init__(self, nodes: int, forces: int):
        rooms = [(pages(size, size), np.zeros(2 * size + 1)) for size in (nodes, forces)]
        self._arrays = *rooms[0], *rooms[1], np.zeros(forces, dtype=np.int32)
        self.table = np.array([*(array.ctypes.data for array in self._arrays), *_lapack()])


@cache
def _lapack() -> list[int]:
    # Numpy in compiled code has no functions that solve with factors.
    module = "scipy.linalg.cython_lapack"
    return [get_cython_function_address(module, name) for name in ("dpotrf", "dpotrs", "dgetrf", "dgetrs")]


class _System(NamedTuple):
    """The mixed form, m forces of n nodes: `rows` (a,) of the unknown forces, `slip` (b,) tangential forces per normal
    one of the first b of them, none without friction; right side `opening` (a,), mm. Forces are in units of `unit`
    N/mm, so that entries of the compliance are near one."""

    compliance: np.ndarray
    jacobian: np.ndarray
    stiffness: np.ndarray
    load: np.ndarray
    rows: np.ndarray
    slip: np.ndarray
    opening: np.ndarray
    unit: float


class _Factored(NamedTuple):
    """Factors: `matrix` (a, a), by columns as LAPACK reads them, of the transposed compliance; whose they are
    (`known`); and the `table` of Factors."""

    matrix: np.ndarray
    known: np.ndarray
    table: np.ndarray


@cache
def factored_solver():
    """The C function behind `mixed_form.solve_factored`, compiled or loaded where there is a face: a plane run does
    without."""
    return cfunc("int64(int64)", cache=True, error_model="numpy")(_solve)


def _solve(address):
    """Returns 1, or 0 where the compliance is not safely regular or the drivetrain is loose."""
    at = carray(to_integer(address), 13)
    m, k, size, slipping, table = at[1], at[2], at[3], at[4], carray(to_integer(at[0]), 9)
    compliance = carray(to_number(at[5]), (m, m))
    system = _System(
        compliance,
        carray(to_number(at[6]), (m, k)),
        carray(to_number(at[7]), (k, k)),
        carray(to_number(at[8]), k),
        carray(to_integer(at[9]), size),
        carray(to_number(at[10]), slipping),
        carray(to_number(at[11]), size),
        1.0 / compliance[0, 0],
    )
    room = OF_FRICTION if slipping else 0
    factored = _Factored(
        carray(to_number(table[room + ROOM]), (size, size)),
        carray(to_number(table[room + KNOWN]), size + slipping + 1),
        table,
    )
    if not _are_known(factored.known, system) and not _factor(factored, system):
        return 0
    return _solve_with(factored, system, carray(to_number(at[12]), m + k))


@njit(cache=True)
def _are_known(known, system):
    size, slip = len(system.rows), system.slip
    if known[0] != size:
        return False
    for a in range(size):
        if known[1 + a] != system.rows[a]:
            return False
    for b in range(len(slip)):
        if known[1 + size + b] != slip[b]:
            return False
    return True


@njit(cache=True)
def _factor(factored, system):
    """Put the factors of a system into place; returns whether they are safely regular."""
    compliance, slip, rows, size = system.compliance, system.slip, system.rows, len(system.rows)
    matrix, n = factored.matrix, len(compliance) // 2
    for a in range(size):
        row = compliance[rows[a]]
        put_entries(matrix[a], row, rows, np.int64(0) if len(slip) else a, system.unit)
        if len(slip):
            add_slip(matrix[a], row[n:], rows, slip, system.unit)
    factored.known[0] = 0.0
    if not _eliminate(factored, len(slip) > 0):
        return False
    factored.known[0], factored.known[1 : size + 1] = size, rows
    factored.known[size + 1 : size + 1 + len(slip)] = slip
    return True


@njit(cache=True)
def _eliminate(factored, slipping):
    """Put factors into the place of the matrix; returns whether they are safely regular."""
    matrix, least, largest = factored.matrix, np.inf, 0.0
    # A letter is the first byte of its number.
    numbers = np.array([LOWER, len(matrix), 0], dtype=np.int32)
    at, address = np.int64(numbers.ctypes.data), matrix.ctypes.data
    size, info = at + INT, at + 2 * INT
    if slipping:
        call(factored.table[GETRF], (size, size, address, size, factored.table[PIVOTS], info))
    else:
        call(factored.table[POTRF], (at, size, address, size, info))
    for j in range(len(matrix)):
        # Cholesky's diagonal has the roots of pivots.
        pivot = abs(matrix[j, j]) if slipping else matrix[j, j] ** 2
        least, largest = min(least, pivot), max(largest, pivot)
    # Not regular where nodes depend on each other.
    return numbers[2] == 0 and least >= LEAST_PIVOT * largest


@njit(cache=True)
def _put_solutions(factored, sides, slipping):
    """Put C^-1 b of right sides b (s, a) in their place."""
    # By columns as LAPACK reads them: a right side is a column, and the matrix is the transposed one.
    numbers = np.array([TRANSPOSED if slipping else LOWER, len(factored.matrix), len(sides), 0], dtype=np.int32)
    at, matrix, result = np.int64(numbers.ctypes.data), factored.matrix.ctypes.data, sides.ctypes.data
    size, count, info = at + INT, at + 2 * INT, at + 3 * INT
    if slipping:
        call(factored.table[GETRS], (at, size, count, matrix, size, factored.table[PIVOTS], result, size, info))
    else:
        call(factored.table[POTRS], (at, size, count, matrix, size, result, size, info))
    # Named once more, for compiled code gives back an array as soon as nothing names it.
    numbers[3] = 0


@njit(cache=True)
def _solve_with(factored, system, result):
    """Put forces (m,), N, and coordinates (k,), mm, into `result`; returns 1, or 0 where the drivetrain is loose."""
    rows, slip, jacobian, unit = system.rows, system.slip, system.jacobian, system.unit
    k, m, size = len(system.load), len(jacobian), len(rows)
    n, sides, of_forces = m // 2, np.empty((k + 1, size)), np.empty((k, size))
    sides[k] = system.opening
    for a in range(size):
        for c in range(k):
            sides[c, a] = of_forces[c, a] = jacobian[rows[a], c]
            if a < len(slip):
                of_forces[c, a] += slip[a] * jacobian[n + rows[a], c]
    _put_solutions(factored, sides, len(slip) > 0)
    products = np.dot(of_forces, sides.T)
    matrix, position = system_of(k), system.load / unit + products[:, k]
    matrix[:, :k] = system.stiffness / unit + products[:, :k]
    if not put_solution(matrix, position, np.int64(0)):
        return 0
    found = np.dot(position, sides[:k]) - sides[k]
    result[:m], result[m:] = 0.0, position
    for a in range(size):
        result[rows[a]] = unit * found[a]
    for b in range(len(slip)):
        result[n + rows[b]] += slip[b] * result[rows[b]]
    return 1
