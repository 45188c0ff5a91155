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
from .face_ends import add_ends
from .fine_sections import (
    BEGIN,
    IN_SLICE,
    NODE,
    OF_SLICE,
    PLACE,
    PLANE_NODE,
    SECTION,
    SLICE,
    TOOTH,
    WIDTH,
    Fine,
    SectionNodes,
    add_fine,
    add_section,
    add_seen,
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


# In compiled code it is a table: first the addresses that `addresses.form_rows`, `addresses.solver_of` and
# `addresses.displacer_of` read, 0 where there is none; then address and shape of each array, the last being the
# flags that say which rows are formed.
ARRAYS = 35


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
    ) -> FormedRows:
        """`bodies`: of pinion and wheel `blocks` (k, s, s, n, n, 9), mm/N, between flank nodes in sections, by
        components, those of tooth i under forces on tooth j being number (k - 1)/2 + i - j, and `sections`
        (k, n', n', 4), mm per N/mm. `by_columns`: rows here are the compliance's columns."""
        blocks, sections = zip(*bodies)
        n, m = (side.axes.shape[2] * len(side.group) for side in (rows, columns))
        matrix, formed = pages(n, m), np.zeros(len(rows.group), dtype=bool)
        arrays = [np.ascontiguousarray(array) for array in (*rows, *columns, *fine, *blocks, *sections)]
        arrays += [matrix, formed]
        table = np.zeros((1 + ARRAYS, 7), dtype=np.int64)
        for row, array in zip(table[1:], arrays):
            row[0], row[1 : 1 + array.ndim] = array.ctypes.data, array.shape
        table[0, 0] = row_former().address
        factors = None
        if rows is columns:
            from .factored_compliance import Factors, factored_solver

            factors = Factors(len(rows.group), n)
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
def _arrays(address):
    return carray(to_integer(address), (1 + ARRAYS, 7))[1:]


@cache
def row_former():
    """The C function behind `addresses.form_rows`, compiled or loaded where there is a face: a plane run does
    without."""
    return cfunc("int64(int64, int64, int64)", cache=True)(_form_rows)


def _form_rows(address, nodes, count):
    """Returns 1; what is raised in a C function is printed and makes it return 0."""
    table = _arrays(address)
    formed = carray(to_flag(table[-1, 0]), table[-1, 1])
    asked = carray(to_integer(nodes), count)
    missing = asked[~formed[asked]]
    # Two threads may form a row: both store the same, and each tells that it is there afterwards.
    in_order()
    source, begin = _source(table), 0
    if not len(source.columns.group):
        return 1
    while begin < len(missing):
        group, end = source.rows.group[missing[begin]], begin + 1
        while end < len(missing) and source.rows.group[missing[end]] == group:
            end += 1
        _form(source, group, missing[begin:end])
        in_order()
        formed[missing[begin:end]] = True
        begin = end
    return 1


@njit(cache=True)
def _side(table):
    return SectionNodes(
        integer_vector(table[0]), number_vector(table[1]), integer_matrix(table[2]), integer_matrix(table[3]),
        carray(to_integer(table[4, 0]), (2, 6, table[4, 3])), number_array_3(table[5]),
        carray(to_number(table[6, 0]), (2, table[6, 2], table[6, 3], 5)), integer_vector(table[7]),
        integer_matrix(table[8]), number_vector(table[9]), integer_matrix(table[10]), integer_matrix(table[11]),
    )  # fmt: skip


@njit(cache=True)
def _source(table):
    fine = Fine(
        number_array_6(table[24]), number_array_6(table[25]), number_vector(table[26]), number_vector(table[27]),
        number_array_4(table[28]),
    )  # fmt: skip
    blocks, sections = (
        (number_array_6(table[29]), number_array_6(table[30])),
        (number_array_4(table[31]), number_array_4(table[32])),
    )
    matrix = carray(to_number(table[33, 0]), (table[33, 1], table[33, 2]))
    return _Source(_side(table), _side(table[12:]), fine, blocks, sections, matrix)


@njit(cache=True)
def uncertain_slices(address, softest, least):
    """Slices (S,) of the rows of a FormedRows in which nodes may depend on each other: those that have a group which is
    not `surely_independent`."""
    source = _source(_arrays(address))
    found = np.zeros(len(source.fine.shares), dtype=np.bool_)
    for group in range(source.rows.groups.shape[1]):
        number = source.rows.groups[SLICE, group]
        if not found[number]:
            found[number] = not surely_independent(source.rows, group, softest, least)
    return found


