"""The compliance between the contact nodes of meshes that move together: rows of single meshes side by side, and
between two meshes of one gear over the face a product of few motions. Rows are formed when their node is first closed,
as those of a mesh over the face by itself (`contact.formed_rows`).
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import NamedTuple

import numpy as np
from numba import carray, cfunc, njit

from fenics_gears.system.memory import pages

from .addresses import displacer_of, form_rows, to_flag, to_integer, to_number
from .factored_compliance import Factors, factored_solver
from .formed_rows import FormedRows
from .joined_solver import joined_solver
from .joined_table import (
    BETWEEN,
    COLUMNS,
    COUNT,
    COUNT_OF_COLUMNS,
    COUPLINGS,
    FACTORS,
    FIRST,
    FIRST_COLUMN,
    FORMED,
    KINDS,
    KINDS_OF_COLUMNS,
    LOADED,
    MATRIX,
    MOTIONS,
    MOTIONS_OF_LOADED,
    MOVED,
    MOVED_OF_LOADED,
    MOVES,
    NUMBERS,
    OWN,
    OWN_KINDS,
    PART,
    PARTS,
    RESPONDING,
    ROWS,
    SIDE,
    SIDE_OF_LOADED,
    TABLE,
    UNITS,
    UNITS_OF_COLUMNS,
    between_motions,
    joined_displacer,
)


class AllRows(NamedTuple):
    """A compliance all of whose rows are there."""

    matrix: np.ndarray
    address: int = 0
    arrays: tuple[np.ndarray, ...] = ()
    factors: None = None

    @property
    def table(self) -> np.ndarray:
        return self.matrix


class Joined(NamedTuple):
    """Rows of a mesh among those of all: its first node and how many it has, among rows and among columns; and
    `kinds`, how many forces of a node have rows, fewer of a mesh without friction."""

    rows: FormedRows | AllRows
    nodes: tuple[int, int]
    columns: tuple[int, int]
    kinds: int


class Coupling(NamedTuple):
    """How contact nodes of one mesh, by its number, are displaced by forces on those of another one, through a gear of
    both: how motions of its body move the nodes of either, (d, n, r) along directions, and `between` (r, r'), mm/N,
    motions of the one by those that forces on the other do work on."""

    responding: int
    loaded: int
    moved: np.ndarray
    moved_of_loaded: np.ndarray
    between: np.ndarray


def joined_rows(
    parts: Sequence[Joined],
    couplings: Sequence[Coupling],
    shape: tuple[int, int],
    kinds: tuple[int, int],
    units: tuple[np.ndarray, np.ndarray] | None = None,
    by_columns: bool = False,
) -> FormedRows:
    """Rows of all meshes, of so many nodes in rows and columns and forces of each; `units`: by what rows and columns
    are multiplied; `by_columns`: rows here are the compliance's columns."""
    nodes, columns = shape
    matrix = pages(kinds[0] * nodes, kinds[1] * columns)
    formed = np.zeros(nodes, dtype=bool)
    by_mesh = kinds == (1, 1) and all(part.rows.factors is not None for part in parts)
    sides, numbers = _sides(couplings) if by_mesh else ([], {})
    table = np.zeros((1 + len(parts) + len(couplings) + len(sides), NUMBERS), dtype=np.int64)
    sizes = len(parts), len(couplings), len(sides), nodes, columns, *kinds
    held = [matrix, formed, *(units or ())]
    table[0, PARTS:MATRIX] = sizes
    table[0, MATRIX : MATRIX + len(held)] = [array.ctypes.data for array in held]
    table[0, 0] = joined_row_former().address
    factors = None
    if by_mesh:
        table[0, 1:4] = joined_solver().address, table.ctypes.data, joined_displacer().address
    elif not by_columns and any(part.rows.address for part in parts):
        factors = Factors(nodes, kinds[0] * nodes)
        table[0, 1:3] = factored_solver().address, factors.table.ctypes.data
    for row, part in zip(table[1:], parts):
        row[:6] = part.rows.address, part.rows.matrix.ctypes.data, *part.nodes, *part.columns
        row[OWN_KINDS] = part.kinds
        held += [*part.rows.arrays, part.rows.table]
    for row, each in zip(table[1 + len(parts) :], couplings):
        row[:2] = each[:2]
        row[MOVED : BETWEEN + 1] = [array.ctypes.data for array in each[2:]]
        row[MOTIONS : MOTIONS_OF_LOADED + 1] = each.between.shape
        if by_mesh:
            row[SIDE : SIDE_OF_LOADED + 1] = numbers[id(each.moved)], numbers[id(each.moved_of_loaded)]
            place = 1 + len(parts) + len(couplings) + row[SIDE]
            table[place] = row
            table[place, :2] = each.responding, sides[row[SIDE]]
        held += each[2:]
    if by_mesh:
        held += _room_for_factors(table, len(parts))
    # Nodes of a mesh are in several couplings.
    arrays = list({id(each): each for each in held}.values())
    return FormedRows(matrix, formed, by_columns, table, arrays, factors)


def _room_for_factors(table: np.ndarray, parts: int) -> list[np.ndarray]:
    """Room of each part for what lasts until its sets change: meshes that share rows may be solved at the same time."""
    held = []
    sides = table[1 + parts + table[0, COUPLINGS] :]
    for number, row in enumerate(table[1 : 1 + parts]):
        nodes, source = int(row[COUNT]), int(row[TABLE])
        factors = Factors(nodes, 0, source if displacer_of(source) else 0)
        motions = int(sides[sides[:, PART] == number, MOTIONS].sum())
        lasting = pages(2 * motions, int(row[COUNT]))
        row[FACTORS : MOVES + 1] = factors.table.ctypes.data, lasting.ctypes.data, motions
        held += [*factors.arrays, factors.table, lasting]
    return held


def _sides(couplings: Sequence[Coupling]) -> tuple[list[int], dict[int, int]]:
    """The gear of each side of a mesh that couplings have, those of few sides first; and the number of a side by the
    identity of its nodes."""
    gears: list[list[int]] = []
    for each in couplings:
        both = [id(each.moved), id(each.moved_of_loaded)]
        own = next((gear for gear in gears if not set(gear).isdisjoint(both)), None)
        if own is None:
            gears.append(own := [])
        own += [side for side in both if side not in own]
    gears.sort(key=len)
    numbers = {side: number for number, side in enumerate(side for gear in gears for side in gear)}
    return [number for number, gear in enumerate(gears) for _ in gear], numbers


@cache
def joined_row_former():
    """The C function behind `addresses.form_rows`, compiled or loaded where there is a row over the face."""
    return cfunc("int64(int64, int64, int64)", cache=True)(_form_joined_rows)


def _form_joined_rows(address, nodes, count):
    """Returns 1, as of `formed_rows.row_former`."""
    head = carray(to_integer(address), NUMBERS)
    table = carray(to_integer(address), (1 + head[PARTS] + head[COUPLINGS], NUMBERS))
    formed = carray(to_flag(head[FORMED]), head[ROWS])
    asked = carray(to_integer(nodes), count)
    missing = asked[~formed[asked]]
    for number in range(head[PARTS]):
        part = table[1 + number]
        own = missing[(missing >= part[FIRST]) & (missing < part[FIRST] + part[COUNT])]
        if len(own):
            form_rows(part[TABLE], own - part[FIRST])
            _copy(head, part, own)
            for coupling in table[1 + head[PARTS] : 1 + head[PARTS] + head[COUPLINGS]]:
                if coupling[RESPONDING] == number:
                    _put_coupled(head, part, table[1 + coupling[LOADED]], coupling, own)
            if head[UNITS] != 0:
                _put_units(head, own)
                _put_alone(head, part, own)
            formed[own] = True
    return 1


@njit(cache=True)
def _copy(head, part, nodes):
    """Copy rows of a mesh into those of all."""
    matrix, kinds = _matrix(head), part[OWN_KINDS]
    others = min(kinds, head[KINDS_OF_COLUMNS])
    m, first = part[COUNT_OF_COLUMNS], part[FIRST_COLUMN]
    source = carray(to_number(part[OWN]), (kinds * part[COUNT], others * m))
    for d, e in np.ndindex((kinds, others)):
        for node in nodes:
            own = source[d * part[COUNT] + node - part[FIRST], e * m : (e + 1) * m]
            matrix[d * head[ROWS] + node, e * head[COLUMNS] + first : e * head[COLUMNS] + first + m] = own


@njit(cache=True)
def _put_coupled(head, part, other, coupling, nodes):
    """Put what forces of another mesh displace into rows of this one."""
    matrix, kinds, others = _matrix(head), head[KINDS], head[KINDS_OF_COLUMNS]
    n, m, first = part[COUNT], other[COUNT_OF_COLUMNS], other[FIRST_COLUMN]
    moved = carray(to_number(coupling[MOVED]), (kinds, n, coupling[MOTIONS]))
    moved_of_loaded = carray(to_number(coupling[MOVED_OF_LOADED]), (others, m, coupling[MOTIONS_OF_LOADED]))
    between = between_motions(coupling)
    for d in range(kinds):
        by_motions = np.dot(moved[d][nodes - part[FIRST]], between)
        for e in range(others):
            column, displaced = e * head[COLUMNS] + first, np.dot(by_motions, moved_of_loaded[e].T)
            for number in range(len(nodes)):
                matrix[d * head[ROWS] + nodes[number], column : column + m] = displaced[number]


@njit(cache=True)
def _put_units(head, nodes):
    """Multiply rows by their units, and by those of all columns."""
    matrix = _matrix(head)
    of_rows = carray(to_number(head[UNITS]), len(matrix))
    of_columns = carray(to_number(head[UNITS_OF_COLUMNS]), matrix.shape[1])
    for d in range(head[KINDS]):
        for node in nodes:
            row = d * head[ROWS] + node
            matrix[row] *= of_rows[row] * of_columns


@njit(cache=True)
def _put_alone(head, part, nodes):
    """Have the tangential displacement of nodes without friction follow from their own force alone."""
    if part[OWN_KINDS] < head[KINDS] == head[KINDS_OF_COLUMNS]:
        matrix = _matrix(head)
        for node in nodes:
            matrix[head[ROWS] + node, head[COLUMNS] + node] = matrix[0, 0]


@njit(cache=True)
def _matrix(head):
    return carray(to_number(head[MATRIX]), (head[KINDS] * head[ROWS], head[KINDS_OF_COLUMNS] * head[COLUMNS]))
