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
from .fine_sections import BEGIN, IN_SLICE, PLACE, SLICE, WIDTH, Fine, SectionNodes, add_fine, end_of, padded
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
    # By what M has of rows, so that of most nodes a row has all.
    for node in missing[np.argsort(side.on_gears[0, PLACE][side.group[missing]])]:
        slot = slots[0]
        members[slot], slots[1 + node], slots[0] = node, slot, slot + 1
        own = known[slot, : slot + 1]
        own[:] = 0.0
        for gear, line in enumerate(lines):
            end = _put_line(line, source, gear, node)
            _add_between(own, members, (side.near[gear], side.first[gear]), (line, end), (source.between[gear], node))
        groups = side.groups
        for q in np.flatnonzero(groups[SLICE] == groups[SLICE, side.group[node]]):
            for other in range(groups[BEGIN, q], end_of(side, q)):
                if 0 <= slots[1 + other] <= slot:
                    place = groups[IN_SLICE, q] + other - groups[BEGIN, q]
                    own[slots[1 + other]] += source.in_slices[node, place]
    return 1


@njit(cache=True)
def _line(source, gear):
    """Room for what forces on a contact node displace at all flank nodes of a gear."""
    # Narrow interpolations are as wide as the others, with weights of zero.
    return np.zeros(source.nodes.on_gears[gear, WIDTH].sum() + source.nodes.near.shape[2])


@njit(cache=True)
def _put_line(line, source, gear, node):
    """Put the sum of those rows of M that a contact node sees, by its weights, into a line, to the last flank node of
    its group; returns where that ends."""
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
    return end


@njit(cache=True)
def _add_between(found, members, seen, displaced, of):
    """Add what is between a contact node and the first `members`: by what these see of its line, or of their own rows
    of M where they begin after its end."""
    (near, first), (line, end), (between, node) = seen, displaced, of
    # uint64 avoids numba's wraparound check.
    weights, width, one = near.reshape(-1), np.uint64(near.shape[1]), np.uint64(1)
    for slot in range(np.uint64(len(found))):
        member, total = np.uint64(members[slot]), 0.0
        at = np.uint64(first[member])
        if at < end:
            for k in range(member * width, member * width + width):
                total += weights[k] * line[at]
                at += one
        else:
            for k in range(near.shape[1]):
                if near[member, k] != 0.0:
                    row = row_of(first[member] + k) + first[node]
                    for j in range(near.shape[1]):
                        total += near[member, k] * near[node, j] * between[row + j]
        found[slot] += total


@njit(cache=True)
def _form_fine(source, nodes):
    """Form those rows of F of contact nodes, in increasing order, that are not yet formed."""
    missing = nodes[~source.formed[nodes]]
    # As in `formed_rows`: two threads may form a row.
    in_order()
    begin, rows, fine = 0, source.nodes, source.fine
    while begin < len(missing):
        group, end = rows.group[missing[begin]], begin + 1
        while end < len(missing) and rows.group[missing[end]] == group:
            end += 1
        own = missing[begin:end]
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
    numbers, factors = np.array([UPPER, len(forces), 1], dtype=np.int32), np.array([1.0, 0.0])
    # Rows up to the diagonal are columns of what is above it. Of narrow interpolations' room M has nothing.
    numbers[1] = int(np.sqrt(2 * len(between)))
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