@njit(cache=True)
def fine_section(address, number):
    """What fine sections give in a slice between the contact nodes (d, n, d, n) of a FormedRows, mm/N."""
    source = _source(_arrays(address))
    rows, kinds = source.rows, source.rows.axes.shape[2]
    groups = np.flatnonzero(rows.groups[SLICE] == number)
    n = rows.groups[OF_SLICE, groups[0]] if len(groups) else 0
    section = np.empty((kinds, n, kinds, n))
    for p in groups:
        begin, place = rows.groups[BEGIN, p], rows.groups[IN_SLICE, p]
        count = end_of(rows, p) - begin
        found = np.zeros((kinds, len(rows.group), padded(kinds * count)))
        add_fine(found, rows, source.columns, source.fine, p, begin + np.arange(count))
        for q in groups:
            first, other = rows.groups[BEGIN, q], rows.groups[IN_SLICE, q]
            for d, e, node in np.ndindex((kinds, kinds, count)):
                for j in range(end_of(rows, q) - first):
                    section[d, place + node, e, other + j] = found[e, first + j, d * count + node]
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
    add_fine(found, rows, columns, source.fine, group, nodes)
    add_ends(found, rows, source.fine, group, nodes)
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
    rows, columns, sections = source.rows, source.columns, source.sections[gear]
    own, other, offsets = rows.on_gears[gear, :, group], columns.on_gears[gear], (len(sections) - 1) // 2
    axes, number = rows.axes[gear, group], rows.groups[SLICE, group]
    weights, low = spread(rows.near[gear][nodes], rows.first[gear][nodes] - own[PLACE], own[WIDTH])
    # Beyond the last flank node: narrow interpolations are as wide as the others, with weights of zero.
    room = other[PLACE, -1] + other[WIDTH, -1] + columns.near.shape[2]
    lines = np.zeros((len(weights), len(axes), columns.axes.shape[2], room))
    _put_body(lines, source.blocks[gear], own, other, low, (axes, columns.axes[gear]))
    for q in np.flatnonzero(columns.groups[SLICE] == number):
        ahead, ends = offsets + own[TOOTH] - other[TOOTH, q], (other[PLACE, q], other[PLACE, q] + other[WIDTH, q])
        firsts, share = (own[PLANE_NODE] + low, other[PLANE_NODE, q]), source.fine.shares[number]
        add_section(lines, ends, sections[ahead], firsts, -share * axes, columns.axes[gear, q])
    return weighted(lines, weights)


@njit(cache=True)
def _put_body(lines, blocks, own, other, low, directions):
    """Compliance of a body between flank nodes i of a group, the first of them `low`, and those under all groups: by
    `directions`, of the group (d, 5) and of all groups (Q, e, 5), into `lines` (i, d, e, j)."""
    (axes, across), (teeth, sections, _, nodes, _, size) = directions, blocks.shape
    numbers, found, products = blocks.reshape(-1), lines.reshape(-1), np.empty((len(across), size))
    for d, e in np.ndindex((len(axes), across.shape[1])):
        for q, a, b in np.ndindex((len(across), 3, 3)):
            products[q, 3 * a + b] = axes[d, a] * across[q, e, b]
        for i in range(len(lines)):
            line = ((i * len(axes) + d) * across.shape[1] + e) * lines.shape[3]
            for q in range(len(across)):
                tile = (teeth // 2 + own[TOOTH] - other[TOOTH, q]) * sections + own[SECTION]
                row = (tile * sections + other[SECTION, q]) * nodes + own[NODE] + low + i
                at = (row * nodes + other[NODE, q]) * size
                _put_products(found, line + other[PLACE, q], other[WIDTH, q], products[q], numbers, at)


@njit(cache=True)
def _put_products(found, place, count, weights, numbers, at):
    """Put products of nine weights with so many times nine numbers into place."""
    # uint64 avoids numba's wraparound check; three sums do not wait for each other.
    a, b, c, d, e, f, g, h, k = (weights[0], weights[1], weights[2], weights[3], weights[4], weights[5], weights[6],
                                 weights[7], weights[8])  # fmt: skip
    at, one, two, three, four = np.uint64(at), np.uint64(1), np.uint64(2), np.uint64(3), np.uint64(4)
    five, six, seven, eight, nine = np.uint64(5), np.uint64(6), np.uint64(7), np.uint64(8), np.uint64(9)
    for j in range(np.uint64(place), np.uint64(place) + np.uint64(count)):
        x = a * numbers[at] + b * numbers[at + one] + c * numbers[at + two]
        y = d * numbers[at + three] + e * numbers[at + four] + f * numbers[at + five]
        found[j] = x + y + (g * numbers[at + six] + h * numbers[at + seven] + k * numbers[at + eight])
        at += nine
