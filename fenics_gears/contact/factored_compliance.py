"""The mixed form over a face, by factors of the compliance between closed nodes that last from run to run.

With C the compliance of the unknown forces p, which with friction includes what slipping nodes add, and G~ the jacobian
of these forces,

    G q - C p = g,    K q + G~^T p = F    give    (K + G~^T C^-1 G) q = F + G~^T C^-1 g,    p = C^-1 (G q - g)

Factors are Cholesky's without friction, else those of elimination with pivots; with friction a position has both, for
Newton's method begins without it. They last until the sets change: the march finds there those of the mesh cycle
before; a run of a search, those of the run before.
"""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import numpy as np
from numba import carray, cfunc, njit
from numba.extending import get_cython_function_address

from fenics_gears.system.memory import pages

from .addresses import (
    KNOWN,
    MARCH,
    OF_FRICTION,
    PIVOTS,
    PRESENT,
    ROOM,
    call,
    forces_at,
    form_rows,
    former_of,
    marching,
    present_march,
    to_integer,
    to_number,
)
from .mixed_form import add_slip, put_entries, put_solution, system_of

# Of the largest pivot: a compliance with smaller ones is left to elimination that looks for pivots in all unknowns.
LEAST_PIVOT = 1e-6
# What LAPACK is told; and bytes of its integers.
LOWER, TRANSPOSED = ord("L"), ord("T")
INT = 4
# In the table of Factors after what `addresses` names: slip of what is factored with friction, room for `lines`; and
# LAPACK's functions. Then, where there are no rows (`contact.closed_compliance`): the address of the table of their
# FormedRows, else 0, and the function that forms what is between closed nodes; this compliance by slots, the node of
# each slot, and how many slots there are, followed by the slot of each node or -1.
SLIP, LINES, POTRF, POTRS, GETRF, GETRS, SOURCE, FORMER, CLOSED, MEMBERS, SLOTS = range(PRESENT + 1, PRESENT + 12)
END = SLOTS + 1


class Factors:
    """Room for factors between some of m forces of n nodes, without and with friction, which takes memory as far as it
    is used; `table` is for compiled code. `source`: address of the table of a FormedRows that is solved without its
    rows, else 0."""

    def __init__(self, nodes: int, forces: int, source: int = 0):
        rooms = [(pages(size, size), np.zeros(size + 1, dtype=np.int64)) for size in (nodes, forces)]
        friction = np.zeros(forces, dtype=np.int32), np.zeros(forces), pages(forces, forces)
        slots = np.full(nodes + 1, -1)
        slots[0] = 0
        closed = (pages(nodes, nodes), np.zeros(nodes, dtype=np.int64), slots) if source else ()
        self.arrays = *rooms[0], *rooms[1], *friction, *closed
        addresses = [array.ctypes.data for array in self.arrays]
        numbers = [*addresses[:5], -1, marching.ctypes.data, *addresses[5:7], *_lapack(), source, former_of(source)]
        self.table = np.array([*numbers, *(addresses[7:] or [0, 0, 0])])


@cache
def _lapack() -> list[int]:
    # Numpy in compiled code has no functions that solve with factors.
    module = "scipy.linalg.cython_lapack"
    return [get_cython_function_address(module, name) for name in ("dpotrf", "dpotrs", "dgetrf", "dgetrs")]


class System(NamedTuple):
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


class Factored(NamedTuple):
    """Factors: `matrix` (a, a), by columns as LAPACK reads them, of the transposed compliance between the forces of
    `rows` (a,) with their `slip`, as of a System; and the `table` of Factors.

    `of_forces` (k, a): G~; first among `lines` is C^-1 G, with friction as long as the factors last.
    """

    matrix: np.ndarray
    rows: np.ndarray
    slip: np.ndarray
    of_forces: np.ndarray
    lines: np.ndarray
    table: np.ndarray


@cache
def factored_solver():
    """The C function behind `mixed_form.solve_factored`, compiled or loaded where there is a face: a plane run does
    without."""
    return cfunc("int64(int64)", cache=True, error_model="numpy")(_solve)


def _solve(address):
    """Returns 1, or 0 where the compliance is not safely regular or the drivetrain is loose."""
    at = carray(to_integer(address), 14)
    m, k, size, slipping, table = at[1], at[2], at[3], at[4], carray(to_integer(at[0]), END)
    compliance = carray(to_number(at[5]), (m, m))
    system = System(
        compliance,
        carray(to_number(at[6]), (m, k)),
        carray(to_number(at[7]), (k, k)),
        carray(to_number(at[8]), k),
        carray(to_integer(at[9]), size),
        carray(to_number(at[10]), slipping),
        carray(to_number(at[11]), size),
        1.0 / compliance[0, 0],
    )
    if table[SOURCE] == 0:
        form_rows(at[13], system.rows[: slipping if slipping else size])
    result = carray(to_number(at[12]), m + k)
    return _solve_slipping(system, table, result) if slipping else _solve_frictionless(system, table, result)


@njit(cache=True)
def _solve_frictionless(system, table, result):
    factored = _factored(table, system.rows, system.slip, len(system.load))
    if not has_factors(factored, system):
        return 0
    _put_motions(factored, system)
    return _solve_with(factored, system, result)


