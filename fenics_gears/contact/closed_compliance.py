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

from .addresses import in_order, to_flag, to_integer, to_number
from .compliance_product import add_multiple
from .face_ends import add_ends
from .factored_compliance import CLOSED, END, MEMBERS, SLOTS
from .fine_sections import BEGIN, IN_SLICE, SLICE, Fine, SectionNodes, add_fine, end_of, padded
from .formed_rows import arrays_at, fine_of, side_of


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
    first, second, in_slices, formed = table[34], table[35], table[36], table[37]
    return _Source(
        side_of(table),
        fine_of(table),
        (carray(to_number(first[0]), (first[1], first[2])), carray(to_number(second[0]), (second[1], second[2]))),
        carray(to_number(in_slices[0]), (in_slices[1], in_slices[2])),
        carray(to_flag(formed[0]), formed[1]),
    )


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
    first, second = np.empty(len(source.between[0])), np.empty(len(source.between[1]))
    for node in missing:
        slot = slots[0]
        members[slot], slots[1 + node], slots[0] = node, slot, slot + 1
        own = known[slot, : slot + 1]
        own[:] = 0.0
        for gear, line in enumerate((first, second)):
            _put_line(line, source.between[gear], source.nodes.near[gear, node], source.nodes.first[gear, node])
            _add_seen_by(own, members, source.nodes.near[gear], source.nodes.first[gear], line)
        groups = source.nodes.groups
        for q in np.flatnonzero(groups[SLICE] == groups[SLICE, source.nodes.group[node]]):
            for other in range(groups[BEGIN, q], end_of(source.nodes, q)):
                if 0 <= slots[1 + other] <= slot:
                    place = groups[IN_SLICE, q] + other - groups[BEGIN, q]
                    own[slots[1 + other]] += source.in_slices[node, place]
    return 1


@njit(cache=True)
def _put_line(line, between, weights, first):
    """Put the weighted sum of rows of M, from the `first` on, into `line`."""
    line[:] = 0.0
    for k in range(len(weights)):
        if weights[k] != 0.0:
            add_multiple(line, weights[k], between[first + k], np.int64(0))


@njit(cache=True)
def _add_seen_by(found, members, near, first, line):
    """Add what some contact nodes, the first `members`, see of a line of flank nodes."""
    # uint64 avoids numba's wraparound check.
    weights, width, one = near.reshape(-1), np.uint64(near.shape[1]), np.uint64(1)
    for slot in range(np.uint64(len(found))):
        node = np.uint64(members[slot])
        at, total = np.uint64(first[node]), 0.0
        for k in range(node * width, node * width + width):
            total += weights[k] * line[at]
            at += one
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


def _displace(address, forces_address, displacement_address):
    """Subtract what forces (n,) displace from displacements (n,); returns 1."""
    source = _source(address)
    nodes, groups, n = source.nodes, source.nodes.groups, len(source.nodes.group)
    forces, displacement = carray(to_number(forces_address), n), carray(to_number(displacement_address), n)
    loaded = np.flatnonzero(forces)
    if not len(loaded):
        return 1
    _form_fine(source, loaded)
    for gear in range(2):
        near, first, between = nodes.near[gear], nodes.first[gear], source.between[gear]
        on_flanks = np.zeros(len(between))
        for node in loaded:
            for k in range(near.shape[1]):
                on_flanks[first[node] + k] += near[node, k] * forces[node]
        moved = np.dot(between, on_flanks)
        for node in range(n):
            for k in range(near.shape[1]):
                displacement[node] -= near[node, k] * moved[first[node] + k]
    for node in loaded:
        for q in np.flatnonzero(groups[SLICE] == groups[SLICE, nodes.group[node]]):
            begin, end = groups[BEGIN, q], end_of(nodes, q)
            add_multiple(displacement[begin:end], -forces[node], source.in_slices[node], groups[IN_SLICE, q])
    return 1
