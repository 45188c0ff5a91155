"""The compliance between the contact nodes of meshes that move together: rows of single meshes side by side, and
between two meshes of an idler over the face a product of few motions. Rows are formed when their node is first closed,
as those of a mesh over the face by itself (`contact.formed_rows`).
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import NamedTuple

import numpy as np
from numba import carray, cfunc, njit

from fenics_gears.system.memory import pages

from .addresses import form_rows, to_flag, to_integer, to_number
from .formed_rows import FormedRows

# In the table of all rows after what `addresses` names: how many parts and couplings there are, nodes of all rows and
# columns, forces of a node in either, addresses of the matrix and of the flags that say which rows are formed.
PARTS, COUPLINGS, ROWS, COLUMNS, KINDS, KINDS_OF_COLUMNS, MATRIX, FORMED = range(3, 11)
NUMBERS = 11
# Of a part: address of its table, of its matrix, its first node among rows and columns, and how many it has.
TABLE, OWN, FIRST, COUNT, FIRST_COLUMN, COUNT_OF_COLUMNS = range(6)
# Of a coupling: the part that responds and the one that is loaded; addresses of what moves the nodes of one, of the
# tooth of each, and of what the other's forces move; number of motions and of teeth.
RESPONDING, LOADED, MOVED, TEETH, BY_FORCES, MOTIONS, COUNT_OF_TEETH = range(7)


class AllRows(NamedTuple):
    """A compliance all of whose rows are there."""

    matrix: np.ndarray
    address: int = 0
    arrays: tuple[np.ndarray, ...] = ()

    @property
    def table(self) -> np.ndarray:
        return self.matrix


class Joined(NamedTuple):
    """Rows of a mesh among those of all: its first node among rows and among columns."""

    rows: FormedRows | AllRows
    first: int
    first_column: int


class Coupling(NamedTuple):
    """How contact nodes (n,) of one mesh, by its number, are displaced by forces on those (m,) of another: `moved`
    (d, n, r), along directions, by motions of the body; `tooth` (n,), a number of the tooth on which each is; and
    `by_forces` (teeth, e, m, r), the motions there under forces, mm/N."""

    responding: int
    loaded: int
    moved: np.ndarray
    tooth: np.ndarray
    by_forces: np.ndarray


def joined_rows(
    parts: Sequence[Joined],
    couplings: Sequence[Coupling],
    shape: tuple[int, int],
    kinds: tuple[int, int],
    by_columns: bool = False,
) -> FormedRows:
    """Rows of all meshes, of so many nodes in rows and columns and forces of each; `by_columns`: rows here are the
    compliance's columns."""
    nodes, columns = shape
    matrix = pages(kinds[0] * nodes, kinds[1] * columns)
    formed = np.zeros(nodes, dtype=bool)
    table = np.zeros((1 + len(parts) + len(couplings), NUMBERS), dtype=np.int64)
    factors = None
    if not by_columns and any(part.rows.address for part in parts):
        from .factored_compliance import Factors, factored_solver

        factors = Factors(nodes, kinds[0] * nodes)
        table[0, 1:3] = factored_solver().address, factors.table.ctypes.data
    table[0, 0] = joined_row_former().address
    table[0, PARTS:] = len(parts), len(couplings), nodes, columns, *kinds, matrix.ctypes.data, formed.ctypes.data
    arrays = [matrix, formed]
    for row, part in zip(table[1:], parts):
        counts = [length // kind for length, kind in zip(part.rows.matrix.shape, kinds)]
        own = part.rows.address, part.rows.matrix.ctypes.data
        row[:6] = *own, part.first, counts[0], part.first_column, counts[1]
        arrays += [*part.rows.arrays, part.rows.table]
    for row, each in zip(table[1 + len(parts) :], couplings):
        of_nodes = [np.ascontiguousarray(array) for array in each[2:]]
        row[:2] = each[:2]
        row[MOVED : BY_FORCES + 1] = [array.ctypes.data for array in of_nodes]
        row[MOTIONS : COUNT_OF_TEETH + 1] = each.moved.shape[2], len(each.by_forces)
        arrays += of_nodes
    return FormedRows(matrix, formed, by_columns, table, arrays, factors)


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
            for coupling in table[1 + head[PARTS] :]:
                if coupling[RESPONDING] == number:
                    _put_coupled(head, part, table[1 + coupling[LOADED]], coupling, own)
            formed[own] = True
    return 1


@njit(cache=True)
def _copy(head, part, nodes):
    """Copy rows of a mesh into those of all."""
    matrix, kinds, others = _matrix(head), head[KINDS], head[KINDS_OF_COLUMNS]
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
    n, m, r, first = part[COUNT], other[COUNT_OF_COLUMNS], coupling[MOTIONS], other[FIRST_COLUMN]
    moved = carray(to_number(coupling[MOVED]), (kinds, n, r))
    tooth = carray(to_integer(coupling[TEETH]), n)
    by_forces = carray(to_number(coupling[BY_FORCES]), (coupling[COUNT_OF_TEETH], others, m, r))
    for d, e in np.ndindex((kinds, others)):
        for node in nodes:
            own = node - part[FIRST]
            found = np.dot(by_forces[tooth[own], e], moved[d, own])
            matrix[d * head[ROWS] + node, e * head[COLUMNS] + first : e * head[COLUMNS] + first + m] = found


@njit(cache=True)
def _matrix(head):
    return carray(to_number(head[MATRIX]), (head[KINDS] * head[ROWS], head[KINDS_OF_COLUMNS] * head[COLUMNS]))
