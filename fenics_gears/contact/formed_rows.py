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

from fenics_gears.contact.addresses import call, to_flag, to_integer, to_number
from fenics_gears.system.memory import pages

if TYPE_CHECKING:
    from fenics_gears.contact.factored_compliance import Factors

# Of a group: its first node, its slice, the place of that node among those in the slice, and how many these are.
BEGIN, SLICE, IN_SLICE, OF_SLICE = range(4)
# Of a group on a gear: its tooth, how many flank nodes lie under it, their place among those under all groups; the
# body's section, by flank and slice, and the first degree of freedom in it; and that in the plane section.
TOOTH, WIDTH, PLACE, SECTION, DOF, PLANE_DOF = range(6)


class Side(NamedTuple):
    """Contact nodes (n,) as rows or columns, in groups (P,).

    `group` (n,) of each node; `first` (2, n): the first flank node of either gear that a node sees, among those under
    all groups, and `near` (2, n, w): weights from that one on. `groups` (4, P) and `on_gears` (2, 6, P): numbers
    of each group, as above. `axes` (2, P, d, 5): directions of contact in the tooth's frame, in the body (3) and in the
    section (2).
    """

    group: np.ndarray
    first: np.ndarray
    groups: np.ndarray
    on_gears: np.ndarray
    near: np.ndarray
    axes: np.ndarray


class Fine(NamedTuple):
    """Compliance of fine sections, mm per N/mm, between the contact nodes (d, n, e, m) in a slice: `numbers` of all
    slices, each from `begins` (S,) on; `shares` (S,), 1/mm: what a section counts in its slice."""

    numbers: np.ndarray
    begins: np.ndarray
    shares: np.ndarray


class _Source(NamedTuple):
    """What the rows of a `matrix` are formed of."""

    rows: Side
    columns: Side
    fine: Fine
    blocks: tuple[np.ndarray, np.ndarray]
    sections: tuple[np.ndarray, np.ndarray]
    matrix: np.ndarray


# In compiled code it is a table of its arrays, and of the flags that say which rows are formed: address and shape of
# each; then the addresses of the function that forms rows, of the one that solves the mixed form with Factors, and of
# these; the last two are 0 between other nodes than those of one position.
ARRAYS = 21


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
        rows: Side,
        columns: Side,
        fine: Fine,
        by_columns: bool = False,
    ) -> FormedRows:
        """`bodies`: of pinion and wheel `blocks` (k, s, s, D, D), mm/N, between sections, those of tooth i under forces
        on tooth j being number (k - 1)/2 + i - j, and `sections` (k, D', D'), mm per N/mm. `by_columns`: rows here are
        the compliance's columns."""
        blocks, sections = zip(*bodies)
        n, m = (side.axes.shape[2] * len(side.group) for side in (rows, columns))
        matrix, formed = pages(n, m), np.zeros(len(rows.group), dtype=bool)
        arrays = [np.ascontiguousarray(array) for array in (*rows, *columns, *fine, *blocks, *sections)]
        arrays += [matrix, formed]
        table = np.zeros((ARRAYS + 1, 6), dtype=np.int64)
        for row, array in zip(table, arrays):
            row[0], row[1 : 1 + array.ndim] = array.ctypes.data, array.shape
        table[ARRAYS, 0] = row_former().address
        factors = None
        if rows is columns:
            from fenics_gears.contact.factored_compliance import Factors, factored_solver

            factors = Factors(n)
            table[ARRAYS, 1:3] = factored_solver().address, factors.table.ctypes.data
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
def form_rows(address, nodes):
    """Form those rows of contact nodes, in increasing order, that are not yet formed; `address` of a FormedRows, 0
    where all rows are there."""
    if address == 0:
        return
    function = carray(to_integer(address), (ARRAYS + 1, 6))[ARRAYS, 0]
    if not call(function, (address, nodes.ctypes.data, len(nodes))):
        raise MemoryError("no room for rows of the compliance between contact nodes")


