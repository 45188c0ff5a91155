"""The mixed form of meshes that move together over the face, without friction, mesh by mesh: no compliance between all
contact nodes is formed.

With C_m of each mesh by itself, and Phi_s how the motions of the body on one of its sides s, a gear that other meshes
load too, move its nodes, the forces p_m on its closed nodes follow from

    C_m p_m = G_m q - g_m - sum_s Phi_s v_s,    v_s = sum_t H_st Phi_t^T p_t,    K q + sum_m G_m^T p_m = F

v_s being what forces on the other sides t of that gear displace. Each C_m is factored by itself, and its factors last
with C_m^-1 Phi_s until its own sets change. Equations for v and q are left. Gears have to do
with each other through common meshes alone, so that v is eliminated gear by gear, planets and idlers before those of
more meshes.
"""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import numpy as np
from numba import carray, cfunc, njit

from .addresses import KNOWN, ROOM, forces_at, form_rows, to_integer, to_number
from .factored_compliance import END, SOURCE, Factored, System, has_factors, put_solutions
from .joined_table import (
    COUNT,
    FACTORS,
    FIRST,
    GEAR,
    LASTING,
    LOADED,
    MOTIONS,
    MOTIONS_OF_LOADED,
    MOVES,
    PART,
    SIDE,
    SIDE_OF_LOADED,
    TABLE,
    between_motions,
    moved_by,
    own_compliance,
    tables_of,
)
from .mixed_form import put_solution, system_of


class _Border(NamedTuple):
    """Unknowns v and q: `places` (sides,) of the motions of each side among them, how many v there are, and where those
    of each gear end.

    Of each part: `counts` (p,) of the unknowns that it has to do with, motions first, their `numbers` (p, c), and
    `sums` (p, c + 1, c + 1) of what moves its closed nodes times the forces that this takes, N/mm, the gaps last.
    """

    places: np.ndarray
    motions: int
    ends: np.ndarray
    counts: np.ndarray
    numbers: np.ndarray
    sums: np.ndarray


@cache
def joined_solver():
    """The C function behind `mixed_form.solve_factored` of meshes together."""
    return cfunc("int64(int64)", cache=True, error_model="numpy")(_solve)


def _solve(address):
    """Returns 1, or 0 where a compliance is not safely regular or the drivetrain is loose."""
    at = carray(to_integer(address), 14)
    tables, m, k, size = tables_of(at[0]), at[1], at[2], at[3]
    rows, opening = carray(to_integer(at[9]), size), carray(to_number(at[11]), size)
    jacobian, result = carray(to_number(at[6]), (m, k)), carray(to_number(at[12]), m + k)
    stiffness, load = carray(to_number(at[7]), (k, k)), carray(to_number(at[8]), k)
    ends = np.searchsorted(rows, np.append(tables.parts[:, FIRST], m))
    border = _border(tables, k)
    solutions = np.empty((border.sums.shape[1], size))
    unit = 1.0 / own_compliance(tables.parts[0])[0, 0]
    for number in range(len(tables.parts)):
        own = slice(ends[number], ends[number + 1])
        if not _put_part(tables, number, border, (rows[own], opening[own], jacobian), solutions[:, own]):
            return 0
    matrix = _put_border(tables, border, stiffness, load, unit)
    if not _eliminate(matrix, border, k):
        return 0
    unknowns = matrix[:, -1].copy()
    result[:m], result[m:] = 0.0, unknowns[border.motions :]
    unknowns[: border.motions] *= -1.0
    for number in range(len(tables.parts)):
        count = border.counts[number]
        weights = np.append(unknowns[border.numbers[number, :count]], -1.0)
        own = slice(ends[number], ends[number + 1])
        result[rows[own]] = np.dot(weights, np.ascontiguousarray(solutions[: count + 1, own]))
    return 1


@njit(cache=True)
def _border(tables, k):
    """Room for the border, with the numbers of motions."""
    sides, parts = tables.sides, tables.parts
    ends = np.cumsum(sides[:, MOTIONS])
    of_gears = np.zeros(1 + (sides[:, GEAR].max() if len(sides) else 0), dtype=np.int64)
    counts = np.zeros(len(parts), dtype=np.int64)
    numbers = np.empty((len(parts), k + parts[:, MOVES].max()), dtype=np.int64)
    for side, end in zip(sides, ends):
        own = counts[side[PART]]
        numbers[side[PART], own : own + side[MOTIONS]] = np.arange(end - side[MOTIONS], end)
        counts[side[PART]] += side[MOTIONS]
        of_gears[side[GEAR]] = end
    most = 1 + numbers.shape[1]
    motions = ends[-1] if len(sides) else 0
    return _Border(ends - sides[:, MOTIONS], motions, of_gears, counts, numbers, np.zeros((len(parts), most, most)))


@njit(cache=True)
def _put_part(tables, number, border, closed, solutions):
    """Put what a part adds to the border into place, and the forces (c + 1, a) on its closed nodes for each of its
    unknowns; `closed`: rows and openings of these, and the jacobian of all. Returns whether its compliance is safely
    regular."""
    part, (rows, opening, jacobian) = tables.parts[number], closed
    size, motions, own, count = len(rows), part[MOVES], rows - part[FIRST], border.counts[number]
    for c in range(jacobian.shape[1] if size else 0):
        if jacobian[rows, c].any():
            border.numbers[number, count] = border.motions + c
            count += 1
    border.counts[number] = count
    if size == 0:
        return True
    moving, forces = np.empty((count + 1, size)), np.empty((count + 1, size))
    if not _put_moved(tables, number, own, jacobian, moving[:motions], forces[:motions]):
        return False
    for c in range(motions, count):
        moving[c] = jacobian[rows, border.numbers[number, c] - border.motions]
    moving[count] = opening
    factored, system = _system_of(part, own, jacobian)
    forces[motions:] = moving[motions:]
    put_solutions(factored, forces[motions:], False)
    border.sums[number, : count + 1, : count + 1] = system.unit * np.dot(moving, forces.T)
    solutions[: count + 1] = forces * system.unit
    return True


