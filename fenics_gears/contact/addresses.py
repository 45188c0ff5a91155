"""Where the arrays of contact operators lie in memory, so that one call of compiled code goes through many steps
without copying them.

Numbers of a row are addresses: whoever has one holds the arrays (`Position.in_memory`) as long as it is used.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import NamedTuple

import numpy as np
from llvmlite import ir
from numba import carray, from_dtype, njit, types
from numba.core import cgutils
from numba.extending import intrinsic

from .laws import OPEN, SLIP_FORWARD


class Arrays(NamedTuple):
    """Those of a contact operator (n nodes, m = n or with friction 2 n, k coordinates) in compiled code, named as
    there: `on_drive_flanks` (n,), `node_pair` (n,), `node_before` (n,) as of a Position.

    Jacobians have the columns (`columns`, c) of the coordinates that contact moves, the first of all.
    `rigid_slip` (n,), `previous_jacobian` (n, c) and `previous_columns` (m before, n), the previous compliance by
    columns, have no rows without friction; `sliding` (n,) has none unless the flanks are rigid as well. `rows` and
    `rows_before`: addresses of what forms rows of the compliance and of those columns (`contact.formed_rows`), 0 where
    all of them are there.
    """

    compliance: np.ndarray
    jacobian: np.ndarray
    gap: np.ndarray
    on_drive_flanks: np.ndarray
    node_pair: np.ndarray
    node_before: np.ndarray
    rigid_slip: np.ndarray
    previous_jacobian: np.ndarray
    previous_columns: np.ndarray
    sliding: np.ndarray
    rows: int = 0
    rows_before: int = 0
    columns: int = 0


# A row: how many contact nodes there are, and the address of each array, 0 where it is not there.
ROW = np.dtype([(name, np.int64) for name in ("nodes", *Arrays._fields)])
NODES, GAP = (ROW.names.index(name) for name in ("nodes", "gap"))
# In the table of Factors (`contact.factored_compliance`), addresses of room and of what is factored there (its number
# of forces, then their rows), without friction; with friction so much later; and of pivots. Then the number of the
# march that last solved with friction, and the address of `marching`.
ROOM, KNOWN, OF_FRICTION, PIVOTS, MARCH, PRESENT = 0, 1, 2, 4, 5, 6
# The number of the present march with inertia, 0 where there is none; and how many of them have begun.
marching = np.zeros(2, dtype=np.int64)
# Of the closed nodes: where more than this were open over a face when friction was last solved for at the position, or
# the other way round, the sets without friction are solved for. That takes two or three iterations of a third of the
# cost, and two or three with friction follow in place of five.
SHARE_CHANGED = 0.03


def _pointer_to(kind):
    @intrinsic
    def pointer(typing_context, address):
        def code(context, builder, signature, arguments):
            return builder.inttoptr(arguments[0], context.get_value_type(signature.return_type))

        return types.CPointer(kind)(types.int64), code

    return pointer


to_number, to_integer, to_flag = (_pointer_to(kind) for kind in (types.float64, types.int64, types.boolean))
to_set, to_row = _pointer_to(types.int8), _pointer_to(from_dtype(ROW))


# An array by a row of a table of arrays: its address, then its shape.
@njit(cache=True)
def integer_vector(row):
    return carray(to_integer(row[0]), row[1])


@njit(cache=True)
def integer_matrix(row):
    return carray(to_integer(row[0]), (row[1], row[2]))


@njit(cache=True)
def number_vector(row):
    return carray(to_number(row[0]), row[1])


@njit(cache=True)
def number_array_3(row):
    return carray(to_number(row[0]), (row[1], row[2], row[3]))


@njit(cache=True)
def number_array_4(row):
    return carray(to_number(row[0]), (row[1], row[2], row[3], row[4]))


@njit(cache=True)
def number_array_6(row):
    return carray(to_number(row[0]), (row[1], row[2], row[3], row[4], row[5], row[6]))


@intrinsic
def call(typing_context, function, numbers):
    """What the C function at an address returns of some numbers; all are int64. It is compiled once, where a compiled
    function called by its name is compiled anew into each of its callers."""

    def code(context, builder, signature, arguments):
        values = cgutils.unpack_tuple(builder, arguments[1])
        kind = ir.FunctionType(ir.IntType(64), [ir.IntType(64)] * len(values))
        return builder.call(builder.inttoptr(arguments[0], kind.as_pointer()), values)

    return types.int64(types.int64, numbers), code


@intrinsic
def not_inlined(typing_context):
    """Keeps the compiled function in whose body it stands apart from its callers: LLVM takes much longer for one large
    function than for its parts."""

    def code(context, builder, signature, arguments):
        builder.function.attributes.add("noinline")
        return context.get_dummy_value()

    return types.void(), code


@intrinsic
def in_order(typing_context):
    """What other threads see of memory: all that was written before, then what is written after."""

    def code(context, builder, signature, arguments):
        builder.fence("seq_cst")
        return context.get_dummy_value()

    return types.void(), code


@njit(cache=True)
def form_rows(address, nodes):
    """Form those rows of contact nodes, in increasing order, that are not yet formed; `address` of the table of a
    `formed_rows.FormedRows`, 0 where all rows are there."""
    if address == 0:
        return
    if not call(carray(to_integer(address), 3)[0], (address, nodes.ctypes.data, len(nodes))):
        raise MemoryError("no room for rows of the compliance between contact nodes")


@njit(cache=True)
def solver_of(address):
    """Addresses of what solves the mixed form with Factors (`contact.factored_compliance`), and of these, by the same
    table; 0 where there is none."""
    if address == 0:
        return 0, 0
    addresses = carray(to_integer(address), 3)
    return addresses[1], addresses[2]


@njit(cache=True)
def displacer_of(address):
    """Address of what subtracts displacements by forces mesh by mesh (`contact.joined_table`), by the same table; 0
    where that is done by rows."""
    return 0 if address == 0 else carray(to_integer(address), 4)[3]


@njit(cache=True)
def former_of(address):
    """Address of what forms the compliance between closed nodes (`contact.closed_compliance`), by the table of a
    `formed_rows.FormedRows`; 0 where that has rows."""
    return 0 if address == 0 else carray(to_integer(address), 6)[5]


@njit(cache=True)
def forces_at(address):
    """A number of forces, then their rows."""
    return carray(to_integer(address), 1 + carray(to_integer(address), 1)[0])


@contextmanager
def march_with_inertia() -> Iterator[None]:
    """Meanwhile steps with friction are solved by factors that this march has made, whatever sets these are of."""
    before, marching[:] = marching[0], marching[1] + 1
    try:
        yield
    finally:
        marching[0] = before


@njit(cache=True)
def present_march(table):
    """Its number, 0 where there is none with inertia, by the table of Factors."""
    return carray(to_integer(table[PRESENT]), 1)[0]


@njit(cache=True)
def from_afar(address, status):
    """Whether the closed nodes are others than those with which friction was last solved for at this position, if it
    was at all, in a march with inertia by this one; `address` of the table of its Factors."""
    n, table = len(status), carray(to_integer(address), PRESENT + 1)
    closed, alike, had = 0, 0, 0
    for j in range(n):
        closed += status[j] != OPEN
    present = present_march(table)
    if present != 0 and table[MARCH] != present:
        return True
    for row in forces_at(table[OF_FRICTION + KNOWN])[1:]:
        if row < n:
            had += 1
            alike += status[row] != OPEN
    return closed + had - 2 * alike > SHARE_CHANGED * closed


@njit(cache=True)
def close_as_factored(address, status):
    """Close the nodes between which factors without friction were made last at this position, and no others;
    `address` as before."""
    known = forces_at(carray(to_integer(address), KNOWN + 1)[KNOWN])[1:]
    if len(known):
        status[:] = OPEN
        for row in known:
            status[row] = SLIP_FORWARD


@njit(cache=True)
def arrays_of(row, kinds, nodes_before):
    """The arrays of a row; `kinds`: forces of a contact node; `nodes_before`: how many there were a step before."""
    n, c = row.nodes, row.columns
    slides = 0 if row.rigid_slip == 0 else n
    return Arrays(
        carray(to_number(row.compliance), (kinds * n, kinds * n)),
        carray(to_number(row.jacobian), (kinds * n, c)),
        carray(to_number(row.gap), n),
        carray(to_flag(row.on_drive_flanks), n),
        carray(to_integer(row.node_pair), n),
        carray(to_integer(row.node_before), n),
        carray(to_number(row.rigid_slip), slides),
        carray(to_number(row.previous_jacobian), (slides, c)),
        carray(to_number(row.previous_columns), (kinds * nodes_before, slides)),
        carray(to_number(row.sliding), 0 if row.sliding == 0 else n),
        row.rows,
        row.rows_before,
        c,
    )


def row_of(nodes: int, arrays: Sequence[np.ndarray | int | None]) -> tuple[np.ndarray, list[np.ndarray]]:
    """The numbers (r,) of the row of arrays, or their addresses, in the order of `Arrays`; and those arrays, each in
    one piece.

    Plain numbers: to put together structured ones takes numpy longer than a step takes.
    """
    held = [np.ascontiguousarray(array) for array in arrays if isinstance(array, np.ndarray)]
    pieces = iter(held)
    numbers = [next(pieces).ctypes.data if isinstance(each, np.ndarray) else each or 0 for each in arrays]
    return np.array([nodes, *numbers], dtype=np.int64), held
