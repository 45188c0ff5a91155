"""Where arrays lie in memory, so that one call of compiled code goes through the contact operators of many steps
without copying them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numba import carray, njit, types
from numba.extending import intrinsic

# What `Position.in_memory` holds of a contact operator.
(
    NODES,
    COMPLIANCE,
    JACOBIAN,
    GAP,
    ON_DRIVE_FLANKS,
    NODE_PAIR,
    CARRIED,
    RIGID_SLIP,
    PREVIOUS_JACOBIAN,
    PREVIOUS_COMPLIANCE,
) = range(10)


def _pointer_to(kind):
    @intrinsic
    def pointer(typing_context, address):
        def code(context, builder, signature, arguments):
            return builder.inttoptr(arguments[0], context.get_value_type(signature.return_type))

        return types.CPointer(kind)(types.int64), code

    return pointer


_to_number, _to_integer, _to_flag = (_pointer_to(kind) for kind in (types.float64, types.int64, types.boolean))


@njit(cache=True, inline="always")
def matrix_at(address, rows, columns):
    """The matrix (rows, columns) of floats at an address."""
    return carray(_to_number(address), (rows, columns))


@njit(cache=True, inline="always")
def vector_at(address, size):
    """The vector (size,) of floats at an address."""
    return carray(_to_number(address), size)


@njit(cache=True, inline="always")
def integers_at(address, size):
    """The integers (size,) at an address."""
    return carray(_to_integer(address), size)


@njit(cache=True, inline="always")
def flags_at(address, size):
    """The flags (size,) at an address."""
    return carray(_to_flag(address), size)


def addresses(arrays: Sequence[np.ndarray | None]) -> tuple[np.ndarray, list[np.ndarray]]:
    """Address of each array, 0 for None; and the arrays, which lie in one piece there and have to be held as long as
    the addresses are used."""
    held = [np.empty(0) if array is None else np.ascontiguousarray(array) for array in arrays]
    return np.array(
        [0 if array is None else kept.ctypes.data for array, kept in zip(arrays, held)], dtype=np.int64
    ), held