@njit(cache=True)
def _put_moved(tables, number, own, jacobian, moving, forces):
    """Put into place how the motions of a part's sides move some of its nodes, (c, a), and the forces that this takes,
    which last as long as its factors; returns whether its compliance is safely regular."""
    part, size = tables.parts[number], len(own)
    factored, system = _system_of(part, own, jacobian)
    kept = carray(to_number(part[LASTING]), (2, part[MOVES], part[COUNT]))
    if np.array_equal(forces_at(factored.table[KNOWN])[1:], own):
        moving[:], forces[:] = kept[0, :, :size], kept[1, :, :size]
        return True
    if factored.table[SOURCE] == 0:
        form_rows(part[TABLE], own)
    if not has_factors(factored, system):
        return False
    first = 0
    for side in tables.sides:
        if side[PART] == number:
            moved = moved_by(side, part[COUNT])
            for a in range(size):
                moving[first : first + side[MOTIONS], a] = moved[own[a]]
            first += side[MOTIONS]
    forces[:] = moving
    put_solutions(factored, forces, False)
    kept[0, :, :size], kept[1, :, :size] = moving, forces
    return True


@njit(cache=True)
def _system_of(part, own, jacobian):
    """The compliance of some nodes of a part, and the room for its factors."""
    size, nothing, compliance = len(own), np.empty(0), own_compliance(part)
    table, lines = carray(to_integer(part[FACTORS]), END), np.empty((0, size))
    factored = Factored(carray(to_number(table[ROOM]), (size, size)), own, nothing, lines, lines, table)
    return factored, System(compliance, jacobian, jacobian, nothing, own, nothing, nothing, 1.0 / compliance[0, 0])


@njit(cache=True)
def _put_border(tables, border, stiffness, load, unit):
    """The equations for v and q, forces in `unit` N/mm, right side last."""
    motions, k = border.motions, len(load)
    matrix = np.zeros((motions + k, motions + k + 1))
    for v in range(motions):
        matrix[v, v] = 1.0
    matrix[motions:, motions:-1] = stiffness / unit
    matrix[motions:, -1] = load / unit
    for number in range(len(tables.parts)):
        for j in range(border.counts[number]):
            if border.numbers[number, j] >= motions:
                _add_sums(matrix, border, number, border.numbers[number, j], border.sums[number, j], 1.0 / unit)
    for coupling in tables.couplings:
        _couple(matrix, border, coupling)
    return matrix


@njit(cache=True)
def _add_sums(matrix, border, number, row, sums, weight):
    """Add what forces of a part do, by the unknowns that they follow from, times a weight to a row of the border."""
    count = border.counts[number]
    for j in range(count):
        unknown = border.numbers[number, j]
        matrix[row, unknown] += weight * sums[j] if unknown >= border.motions else -weight * sums[j]
    matrix[row, -1] += weight * sums[count]


@njit(cache=True)
def _couple(matrix, border, coupling):
    """Subtract what forces of the part that is loaded displace on the side that responds."""
    number, loaded = coupling[LOADED], border.places[coupling[SIDE_OF_LOADED]]
    count, numbers, first = border.counts[number], border.numbers[number], 0
    # Its unknowns stand one after the other.
    while numbers[first] != loaded:
        first += 1
    sums = border.sums[number, first : first + coupling[MOTIONS_OF_LOADED], : count + 1]
    moved = np.dot(between_motions(coupling), np.ascontiguousarray(sums))
    for motion in range(coupling[MOTIONS]):
        _add_sums(matrix, border, number, border.places[coupling[SIDE]] + motion, moved[motion], -1.0)


@njit(cache=True)
def _eliminate(matrix, border, k):
    """Put the unknowns into the last column of the border; returns whether there are any."""
    begin = 0
    for end in border.ends:
        if end > begin:
            _eliminate_gear(matrix, begin, end)
        begin = max(begin, end)
    left, found = system_of(k), matrix[begin:, -1].copy()
    left[:, :k] = matrix[begin:, begin:-1]
    if not put_solution(left, found, np.int64(0)):
        return False
    matrix[begin:, -1] = found
    ends = border.ends
    for gear in range(len(ends) - 1, -1, -1):
        first, end = ends[gear - 1] if gear else 0, ends[gear]
        for v in range(first, end):
            for other in range(end, len(matrix)):
                matrix[v, -1] -= matrix[v, other] * matrix[other, -1]
    return True


@njit(cache=True)
def _eliminate_gear(matrix, begin, end):
    """Eliminate the unknowns from `begin` to `end`, which have to do with few of those after them."""
    last = matrix.shape[1] - 1
    columns = np.array([c for c in range(end, last + 1) if c == last or matrix[begin:end, c].any()])
    rows = np.array([r for r in range(end, len(matrix)) if matrix[r, begin:end].any()])
    sides = np.empty((end - begin, len(columns)))
    for j in range(len(columns)):
        sides[:, j] = matrix[begin:end, columns[j]]
    sides = np.linalg.solve(matrix[begin:end, begin:end].copy(), sides)
    for j in range(len(columns)):
        matrix[begin:end, columns[j]] = sides[:, j]
    factors = np.empty((len(rows), end - begin))
    for i in range(len(rows)):
        factors[i] = matrix[rows[i], begin:end]
    changes = np.dot(factors, sides)
    for i in range(len(rows)):
        for j in range(len(columns)):
            matrix[rows[i], columns[j]] -= changes[i, j]
