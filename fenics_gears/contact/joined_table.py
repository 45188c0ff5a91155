"""The table of the rows of meshes that move together (`contact.joined_rows`), for compiled code, and what forces on all
of them displace, mesh by mesh."""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import numpy as np
from numba import carray, cfunc, njit

from .addresses import call, displacer_of, form_rows, to_integer, to_number
from .compliance_product import subtract_displaced

# In the table of all rows after what `addresses` names: how many parts, couplings and sides there are, nodes of all
# rows and columns, forces of a node in either, addresses of the matrix, of the flags that say which rows are formed,
# and of the units of rows and of columns, 0 where all are one.
PARTS, COUPLINGS, SIDES, ROWS, COLUMNS, KINDS, KINDS_OF_COLUMNS, MATRIX, FORMED, UNITS, UNITS_OF_COLUMNS = range(4, 15)
NUMBERS = 15
# Of a part: address of its table, of its matrix, its first node among rows and columns, and how many it has. Then,
# where all is solved mesh by mesh, addresses of its Factors and of what lasts with them, and how many motions its sides
# have. Last, forces of a node that have rows.
TABLE, OWN, FIRST, COUNT, FIRST_COLUMN, COUNT_OF_COLUMNS, FACTORS, LASTING, MOVES, OWN_KINDS = range(10)
# Of a coupling: the part that responds and the one that is loaded; addresses of what moves the nodes of either, and of
# what is between these motions; how many motions each has. Then, where all is solved mesh by mesh, the number of the
# side that responds and of that which is loaded.
RESPONDING, LOADED, MOVED, MOVED_OF_LOADED, BETWEEN, MOTIONS, MOTIONS_OF_LOADED, SIDE, SIDE_OF_LOADED = range(9)
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
    """How motions move so many nodes of a part, (n, r)."""
    return carray(to_number(side[MOVED]), (nodes, side[MOTIONS]))


@njit(cache=True)
def own_compliance(part):
    """The compliance (n, n) of a part, as far as its rows are formed."""
    return carray(to_number(part[OWN]), (part[COUNT], part[COUNT]))


@njit(cache=True)
def between_motions(coupling):
    """Motions (r, r') of the side that responds by those that forces on the other one do work on, mm/N."""
    return carray(to_number(coupling[BETWEEN]), (coupling[MOTIONS], coupling[MOTIONS_OF_LOADED]))


def _displace(address, forces_address, displacement_address):
    """Subtract what forces (n,) displace from displacements (n,), without friction; returns 1."""
    tables = tables_of(address)
    n, sides = tables.head[ROWS], tables.sides
    forces, displacement = carray(to_number(forces_address), n), carray(to_number(displacement_address), n)
    for part in tables.parts:
        own = slice(part[FIRST], part[FIRST] + part[COUNT])
        loaded = np.flatnonzero(forces[own])
        displacer = displacer_of(part[TABLE])
        if displacer != 0:
            own_forces, displaced = forces[own], displacement[own]
            if not call(displacer, (part[TABLE], own_forces.ctypes.data, displaced.ctypes.data)):
                return 0
        elif len(loaded):
            form_rows(part[TABLE], loaded)
            subtract_displaced(displacement[own], forces[own], own_compliance(part), np.int64(0))
    if not len(sides):
        return 1
    work = np.zeros((len(sides), sides[:, MOTIONS].max()))
    moved = np.zeros_like(work)
    for number in range(len(sides)):
        _add_work(work[number], tables, sides[number], forces)
    for coupling in tables.couplings:
        loads = work[coupling[SIDE_OF_LOADED], : coupling[MOTIONS_OF_LOADED]]
        moved[coupling[SIDE], : coupling[MOTIONS]] += np.dot(between_motions(coupling), loads)
    for number in range(len(sides)):
        side = sides[number]
        part = tables.parts[side[PART]]
        own = slice(part[FIRST], part[FIRST] + part[COUNT])
        displacement[own] -= np.dot(moved_by(side, part[COUNT]), moved[number, : side[MOTIONS]])
    return 1


@njit(cache=True)
def _add_work(work, tables, side, forces):
    """Add what forces do on the motions of a side, (r,)."""
    part = tables.parts[side[PART]]
    moved = moved_by(side, part[COUNT])
    for node in range(part[COUNT]):
        force = forces[part[FIRST] + node]
        if force != 0.0:
            for motion in range(moved.shape[1]):
                work[motion] += force * moved[node, motion]
