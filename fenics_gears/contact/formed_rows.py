"""The compliance between contact nodes in slices of the face, of both gears' bodies and of fine plane sections. Rows
are formed when their node is first closed: most nodes never are, and nothing needs their rows.

Contact nodes come in groups, one for each tooth pair in a slice. Under a group lie some consecutive flank nodes of the
pinion and some of the wheel, in that slice. With the weights W of a contact node's flank nodes the bodies' part is
`W M W^T`, M being in the directions of contact: a flank node has as many displacements as a contact node, not three.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numba import carray, cfunc, njit

from fenics_gears.system.memory import pages

from .addresses import (
    form_rows,
    in_order,
    integer_matrix,
    integer_vector,
    number_array_3,
    number_array_4,
    number_array_6,
    number_vector,
    to_flag,
    to_integer,
    to_number,
)
from .between_flank_nodes import Between, displaced_by
from .face_ends import add_ends
from .fine_sections import (
    BEGIN,
    IN_SLICE,
    OF_SLICE,
    PLACE,
    SLICE,
    WIDTH,
    Fine,
    SectionNodes,
    add_fine,
    add_seen,
    end_in_group,
    end_of,
    padded,
    spread,
    surely_independent,
    weighted,
)

if TYPE_CHECKING:
    from .factored_compliance import Factors


class _Source(NamedTuple):
    """What the rows of a `matrix` are formed of."""

    rows: SectionNodes
    columns: SectionNodes
    fine: Fine
    blocks: tuple[np.ndarray, np.ndarray]
    sections: tuple[np.ndarray, np.ndarray]
    matrix: np.ndarray


# In compiled code it is a table: first the addresses that `addresses.form_rows`, `addresses.solver_of` and those after
# it read, 0 where there is none; then address and shape of each array, the last being the
# flags that say which rows are formed.
ARRAYS = 39


@dataclass(frozen=True, eq=False)
class FormedRows:
    """Compliance (d n, e m), mm/N, between contact nodes over a face: of both bodies, less what their plane sections
    give in each slice, and of the fine sections there.

    `matrix`: zero where it is not yet `formed` (n,); by columns where asked for. `table` and `arrays`: what rows are
    formed of. `factors`: between the nodes of one position.
    """

    matrix: np.ndarray
    formed: np.ndarray
    by_columns: bool
    table: np.ndarray
    arrays: list[np.ndarray]
    factors: Factors | None = None

    @classmethod
    def of(
        cls,
        bodies: Sequence[tuple[np.ndarray, np.ndarray]],
        rows: SectionNodes,
        columns: SectionNodes,
        fine: Fine,
        by_columns: bool = False,
        between: Between | None = None,
    ) -> FormedRows:
        """`bodies`: of pinion and wheel `blocks` (k, s, s, n, n, 9), mm/N, between flank nodes in sections, by
        components, those of tooth i under forces on tooth j being number (k - 1)/2 + i - j, and `sections`
        (k, n', n', 4), mm per N/mm. `by_columns`: rows here are the compliance's columns. `between`: where
        all is solved by these (`contact.closed_compliance`)."""
        blocks, sections = zip(*bodies)
        n, m = (side.axes.shape[2] * len(side.group) for side in (rows, columns))
        matrix, formed = pages(n, m), np.zeros(len(rows.group), dtype=bool)
        arrays = [np.ascontiguousarray(array) for array in (*rows, *columns, *fine, *blocks, *sections)]
        in_slices = np.empty((0, 0)) if between is None else pages(n, int(rows.groups[OF_SLICE].max(initial=1)))
        arrays += [
            matrix,
            *(2 * [in_slices] if between is None else between.matrices),
            in_slices,
            np.zeros(len(in_slices), dtype=bool),
            formed,
        ]
        table = np.zeros((1 + ARRAYS, 7), dtype=np.int64)
        for row, array in zip(table[1:], arrays):
            row[0], row[1 : 1 + array.ndim] = array.ctypes.data, array.shape
        table[0, 0] = row_former().address
        factors = None
        if between is not None:
            table[0, 3:6] = between.functions
        if rows is columns:
            from .factored_compliance import Factors, factored_solver

            factors = Factors(len(rows.group), n, 0 if between is None else table.ctypes.data)
            table[0, 1:3] = factored_solver().address, factors.table.ctypes.data
        return cls(matrix, formed, by_columns, table, arrays, factors)

    @property
    def address(self) -> int:
        """For compiled code."""
        return self.table.ctypes.data

    def whole(self) -> np.ndarray:
        """The compliance with all its rows."""
        form_rows(self.address, np.arange(len(self.formed)))
        return self.matrix.T if self.by_columns else self.matrix


@njit(cache=True)
def arrays_at(address):
    return carray(to_integer(address), (1 + ARRAYS, 7))[1:]


@cache
def row_former():
    """The C function behind `addresses.form_rows`, compiled or loaded where there is a face: a plane run does
    without."""
    return cfunc("int64(int64, int64, int64)", cache=True)(_form_rows)


def _form_rows(address, nodes, count):
    """Returns 1; what is raised in a C function is printed and makes it return 0."""
    table = arrays_at(address)
    formed = carray(to_flag(table[-1, 0]), table[-1, 1])
    asked = carray(to_integer(nodes), count)
    missing = asked[~formed[asked]]
    # Two threads may form a row: both store the same, and each tells that it is there afterwards.
    in_order()
    source, begin = _source(table), 0
    if not len(source.columns.group):
        return 1
    while begin < len(missing):
        end = end_in_group(source.rows, missing, begin)
        _form(source, source.rows.group[missing[begin]], missing[begin:end])
        in_order()
        formed[missing[begin:end]] = True
        begin = end
    return 1


@njit(cache=True)
def side_of(table):
    return SectionNodes(
        integer_vector(table[0]), number_vector(table[1]), integer_matrix(table[2]), integer_matrix(table[3]),
        carray(to_integer(table[4, 0]), (2, 6, table[4, 3])), number_array_3(table[5]),
        carray(to_number(table[6, 0]), (2, table[6, 2], table[6, 3], 5)), integer_vector(table[7]),
        integer_matrix(table[8]), number_vector(table[9]), integer_matrix(table[10]), integer_matrix(table[11]),
    )  # fmt: skip


@njit(cache=True)
def fine_of(table):
    return Fine(
        number_array_6(table[24]), number_array_6(table[25]), number_vector(table[26]), number_vector(table[27]),
        number_array_4(table[28]),
    )  # fmt: skip


@njit(cache=True)
def _source(table):
    blocks, sections = (
        (number_array_6(table[29]), number_array_6(table[30])),
        (number_array_4(table[31]), number_array_4(table[32])),
    )
    matrix = carray(to_number(table[33, 0]), (table[33, 1], table[33, 2]))
    return _Source(side_of(table), side_of(table[12:]), fine_of(table), blocks, sections, matrix)


@njit(cache=True)
def uncertain_slices(address, softest, least):
    """Slices (S,) of the rows of a FormedRows in which nodes may depend on each other: those that have a group which is
    not `surely_independent`."""
    source = _source(arrays_at(address))
    found = np.zeros(len(source.fine.shares), dtype=np.bool_)
    for group in range(source.rows.groups.shape[1]):
        number = source.rows.groups[SLICE, group]
        if not found[number]:
            found[number] = not surely_independent(source.rows, group, softest, least)
    return found


@njit(cache=True)
def fine_section(address, number):
    """What fine sections give in a slice between the contact nodes (d, n, d, n) of a FormedRows, mm/N."""
    source = _source(arrays_at(address))
    rows, kinds = source.rows, source.rows.axes.shape[2]
    groups = np.flatnonzero(rows.groups[SLICE] == number)
    n = rows.groups[OF_SLICE, groups[0]] if len(groups) else 0
    section = np.empty((kinds, n, kinds, n))
    for p in groups:
        begin, place = rows.groups[BEGIN, p], rows.groups[IN_SLICE, p]
        count = end_of(rows, p) - begin
        found = np.zeros((kinds, n, padded(kinds * count)))
        add_fine(found, (rows, source.columns, source.fine), p, begin + np.arange(count), rows.groups[IN_SLICE])
        for d, e, node in np.ndindex((kinds, kinds, count)):
            for other in range(n):
                section[d, place + node, e, other] = found[e, other, d * count + node]
    return section


@njit(cache=True)
def _form(source, group, nodes):
    """Form the rows of some contact nodes of a group."""
    rows, columns, matrix, count = source.rows, source.columns, source.matrix, len(nodes)
    n, m, kinds, others = len(rows.group), len(columns.group), rows.axes.shape[2], columns.axes.shape[2]
    found = np.zeros((others, m, padded(kinds * count)))
    for gear in range(2):
        along = _displaced(source, gear, group, nodes)
        for e in range(others):
            add_seen(found[e], columns.near[gear], columns.first[gear], along[e])
    add_fine(found, (rows, columns, source.fine), group, nodes, columns.groups[BEGIN])
    add_ends(found, rows, source.fine, group, nodes, rows.groups[BEGIN, group])
    layer = source.fine.layers[rows.groups[SLICE, group]] * source.fine.shares[rows.groups[SLICE, group]]
    if layer != 0.0:
        for d in range(kinds):
            for number in range(count):
                found[d, nodes[number], d * count + number] += layer
    # Each value is stored at once, never added to: the system hands out a page twice where it is read before it is
    # written, and another thread may read it.
    for e, j in np.ndindex((others, m)):
        for d in range(kinds):
            for number in range(count):
                matrix[d * n + nodes[number], e * m + j] = found[e, j, d * count + number]


@njit(cache=True)
def _displaced(source, gear, group, nodes):
    """Displacement (e, r, j), mm/N, of a group's contact nodes on one gear by forces on the flank nodes j under all
    groups, less that of its plane section in the same slice; r as of `weighted`."""
    own, rows = source.rows.on_gears[gear, :, group], source.rows
    weights, low = spread(rows.near[gear][nodes], rows.first[gear][nodes] - own[PLACE], own[WIDTH])
    return weighted(displaced_by(source, gear, group, low, len(weights)), weights)
