"""The table of the rows of meshes that move together (`contact.joined_rows`), for compiled code, and what forces on all
of them displace, mesh by mesh."""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import numpy as np
from numba import carray, cfunc, njit

from .addresses import form_rows, to_integer, to_number
from .compliance_product import subtract_displaced

# In the table of all rows after what `addresses` names: how many parts, couplings and sides
# there are, nodes of all rows and columns, forces of a node in either, addresses of the matrix and of the flags that
# say which rows are formed.
PARTS, COUPLINGS, SIDES, ROWS, COLUMNS, KINDS, KINDS_OF_COLUMNS, MATRIX, FORMED = range(4, 13)
NUMBERS = 13
# Of a part: address of its table, of its matrix, its first node among rows and columns, and how many it has.
TABLE, OWN, FIRST, COUNT, FIRST_COLUMN, COUNT_OF_COLUMNS = range(6)
# Of a coupling: the part that responds and the one that is loaded; of the nodes of either addresses of what moves them
# and of the tooth of each; address of what is between teeth; number of motions and of teeth of either. Then, where all
# is solved mesh by mesh, the number of the side that responds and of that which is loaded.
RESPONDING, LOADED, MOVED, TOOTH, MOVED_OF_LOADED, TOOTH_OF_LOADED, BETWEEN, MOTIONS, MOTIONS_OF_LOADED = range(9)
TEETH, TEETH_OF_LOADED, SIDE, SIDE_OF_LOADED = range(9, 13)
# Of a side, those of a gear one after the other: its part and the number of its gear; the rest as of the coupling in
# which it responds.
PART, GEAR = 0, 1


class Tables(NamedTuple):
    """Of all rows, and of each part, coupling and side."""

    head: np.ndarray
    parts: np.ndarray
    couplings: np.ndarray
    sides: np.ndarray


@cache
def joined_displacer():
    """The C function behind `mixed_form.relative_displacement` of meshes together."""
    return cfunc("int64(int64, int64, int64)", cache=True)(_displace)


@njit(cache=True)
def tables_of(address):
    head = carray(to_integer(address), NUMBERS)
    first, second = 1 + head[PARTS], 1 + head[PARTS] + head[COUPLINGS]
    table = carray(to_integer(address), (second + head[SIDES], NUMBERS))
    return Tables(head, table[1:first], table[first:second], table[second:])


@njit(cache=True)
def moved_by(side, nodes):
    """How motions move so many nodes of a part, (n, r), and the tooth of each."""
    return carray(to_number(side[MOVED]), (nodes, side[MOTIONS])), carray(to_integer(side[TOOTH]), nodes)


@njit(cache=True)
def own_compliance(part):
    """The compliance (n, n) of a part, as far as its rows are formed."""
    return carray(to_number(part[OWN]), (part[COUNT], part[COUNT]))


@njit(cache=True)
def between_teeth(coupling):
    size = coupling[TEETH], coupling[TEETH_OF_LOADED], coupling[MOTIONS], coupling[MOTIONS_OF_LOADED]
    return carray(to_number(coupling[BETWEEN]), size)


def _displace(address, forces_address, displacement_address):
    """Subtract what forces (n,) displace from displacements (n,), without friction; returns 1."""
    tables = tables_of(address)
    n, sides = tables.head[ROWS], tables.sides
    forces, displacement = carray(to_number(forces_address), n), carray(to_number(displacement_address), n)
    for part in tables.parts:
        own = slice(part[FIRST], part[FIRST] + part[COUNT])
        loaded = np.flatnonzero(forces[own])
        if len(loaded):
            form_rows(part[TABLE], loaded)
            subtract_displaced(displacement[own], forces[own], own_compliance(part), np.int64(0))
    if not len(sides):
        return 1
    work = np.zeros((len(sides), sides[:, TEETH].max(), sides[:, MOTIONS].max()))
    for number in range(len(sides)):
        _add_work(work[number], tables, sides[number], forces)
    moved = np.zeros(work.shape)
    for coupling in tables.couplings:
        between, side, other = between_teeth(coupling), coupling[SIDE], coupling[SIDE_OF_LOADED]
        for tooth, there in np.ndindex(between.shape[:2]):
            loads = work[other, there, : coupling[MOTIONS_OF_LOADED]]
            moved[side, tooth, : coupling[MOTIONS]] += np.dot(between[tooth, there], loads)
    for number in range(len(sides)):
        _subtract_moved(displacement, tables, sides[number], moved[number])
    return 1


@njit(cache=True)
def _add_work(work, tables, side, forces):
    """Add what forces do on the motions of each tooth of a side, (T, r)."""
    part = tables.parts[side[PART]]
    moved, tooth = moved_by(side, part[COUNT])
    for node in range(part[COUNT]):
        force = forces[part[FIRST] + node]
        if force != 0.0:
            for motion in range(moved.shape[1]):
                work[tooth[node], motion] += force * moved[node, motion]


@njit(cache=True)
def _subtract_moved(displacement, tables, side, by_teeth):
    """Subtract the motions (T, r) of each tooth of a side from displacements."""
    part = tables.parts[side[PART]]
    moved, tooth = moved_by(side, part[COUNT])
    for node in range(part[COUNT]):
        for motion in range(moved.shape[1]):
            displacement[part[FIRST] + node] -= moved[node, motion] * by_teeth[tooth[node], motion]