@njit(cache=True)
def has_factors(factored, system):
    """Put the factors of a system without friction into place, where they are not yet; returns whether they are safely
    regular."""
    known = forces_at(factored.table[KNOWN])
    if np.array_equal(known[1:], system.rows):
        return True
    known[0] = 0
    if not _factor(factored, system):
        return False
    _know(factored.table[KNOWN], system.rows)
    return True


@njit(cache=True)
def _solve_slipping(system, table, result):
    rows, slip, known = system.rows, system.slip, forces_at(table[OF_FRICTION + KNOWN])
    m, k = system.jacobian.shape
    if 2 * k + 1 > m:
        return 0
    then = known[1:]
    slip_then = carray(to_number(table[SLIP]), np.searchsorted(then, m // 2))
    factored = _factored(table, rows, slip, k)
    if not (np.array_equal(then, rows) and np.array_equal(slip_then, slip)):
        known[0] = 0
        if not _factor(factored, system):
            return 0
        _know(table[OF_FRICTION + KNOWN], rows)
        carray(to_number(table[SLIP]), len(slip))[:] = slip
    table[MARCH] = present_march(table)
    _put_motions(factored, system)
    return _solve_with(factored, system, result)


@njit(cache=True)
def _know(address, rows):
    known = carray(to_integer(address), 1 + len(rows))
    known[0], known[1:] = len(rows), rows


@njit(cache=True)
def _factored(table, rows, slip, k):
    """Room for the factors between some forces."""
    size, frictional = len(rows), len(slip) > 0
    matrix = carray(to_number(table[OF_FRICTION + ROOM if frictional else ROOM]), (size, size))
    if frictional:
        lines = carray(to_number(table[LINES]), (2 * k + 1, size))
    else:
        lines = np.empty((2 * k + 1, size))
    return Factored(matrix, rows, slip, lines[:k], lines[k:], table)


@njit(cache=True)
def _factor(factored, system):
    """Put the factors of a system into place; returns whether they are safely regular."""
    compliance, slip, rows, matrix = system.compliance, system.slip, system.rows, factored.matrix
    if factored.table[SOURCE] != 0:
        return _put_closed(factored, len(compliance), system.unit) and _eliminate(factored, False)
    n = len(compliance) // 2
    for a in range(len(rows)):
        row = compliance[rows[a]]
        put_entries(matrix[a], row, rows, np.int64(0) if len(slip) else a, system.unit)
        if len(slip):
            add_slip(matrix[a], row[n:], rows, slip, system.unit)
    return _eliminate(factored, len(slip) > 0)


@njit(cache=True)
def _put_closed(factored, n, unit):
    """Put what is between closed nodes into the matrix, of n nodes of which no rows are there; returns whether there
    was room."""
    table, rows, matrix = factored.table, factored.rows, factored.matrix
    if not call(table[FORMER], (table[SOURCE], table.ctypes.data, rows.ctypes.data, len(rows))):
        return False
    slots, known = carray(to_integer(table[SLOTS]), n + 1)[1:][rows], carray(to_number(table[CLOSED]), (n, n))
    for a in range(len(rows)):
        for b in range(a, len(rows)):
            matrix[a, b] = unit * known[max(slots[a], slots[b]), min(slots[a], slots[b])]
    return True


@njit(cache=True)
def _put_motions(factored, system):
    """Put what coordinates do to the factored forces into place, with friction solved for."""
    rows, slip, jacobian, n = factored.rows, factored.slip, system.jacobian, len(system.jacobian) // 2
    for a in range(len(rows)):
        for c in range(len(factored.of_forces)):
            factored.lines[c, a] = factored.of_forces[c, a] = jacobian[rows[a], c]
            if a < len(slip):
                factored.of_forces[c, a] += slip[a] * jacobian[n + rows[a], c]
    if len(slip):
        put_solutions(factored, factored.lines[: len(factored.of_forces)], True)


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
def put_solutions(factored, sides, slipping):
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
    rows, slip, unit, m = system.rows, system.slip, system.unit, len(system.jacobian)
    k, frictional = len(system.load), len(slip) > 0
    lines = factored.lines[: k + 1]
    lines[k] = system.opening
    put_solutions(factored, lines[k if frictional else 0 :], frictional)
    by_forces = np.dot(factored.of_forces, lines.T)
    matrix, coordinates = system_of(k), np.empty(k)
    for c in range(k):
        coordinates[c] = system.load[c] / unit + by_forces[c, k]
        for d in range(k):
            matrix[c, d] = system.stiffness[c, d] / unit + by_forces[c, d]
    if not put_solution(matrix, coordinates, np.int64(0)):
        return 0
    parts = np.empty(k + 1)
    parts[:k], parts[k] = coordinates, -1.0
    forces = np.dot(parts, lines)
    result[:m], result[m:] = 0.0, coordinates
    for a in range(len(rows)):
        result[rows[a]] = unit * forces[a]
    for b in range(len(slip)):
        result[m // 2 + rows[b]] += slip[b] * result[rows[b]]
    return 1
