"""Sets that differ in a few nodes from those between whose forces there are factors: one unknown y for each change.

With A the factored compliance of forces x, G~ the jacobian of these and B, D, E what the changes add,

    A x + B y = G q - g,    D x + E y = G' q - g',    K q + G~^T x + G~'^T y = F

A force that is new comes with the equation of its row. A force that is gone leaves an opening y in its row and is zero,
or, where a node slips that stuck, what slip makes it. Slip that turns round adds a tangential force.
"""

from typing import NamedTuple

import numpy as np
from numba import njit

from .mixed_form import add_slip, put_entries

# Up to so many a border costs less than new factors.
MOST_CHANGES = 16
# Columns of `places`: the node whose force y is, or the row of an opening (-1 for none); the row of the compliance that
# is its equation, with its place among all unknown forces (-1 for none); two of the factored forces.
NODE, OPENED, ROW, AT, FIRST, SECOND = range(6)
# Columns of `parts`: of y in the normal and the tangential force of the node; of the two factored forces, and of y, in
# an equation that is no row of the compliance, which is zero. With a row, the force is y and so much of the first.
NORMAL, TANGENTIAL, OF_FIRST, OF_SECOND, OWN = range(5)


class Changes(NamedTuple):
    """How unknown forces differ from the factored ones: their places among these (`old` (a,), -1 for none); `places`
    (c, 6) and `parts` (c, 5) of each change."""

    old: np.ndarray
    places: np.ndarray
    parts: np.ndarray


@njit(cache=True)
def no_changes(size):
    """Of so many unknown forces."""
    return Changes(np.arange(size), np.empty((0, 6), dtype=np.int64), np.empty((0, 5)))


@njit(cache=True)
def changes_from(rows_then, slip_then, rows, slip, nodes, most):
    """Changes from the rows (and slip) of factored forces to others with friction, both in the order of
    `mixed_form.solve_sets`; and whether these are `most` or fewer."""
    then, now, slip_now = np.full(2 * nodes, -1), np.full(2 * nodes, -1), np.zeros(len(rows_then))
    old, places, parts = np.empty(len(rows), dtype=np.int64), np.full((most, 6), -1), np.zeros((most, 5))
    for a in range(len(rows_then)):
        then[rows_then[a]] = a
    for a in range(len(rows)):
        now[rows[a]] = a
    count = 0
    for a in range(len(rows)):
        row = rows[a]
        node, before = row % nodes, then[row]
        old[a], at_node = before, then[node]
        if before >= 0 and row < nodes:
            slip_now[before] = slip[a]
            if slip_then[before] == slip[a] or then[nodes + node] >= 0 or now[nodes + node] >= 0:
                continue
        elif before >= 0:
            continue
        if count == most:
            return Changes(old, places, parts), False
        place, part = places[count], parts[count]
        place[NODE], place[FIRST], place[SECOND] = node, max(at_node, 0), 0
        if before >= 0:
            part[TANGENTIAL], part[OF_FIRST], part[OWN] = 1.0, slip_then[before] - slip[a], 1.0
        else:
            place[ROW], place[AT] = row, a
            if row < nodes:
                part[NORMAL], part[TANGENTIAL] = 1.0, slip[a]
            else:
                part[TANGENTIAL] = 1.0
                part[OF_FIRST] = slip_then[at_node] if at_node >= 0 else 0.0
        count += 1
    for a in range(len(rows_then)):
        row = rows_then[a]
        if now[row] >= 0:
            continue
        if count == most:
            return Changes(old, places, parts), False
        place, part = places[count], parts[count]
        place[OPENED], place[FIRST], place[SECOND], part[OF_FIRST] = a, a, 0, 1.0
        if row >= nodes and now[row - nodes] >= 0:
            place[SECOND] = then[row - nodes]
            part[OF_SECOND] = -slip_now[place[SECOND]]
        count += 1
    return Changes(old, places[:count], parts[:count]), True