@njit(cache=True)
def solver_of(address):
    """Addresses of what solves the mixed form with Factors, and of these, of a FormedRows; 0 where there is none."""
    if address == 0:
        return 0, 0
    table = carray(to_integer(address), (ARRAYS + 1, 6))
    return table[ARRAYS, 1], table[ARRAYS, 2]


@cache
def row_former():
    """The C function behind `form_rows`, compiled or loaded where there are rows to form: a plane run does without."""
    return cfunc("int64(int64, int64, int64)", cache=True)(_form_rows)


def _form_rows(address, nodes, count):
    """Returns 1; what is raised in a C function is printed and makes it return 0."""
    table = carray(to_integer(address), (ARRAYS, 6))
    formed = carray(to_flag(table[-1, 0]), table[-1, 1])
    asked = carray(to_integer(nodes), count)
    missing = asked[~formed[asked]]
    source = _source(table)
    rows, columns = source.rows, source.columns
    if not len(missing) or not len(columns.group):
        return 1
    widest, under = rows.on_gears[:, WIDTH].max(), 0
    for gear in range(2):
        last = columns.on_gears[gear, :, -1]
        under = max(under, last[PLACE] + last[WIDTH])
    # Beyond the last flank node: narrow interpolations are as wide as the others, with weights of zero.
    room = under + columns.near.shape[2]
    between = np.zeros((2, rows.axes.shape[2], widest + rows.near.shape[2], columns.axes.shape[2], room))
    group = -1
    for node in missing:
        if rows.group[node] != group:
            group = rows.group[node]
            for gear in range(2):
                _between(source, gear, group, between[gear])
        _form(source, node, between)
        formed[node] = True
    return 1


@njit(cache=True)
def _side(table):
    return Side(
        carray(to_integer(table[0, 0]), table[0, 1]),
        carray(to_integer(table[1, 0]), (2, table[1, 2])),
        carray(to_integer(table[2, 0]), (4, table[2, 2])),
        carray(to_integer(table[3, 0]), (2, 6, table[3, 3])),
        _cube(table[4]),
        carray(to_number(table[5, 0]), (2, table[5, 2], table[5, 3], 5)),
    )


@njit(cache=True)
def _cube(row):
    return carray(to_number(row[0]), (row[1], row[2], row[3]))


@njit(cache=True)
def _tiles(row):
    return carray(to_number(row[0]), (row[1], row[2], row[3], row[4], row[5]))


@njit(cache=True)
def _source(table):
    fine = Fine(
        carray(to_number(table[12, 0]), table[12, 1]),
        carray(to_integer(table[13, 0]), table[13, 1]),
        carray(to_number(table[14, 0]), table[14, 1]),
    )
    blocks, sections = (_tiles(table[15]), _tiles(table[16])), (_cube(table[17]), _cube(table[18]))
    matrix = carray(to_number(table[19, 0]), (table[19, 1], table[19, 2]))
    return _Source(_side(table), _side(table[6:]), fine, blocks, sections, matrix)


@njit(cache=True)
def _between(source, gear, group, result):
    """Compliance (d, i, e, j), mm/N, of one gear between the flank nodes i under a group and j under all groups, less
    that of its plane section in the same slice."""
    rows, columns, blocks, sections = source.rows, source.columns, source.blocks[gear], source.sections[gear]
    own, other, offsets = rows.on_gears[gear, :, group], columns.on_gears[gear], (len(blocks) - 1) // 2
    axes, width = rows.axes[gear, group], own[WIDTH]
    for q in range(other.shape[1]):
        number, place = offsets + own[TOOTH] - other[TOOTH, q], other[PLACE, q]
        found, across = result[:, :, :, place : place + other[WIDTH, q]], columns.axes[gear, q]
        _add_block(
            found, blocks[number, own[SECTION], other[SECTION, q]], (own[DOF], other[DOF, q]), axes, across, width
        )
        if rows.groups[SLICE, group] == columns.groups[SLICE, q]:
            share = source.fine.shares[rows.groups[SLICE, group]]
            firsts = own[PLANE_DOF], other[PLANE_DOF, q]
            _add_section(found, sections[number], firsts, axes, -share * across, width)


