"""Compliance without friction between the contact nodes of a face that were ever closed, and what forces displace.

Newton's method needs the compliance between closed nodes, and the displacement of all nodes under the forces on these.
Neither asks for rows between a closed node and all others (`contact.formed_rows`). With the weights W of contact nodes,
M of either body (`contact.between_flank_nodes`) and F of the fine sections in each slice

    C = W_1 M_1 W_1^T + W_2 M_2 W_2^T + F
"""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import numpy as np
from numba import carray, cfunc, njit
from numba.extending import get_cython_function_address

from .addresses import call, in_order, number_vector, to_flag, to_integer, to_number
from .between_flank_nodes import row_of
from .compliance_product import add_multiple
from .face_ends import add_ends
from .factored_compliance import CLOSED, END, INT, MEMBERS, SLOTS
from .fine_sections import (
    BEGIN,
    IN_SLICE,
    PLACE,
    SLICE,
    WIDTH,
    Fine,
    SectionNodes,
    add_fine,
    end_in_group,
    end_of,
    padded,
)
from .formed_rows import arrays_at, fine_of, side_of

# What BLAS is told.
UPPER = ord("U")


class _Source(NamedTuple):
    """Contact nodes, M of both bodies, and of F the rows (n, most nodes in a slice) by place in the slice, as far as
    they are `formed` (n,)."""

    nodes: SectionNodes
    fine: Fine
    between: tuple[np.ndarray, np.ndarray]
    in_slices: np.ndarray
    formed: np.ndarray


@njit(cache=True)
def _source(address):
    table = arrays_at(address)
    in_slices, formed = table[36], table[37]
    return _Source(
        side_of(table),
        fine_of(table),
        (number_vector(table[34]), number_vector(table[35])),
        carray(to_number(in_slices[0]), (in_slices[1], in_slices[2])),
        carray(to_flag(formed[0]), formed[1]),
    )


@cache
def functions() -> tuple[int, int, int]:
    """Addresses of the functions of a `between_flank_nodes.Between`."""
    multiplier = get_cython_function_address("scipy.linalg.cython_blas", "dspmv")
    return displacer().address, multiplier, closed_former().address


@cache
def closed_former():
    """The C function that has the compliance between some nodes and all that were closed before, by the address of the
    table of a FormedRows and of Factors; returns 1."""
    return cfunc("int64(int64, int64, int64, int64)", cache=True)(_form_closed)


def _form_closed(address, factors, nodes, count):
    source, table = _source(address), carray(to_integer(factors), END)
    n = len(source.nodes.group)
    slots, members = carray(to_integer(table[SLOTS]), n + 1), carray(to_integer(table[MEMBERS]), n)
    known, asked = carray(to_number(table[CLOSED]), (n, n)), carray(to_integer(nodes), count)
    missing = asked[slots[1:][asked] < 0]
    _form_fine(source, missing)
    side, lines = source.nodes, (_line(source, 0), _line(source, 1))
    order = _order(side)
    # In this order a line has all that is asked of it.
    for node in missing[np.argsort(order[missing])]:
        slot = slots[0]
        members[slot] = node
        own = known[slot, : slot + 1]
        own[:] = 0.0
        for gear, line in enumerate(lines):
            _put_line(line, source, gear, node)
            seen, between = (side.near[gear], side.first[gear]), source.between[gear]
            _add_between(own, members, order, seen, (line, between))
        _add_in_slice(own, source, node, slots[1:], order)
        slots[1 + node], slots[0] = slot, slot + 1
    return 1


@njit(cache=True)
def _order(side):
    """Of each contact node (n,) the place in the order of M's rows. Between two nodes is what the later one's rows
    give, whichever closed first: runs on the same operators do not differ by each other."""
    places = side.on_gears[0, PLACE][side.group]
    order = np.empty(len(places), dtype=np.int64)
    order[np.argsort(places * len(places) + np.arange(len(places)))] = np.arange(len(places))
    return order


@njit(cache=True)
def _line(source, gear):
    """Room for what forces on a contact node displace at all flank nodes of a gear."""
    # Narrow interpolations are as wide as the others, with weights of zero.
    return np.zeros(source.nodes.on_gears[gear, WIDTH].sum() + source.nodes.near.shape[2])


@njit(cache=True)
def _put_line(line, source, gear, node):
    """Put the sum of those rows of M that a contact node sees, by its weights, into a line, to the last flank node of
    its group."""
    side, between = source.nodes, source.between[gear]
    weights, first, group = side.near[gear, node], side.first[gear, node], side.group[node]
    end = side.on_gears[gear, PLACE, group] + side.on_gears[gear, WIDTH, group]
    line[:end] = 0.0
    for k in range(len(weights)):
        row = first + k
        if weights[k] != 0.0:
            add_multiple(line[: row + 1], weights[k], between, row_of(row))
            for other in range(row + 1, end):
                line[other] += weights[k] * between[row_of(other) + row]


