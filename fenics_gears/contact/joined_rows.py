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

from .addresses import form_rows, to_flag, to_integer, to_number
from .formed_rows import FormedRows

# In the table of all rows after what `addresses` names: how many parts and couplings there are, nodes of all rows and
# columns, forces of a node in either, addresses of the matrix, of the flags that say which rows are formed, and of the
# units of rows and of columns, 0 where all are one.
PARTS, COUPLINGS, ROWS, COLUMNS, KINDS, KINDS_OF_COLUMNS, MATRIX, FORMED, UNITS, UNITS_OF_COLUMNS = range(3, 13)
NUMBERS = 13
# Of a part: address of its table, of its matrix, its first node among rows and columns, and how many it has.
TABLE, OWN, FIRST, COUNT, FIRST_COLUMN, COUNT_OF_COLUMNS = range(6)
# Of a coupling: the part that responds and the one that is loaded; of the nodes of either addresses of what moves them
# and of the tooth of each; address of what is between teeth; number of motions and of teeth of either.
RESPONDING, LOADED, MOVED, TOOTH, MOVED_OF_LOADED, TOOTH_OF_LOADED, BETWEEN, MOTIONS, MOTIONS_OF_LOADED = range(9)
TEETH, TEETH_OF_LOADED = range(9, 11)


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


class OnBody(NamedTuple):
    """Contact nodes (n,) of a mesh on a gear: how motions of its body move them (d, n, r), along directions; its
    `teeth` there, (T,), and the place among these of that on which each node is."""

    moved: np.ndarray
    teeth: np.ndarray
    tooth: np.ndarray


class Coupling(NamedTuple):
    """How contact nodes of one mesh, by its number, are displaced by forces on those of another one, through a gear of
    both; `between` (T, U, r, r'), mm/N: motions on teeth of the one by those that forces on teeth of the other do work
    on."""

    responding: int
    loaded: int
    nodes: OnBody
    nodes_of_loaded: OnBody
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
    table = np.zeros((1 + len(parts) + len(couplings), NUMBERS), dtype=np.int64)
    factors = None
    if not by_columns and any(part.rows.address for part in parts):
        from .factored_compliance import Factors, factored_solver

        factors = Factors(nodes, kinds[0] * nodes)
        table[0, 1:3] = factored_solver().address, factors.table.ctypes.data
    table[0, 0] = joined_row_former().address
    arrays = [matrix, formed, *(units or ())]
    table[0, PARTS:MATRIX] = len(parts), len(couplings), nodes, columns, *kinds
    table[0, MATRIX : MATRIX + len(arrays)] = [array.ctypes.data for array in arrays]
    for row, part in zip(table[1:], parts):
        counts = [length // kind for length, kind in zip(part.rows.matrix.shape, kinds)]
        own = part.rows.address, part.rows.matrix.ctypes.data
        row[:6] = *own, part.first, counts[0], part.first_column, counts[1]
        arrays += [*part.rows.arrays, part.rows.table]
    for row, each in zip(table[1 + len(parts) :], couplings):
        of_nodes = each.nodes.moved, each.nodes.tooth, each.nodes_of_loaded.moved, each.nodes_of_loaded.tooth
        of_both = [np.ascontiguousarray(array) for array in (*of_nodes, each.between)]
        row[:2] = each[:2]
        row[MOVED : BETWEEN + 1] = [array.ctypes.data for array in of_both]
        row[MOTIONS : TEETH_OF_LOADED + 1] = *each.between.shape[2:], *each.between.shape[:2]
        arrays += of_both
    # Nodes of a mesh are in several couplings.
    return FormedRows(matrix, formed, by_columns, table, list({id(each): each for each in arrays}.values()), factors)


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
            if head[UNITS] != 0:
                _put_units(head, own)
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
    n, m, first = part[COUNT], other[COUNT_OF_COLUMNS], other[FIRST_COLUMN]
    r, s, teeth = coupling[MOTIONS], coupling[MOTIONS_OF_LOADED], coupling[TEETH_OF_LOADED]
    moved = carray(to_number(coupling[MOVED]), (kinds, n, r))
    tooth = carray(to_integer(coupling[TOOTH]), n)
    moved_of_loaded = carray(to_number(coupling[MOVED_OF_LOADED]), (others, m, s))
    tooth_of_loaded = carray(to_integer(coupling[TOOTH_OF_LOADED]), m)
    between = carray(to_number(coupling[BETWEEN]), (coupling[TEETH], teeth, r, s))
    of_teeth = np.empty((teeth, s))
    for d in range(kinds):
        for node in nodes:
            own = node - part[FIRST]
            for there in range(teeth):
                of_teeth[there] = np.dot(moved[d, own], between[tooth[own], there])
            row = matrix[d * head[ROWS] + node]
            for e in range(others):
                _add_up(moved_of_loaded[e], tooth_of_loaded, of_teeth, row[e * head[COLUMNS] + first :])


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


@njit(cache=True, fastmath={"reassoc"})
def _add_up(moved, tooth, of_teeth, row):
    """Displacements by forces on nodes that motions move (m, s), from what these do by teeth (U, s)."""
    for node in range(len(moved)):
        total = 0.0
        for motion in range(moved.shape[1]):
            total += moved[node, motion] * of_teeth[tooth[node], motion]
        row[node] = total


@njit(cache=True)
def _matrix(head):
    return carray(to_number(head[MATRIX]), (head[KINDS] * head[ROWS], head[KINDS_OF_COLUMNS] * head[COLUMNS]))