@njit(cache=True)
def _add_block(found, block, firsts, axes, across, width):
    """Compliance (d, i, e, j) between flank nodes of a body, `width` of them responding, by directions `axes` (d, 5)
    and `across` (e, 5); from the `firsts` rows and columns of a block on, three for each node."""
    # Unsigned places need no look for a negative index.
    row, zero, one, two, three = (np.uint64(firsts[0]), np.uint64(0), np.uint64(1), np.uint64(2), np.uint64(3))
    for i in range(np.uint64(width)):
        for d in range(np.uint64(len(axes))):
            column = np.uint64(firsts[1])
            for j in range(np.uint64(found.shape[3])):
                x, y, z = 0.0, 0.0, 0.0
                for a in range(three):
                    axis = axes[d, a]
                    x += axis * block[row + a, column]
                    y += axis * block[row + a, column + one]
                    z += axis * block[row + a, column + two]
                for e in range(np.uint64(len(across))):
                    found[d, i, e, j] = x * across[e, zero] + y * across[e, one] + z * across[e, two]
                column += three
        row += three


@njit(cache=True)
def _add_section(found, section, firsts, axes, across, width):
    """Add the same of plane sections, two rows and columns for each node, by the last two components of directions."""
    for i, d, j in np.ndindex((width, len(axes), found.shape[3])):
        row, column = firsts[0] + 2 * i, firsts[1] + 2 * j
        x = axes[d, 3] * section[row, column] + axes[d, 4] * section[row + 1, column]
        y = axes[d, 3] * section[row, column + 1] + axes[d, 4] * section[row + 1, column + 1]
        for e in range(len(across)):
            found[d, i, e, j] += x * across[e, 3] + y * across[e, 4]


@njit(cache=True)
def _form(source, node, between):
    """Form the rows of a contact node from the compliance `between` (2, d, i, e, j) its group's flank nodes and all."""
    rows, columns, fine, matrix = source.rows, source.columns, source.fine, source.matrix
    n, m, group, kinds = len(rows.group), len(columns.group), rows.group[node], columns.axes.shape[2]
    along, number = np.empty((2, between.shape[4])), rows.groups[SLICE, group]
    in_slice = rows.groups[IN_SLICE, group] + node - rows.groups[BEGIN, group]
    for d, e in np.ndindex((rows.axes.shape[2], kinds)):
        for gear in range(2):
            first = rows.first[gear, node] - rows.on_gears[gear, PLACE, group]
            _weighted(along[gear], rows.near[gear, node], between[gear, d, first:, e])
        found = matrix[d * n + node, e * m : (e + 1) * m]
        _seen(found, columns.near, columns.first, along)
        for q in np.flatnonzero(columns.groups[SLICE] == number):
            count, begin = columns.groups[OF_SLICE, q], columns.groups[BEGIN, q]
            row = (d * rows.groups[OF_SLICE, group] + in_slice) * kinds + e
            place = fine.begins[number] + row * count + columns.groups[IN_SLICE, q]
            end = columns.groups[BEGIN, q + 1] if q + 1 < columns.groups.shape[1] else m
            for j in range(end - begin):
                found[begin + j] += fine.shares[number] * fine.numbers[place + j]


@njit(cache=True)
def _weighted(total, weights, values):
    """Sum of some rows of values (w, s), each by its weight, into `total` (s,)."""
    total[:] = 0.0
    for k in range(len(weights)):
        weight, row = weights[k], values[k]
        for j in range(len(total)):
            total[j] += weight * row[j]


@njit(cache=True)
def _seen(found, near, first, values):
    """What contact nodes (m,) see of `values` (2, s) of the flank nodes of both gears."""
    # Unsigned places need no look for a negative index.
    one, zero = np.uint64(1), np.uint64(0)
    for j in range(np.uint64(len(found))):
        at, other, total = np.uint64(first[zero, j]), np.uint64(first[one, j]), 0.0
        for k in range(np.uint64(near.shape[2])):
            total += near[zero, j, k] * values[zero, at + k] + near[one, j, k] * values[one, other + k]
        # Written without being read: a page that is read first comes from the system twice.
        found[j] = total