@njit(cache=True)
def put_columns(columns, changes, rows_then, compliance, unit):
    """Put B by columns (c, a) into place: what each y opens at the rows of factored forces, mm."""
    nodes = len(compliance) // 2
    for i in range(len(columns)):
        place, part = changes.places[i], changes.parts[i]
        if place[OPENED] >= 0:
            columns[i] = 0.0
            columns[i, place[OPENED]] = 1.0
        else:
            # Rows of nodes that are closed are there, and the compliance is symmetric.
            node = place[NODE]
            put_entries(columns[i], compliance[node], rows_then, np.int64(0), unit * part[NORMAL])
            _add_entries(columns[i], compliance[nodes + node], rows_then, unit * part[TANGENTIAL])


@njit(cache=True)
def _add_entries(entries, values, places, unit):
    for b in range(np.uint64(len(places))):
        entries[b] += unit * values[np.uint64(places[b])]


@njit(cache=True)
def put_equations(equations, changes, rows_then, slip_then, compliance, unit):
    """Put D (c, a) into place: what factored forces open in the equations of the changes."""
    nodes = len(compliance) // 2
    for i in range(len(equations)):
        place, part = changes.places[i], changes.parts[i]
        if place[ROW] >= 0:
            row = compliance[place[ROW]]
            put_entries(equations[i], row, rows_then, np.int64(0), unit)
            add_slip(equations[i], row[nodes:], rows_then, slip_then, unit)
        else:
            equations[i] = 0.0
            equations[i, place[FIRST]] = part[OF_FIRST]
            equations[i, place[SECOND]] += part[OF_SECOND]


@njit(cache=True)
def put_changes(matrix, right_side, changes, system, products):
    """Put equations of changes, the first of all, into a `matrix` (c + k, c + k), the `right_side`, of y and of the
    coordinates q: what is left where x is eliminated.

    `system`: as of `factored_compliance`; `products`: of G~ of forces (k, .) and of D (c, .) with A^-1 G, A^-1 g and
    A^-1 B.
    """
    (by_forces, by_changes), compliance, jacobian, unit = products, system.compliance, system.jacobian, system.unit
    n, count, k = len(compliance) // 2, len(changes.places), len(by_forces)
    for i in range(count):
        place, part, row = changes.places[i], changes.parts[i], changes.places[i, ROW]
        right_side[i] = by_changes[i, k] - (system.opening[place[AT]] if row >= 0 else 0.0)
        for other in range(count):
            matrix[i, other] = _entry(changes, i, other, compliance, unit) - by_changes[i, k + 1 + other]
        for c in range(k):
            matrix[i, count + c] = by_changes[i, c] - (jacobian[row, c] if row >= 0 else 0.0)
            moved = 0.0
            if place[OPENED] < 0:
                moved = part[NORMAL] * jacobian[place[NODE], c] + part[TANGENTIAL] * jacobian[n + place[NODE], c]
            matrix[count + c, i] = moved - by_forces[c, k + 1 + i]


@njit(cache=True)
def _entry(changes, i, other, compliance, unit):
    """E: what the `other` y opens in the equation of change i."""
    row, place, part = changes.places[i, ROW], changes.places[other], changes.parts[other]
    if row < 0:
        return changes.parts[i, OWN] if other == i else 0.0
    if place[OPENED] >= 0:
        return 0.0
    node = place[NODE]
    tangential = compliance[row, len(compliance) // 2 + node]
    return unit * (part[NORMAL] * compliance[row, node] + part[TANGENTIAL] * tangential)


@njit(cache=True)
def put_forces(system, changes, factored_forces, of_changes, result):
    """Put all forces (m,), N, into `result`, of those that are factored and of changes, both in `unit` N."""
    rows, slip, n = system.rows, system.slip, len(system.jacobian) // 2
    result[: len(system.jacobian)] = 0.0
    for a in range(len(rows)):
        if changes.old[a] >= 0:
            result[rows[a]] = system.unit * factored_forces[changes.old[a]]
    for i in range(len(changes.places)):
        row, first = changes.places[i, ROW], changes.places[i, FIRST]
        if row >= 0:
            result[row] = system.unit * (of_changes[i] + changes.parts[i, OF_FIRST] * factored_forces[first])
    for b in range(len(slip)):
        result[n + rows[b]] += slip[b] * result[rows[b]]