@njit(cache=True)
def _add_between(found, members, order, seen, displaced):
    """Add what is between a contact node, the last of the first `members`, and these: by what they see of its line,
    or of the lines of those later in the `order` what it sees itself."""
    (near, first), (line, between), node = seen, displaced, members[len(found) - 1]
    # uint64 avoids numba's wraparound check.
    weights, width, one = near.reshape(-1), np.uint64(near.shape[1]), np.uint64(1)
    for slot in range(np.uint64(len(found))):
        member, total = np.uint64(members[slot]), 0.0
        at = np.uint64(first[member])
        if order[member] <= order[node]:
            for k in range(member * width, member * width + width):
                total += weights[k] * line[at]
                at += one
        else:
            for j in range(near.shape[1]):
                if near[node, j] != 0.0:
                    total += near[node, j] * _displaced(between, near[member], first[member], first[node] + j)
        found[slot] += total


@njit(cache=True)
def _displaced(between, weights, first, column):
    """What a force on a contact node displaces at a flank node, as of its line."""
    total = 0.0
    for k in range(len(weights)):
        if weights[k] != 0.0:
            row = first + k
            total += weights[k] * between[row_of(max(row, column)) + min(row, column)]
    return total


@njit(cache=True)
def _add_in_slice(found, source, node, slots, order):
    """Add F between a contact node, whose slot is the last one, and those of its slice that have `slots` (n,): of each
    two the row of the later one in the `order`."""
    side, groups, own = source.nodes, source.nodes.groups, source.nodes.group[node]
    place = groups[IN_SLICE, own] + node - groups[BEGIN, own]
    for q in np.flatnonzero(groups[SLICE] == groups[SLICE, own]):
        begin = groups[BEGIN, q]
        for other in range(begin, end_of(side, q)):
            slot = len(found) - 1 if other == node else slots[other]
            if slot >= 0 and order[other] <= order[node]:
                found[slot] += source.in_slices[node, groups[IN_SLICE, q] + other - begin]
            elif slot >= 0:
                found[slot] += source.in_slices[other, place]


@njit(cache=True)
def _form_fine(source, nodes):
    """Form those rows of F of contact nodes, in increasing order, that are not yet formed."""
    missing = nodes[~source.formed[nodes]]
    # As in `formed_rows`: two threads may form a row.
    in_order()
    begin, rows, fine = 0, source.nodes, source.fine
    while begin < len(missing):
        end = end_in_group(rows, missing, begin)
        group, own = rows.group[missing[begin]], missing[begin:end]
        found = np.zeros((1, source.in_slices.shape[1], padded(len(own))))
        add_fine(found, (rows, rows, fine), group, own, rows.groups[IN_SLICE])
        add_ends(found, rows, fine, group, own, rows.groups[IN_SLICE, group])
        layer = fine.layers[rows.groups[SLICE, group]] * fine.shares[rows.groups[SLICE, group]]
        for number in range(len(own)):
            place = rows.groups[IN_SLICE, group] + own[number] - rows.groups[BEGIN, group]
            if layer != 0.0:
                found[0, place, number] += layer
            source.in_slices[own[number]] = found[0, :, number]
        in_order()
        source.formed[own] = True
        begin = end


@cache
def displacer():
    """The C function behind `mixed_form.relative_displacement` of a face without friction."""
    return cfunc("int64(int64, int64, int64)", cache=True)(_displace)


@njit(cache=True)
def _multiply(function, between, forces, moved):
    """Put M times forces into place, by the function of BLAS at an address."""
    # Rows up to the diagonal are columns of what is above it; of n they have n (n + 1) / 2 numbers.
    numbers, factors = np.array([UPPER, np.sqrt(2 * len(between)), 1]).astype(np.int32), np.array([1.0, 0.0])
    at, one = np.int64(numbers.ctypes.data), np.int64(factors.ctypes.data)
    size, step, zero = at + INT, at + 2 * INT, one + 8
    vectors = forces.ctypes.data, moved.ctypes.data
    call(function, (at, size, one, between.ctypes.data, vectors[0], step, zero, vectors[1], step))
    # Named once more, for compiled code gives back an array as soon as nothing names it.
    numbers[2] = int(factors[0])


def _displace(address, forces_address, displacement_address):
    """Subtract what forces (n,) displace from displacements (n,); returns 1."""
    source, multiply = _source(address), carray(to_integer(address), 5)[4]
    nodes, groups, n = source.nodes, source.nodes.groups, len(source.nodes.group)
    forces, displacement = carray(to_number(forces_address), n), carray(to_number(displacement_address), n)
    loaded = np.flatnonzero(forces)
    if not len(loaded):
        return 1
    _form_fine(source, loaded)
    for gear in range(2):
        near, first = nodes.near[gear], nodes.first[gear]
        on_flanks = _line(source, gear)
        for node in loaded:
            for k in range(near.shape[1]):
                on_flanks[first[node] + k] += near[node, k] * forces[node]
        moved = _line(source, gear)
        _multiply(multiply, source.between[gear], on_flanks, moved)
        for node in range(n):
            for k in range(near.shape[1]):
                displacement[node] -= near[node, k] * moved[first[node] + k]
    for node in loaded:
        for q in np.flatnonzero(groups[SLICE] == groups[SLICE, nodes.group[node]]):
            begin, end = groups[BEGIN, q], end_of(nodes, q)
            add_multiple(displacement[begin:end], -forces[node], source.in_slices[node], groups[IN_SLICE, q])
    return 1
