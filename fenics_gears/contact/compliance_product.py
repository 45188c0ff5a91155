"""The flank compliance seen by contact nodes: `N A N^T`, in the directions of the line of action (compiled)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import carray, njit

from .addresses import to_number


def directions(contact_roll: float | np.ndarray, tangential: bool) -> np.ndarray:
    """Unit vectors e_x (and e_y), (1 or 2, 2), in the frame of a tooth that touches at `contact_roll` (rad), or of
    teeth that touch at some (..., 1 or 2, 2)."""
    cosine, sine = np.cos(contact_roll), np.sin(contact_roll)
    both = [[cosine, -sine], [sine, cosine]]
    return np.moveaxis(np.array(both if tangential else both[:1]), (0, 1), (-2, -1))


# Columns of the tables of `compliance_products`. Of positions: addresses of the compliance and of that before, and how
# many contact nodes there are, and were a step before. Of flanks: where the weights of their contact nodes begin, and
# how many a node has, where their first flank nodes begin, and how many contact nodes there are. Of products: the
# position, address, size and columns of the bodies' block, the flank that responds, those loaded now and a step
# before or NO_FLANK, and the place of the first node of each among all.
COMPLIANCE, NODES = 0, 2
NEAR, WIDTH, FIRST, COUNT = range(4)
POSITION, BLOCK, SIZE, COLUMNS, OWN, LOADED, OWN_PLACE, LOADED_PLACE = 0, 1, 2, 3, 4, 5, 7, 8
NO_FLANK = -1


class Entries(NamedTuple):
    """Where a compliance between all contact nodes has those of two flanks: the first `row`, of the loaded flank's
    normal forces, and the one of tangential forces `rows` below; the first `column`, and the one of the next direction
    `columns` on. `responding`: how many contact nodes of the flank that responds."""

    row: int
    rows: int
    column: int
    columns: int
    responding: int


@njit(cache=True)
def compliance_products(tables, near, first, axes, responding):
    """Add `N_a A N_b^T` of the contact nodes of flanks a and of flanks b to compliances between all contact nodes of
    many positions, mm/N.

    `tables`: of positions, flanks and products, with the columns above. No loaded flank has a later place than the one
    that responds: the other half follows by symmetry. Blocks (2 n, 2 n): displacement of the flank nodes of a by forces
    on those of b. `near`, `first`: of the FlankInterpolation of one flank after the other. `axes` (flanks, d, 2):
    directions of forces, in the tooth's frame; `responding` (products, 1 or 3, 2): of the displacement, with friction
    also along the tangent as it stood a step before. Compliances are (d n, d n), those before (2 n before, n), by
    columns, along this tangent.
    """
    positions, flanks, products = tables
    kinds, directions, most = axes.shape[1], responding.shape[1], flanks[:, COUNT].max() if len(flanks) else 0
    columns = products[:, COLUMNS].max() if len(products) else 0
    room, sums = np.empty(columns * directions * most), np.empty((2, columns))
    for number in range(len(products)):
        product = products[number]
        position, own, n = positions[product[POSITION]], product[OWN], flanks[product[OWN], COUNT]
        start, end = _reach(product, flanks, first)
        along = room[: directions * n * 2 * (end - start)].reshape(directions * n, 2 * (end - start))
        _put_along(along, sums, (product, flanks[own], start), near, first, responding[number])
        for before in range(2):
            loaded, nodes = product[LOADED + before], position[NODES + before]
            if loaded != NO_FLANK:
                rows = along[kinds * n :] if before else along[: kinds * n]
                shape = kinds * nodes, len(rows) // n * position[NODES]
                result = carray(to_number(position[COMPLIANCE + before]), shape)
                entries = Entries(product[LOADED_PLACE + before], nodes, product[OWN_PLACE], position[NODES], n)
                half = not before and entries.row == entries.column
                _at_nodes(result, rows, entries, (flanks[loaded], near, first), axes[loaded], start, half)
    for position in positions:
        size = kinds * position[NODES]
        _mirror(carray(to_number(position[COMPLIANCE]), (size, size)), kinds)


@njit(cache=True)
def _reach(product, flanks, first):
    """The flank nodes, from the first to the one after the last, that forces of a product act on."""
    start, end = np.iinfo(np.int64).max, 0
    for loaded in product[LOADED : LOADED + 2]:
        if loaded != NO_FLANK:
            for node in range(flanks[loaded, FIRST], flanks[loaded, FIRST] + flanks[loaded, COUNT]):
                start, end = min(start, first[node]), max(end, first[node] + flanks[loaded, WIDTH])
    return start, end


@njit(cache=True)
def _put_along(along, sums, of, near, first, directions):
    """Put the displacement of the contact nodes (n,) of a flank along directions (d, 2), by x and y of each loaded
    flank node from `start` on, into (d n, 2 k)."""
    product, own, start = of
    n, width, columns, forces = own[COUNT], own[WIDTH], product[COLUMNS], along.shape[1]
    block, x, y = carray(to_number(product[BLOCK]), product[SIZE]), sums[0, :forces], sums[1, :forces]
    for i in range(n):
        weights, at = near[own[NEAR] + i * width :][:width], 2 * (first[own[FIRST] + i] * columns + start)
        _put_weighted(x, weights, block, at, 2 * columns)
        _put_weighted(y, weights, block, at + columns, 2 * columns)
        for d in range(len(directions)):
            _put_both(along[d * n + i], directions[d, 0], x, directions[d, 1], y)


@njit(cache=True)
def _at_nodes(result, along, entries, loaded, axes, start, half):
    """Add what forces along `axes` (e, 2) on the contact nodes of a `loaded` flank displace to these entries of
    `result`.

    `along` (d n, 2 k): by forces on flank nodes from `start` on. `half`: responding nodes before the loaded one are
    left out.
    """
    row, rows, column, columns, n = entries
    flank, near, first = loaded
    kinds, forces, values = len(along) // n, along.shape[1], along.reshape(-1)
    for node in range(flank[COUNT]):
        weights = near[flank[NEAR] + node * flank[WIDTH] :][: flank[WIDTH]]
        at = 2 * (first[flank[FIRST] + node] - start)
        for d in range(kinds):
            for i in range(node if half else 0, n):
                by_x, by_y = _weighted_by_turns(weights, values, at + (d * n + i) * forces)
                for e in range(len(axes)):
                    result[e * rows + row + node, d * columns + column + i] += axes[e, 0] * by_x + axes[e, 1] * by_y


@njit(cache=True)
def _mirror(compliance, kinds):
    """Put the half of a compliance (d n, d n) whose columns are of earlier nodes than its rows into place."""
    n = len(compliance) // kinds
    for node in range(n):
        for d in range(kinds):
            for e in range(kinds):
                for other in range(node if e == d else node + 1):
                    compliance[d * n + node, e * n + other] = compliance[e * n + other, d * n + node]


@njit(cache=True)
def _put_weighted(total, weights, values, first, step):
    """Put into place the sum of the weights times as many rows of values, which begin at the `first` and every `step`
    from there on."""
    total[:] = 0.0
    last, size = len(weights) - 1, len(total)
    for k in range(0, last + 1, 4):
        # Four at a time, so that sums are read and written once for all; those beyond the last weigh nothing.
        two, three, four = min(k + 1, last), min(k + 2, last), min(k + 3, last)
        _add_four(
            total,
            (weights[k], weights[two], weights[three], weights[four]),
            min(last - k, 3),
            values[first + k * step :][:size], values[first + two * step :][:size],
            values[first + three * step :][:size], values[first + four * step :][:size],
        )  # fmt: skip


@njit(cache=True)
def _add_four(total, weights, more, one, two, three, four):
    """Add the first weight times `one`, and of the others `more`."""
    a, b, c, d = weights[0], weights[1], weights[2], weights[3]
    b, c, d = b if more > 0 else 0.0, c if more > 1 else 0.0, d if more > 2 else 0.0
    # A function of its own: so the loop is compiled for several numbers at a time.
    for i in range(len(total)):
        total[i] = total[i] + a * one[i] + b * two[i] + c * three[i] + d * four[i]


@njit(cache=True)
def _put_both(total, a, one, b, other):
    """Put a times `one` and b times `other` into place."""
    for i in range(len(total)):
        total[i] = a * one[i] + b * other[i]


@njit(cache=True)
def _weighted_by_turns(weights, values, first):
    """Sums of the weights times every second value from the `first` on, and times those between."""
    # Two weights at a time, which do not wait for each other; uint64 avoids numba's wraparound check.
    a, b, c, d = 0.0, 0.0, 0.0, 0.0
    one, two, three, four = np.uint64(1), np.uint64(2), np.uint64(3), np.uint64(4)
    at, k, size = np.uint64(first), np.uint64(0), np.uint64(len(weights))
    while k + one < size:
        weight, next_weight = weights[k], weights[k + one]
        a, b = a + weight * values[at], b + weight * values[at + one]
        c, d = c + next_weight * values[at + two], d + next_weight * values[at + three]
        at, k = at + four, k + two
    if k < size:
        a, b = a + weights[k] * values[at], b + weights[k] * values[at + one]
    return a + c, b + d


@njit(cache=True)
def add_multiple(total, weight, values, first):
    """Add weight times the values from `first` on."""
    # uint64 avoids numba's wraparound check, in a function of its own: so the loop is compiled for several numbers at a
    # time.
    first = np.uint64(first)
    for i in range(len(total)):
        total[i] += weight * values[first + np.uint64(i)]


@njit(cache=True)
def subtract_displaced(displaced, forces, rows, first):
    """Subtract what forces (m,) displace, by rows (m, n) of a symmetric compliance, or columns, from the place `first`
    of each on; only loaded nodes are summed, whose rows alone are there."""
    # By four at a time: numbers come from memory in twice the time where it has one row to bring ahead.
    one, two, three, four, count = 0, 0, 0, 0, 0
    for j in range(len(forces)):
        if forces[j] != 0.0:
            one, two, three, four = two, three, four, j
            count += 1
            if count % 4 == 0:
                _subtract_four(
                    displaced, (forces[one], forces[two], forces[three], forces[four]), rows[one, first:],
                    rows[two, first:], rows[three, first:], rows[four, first:],
                )  # fmt: skip
    if count % 4 > 2:
        add_multiple(displaced, -forces[two], rows[two], first)
    if count % 4 > 1:
        add_multiple(displaced, -forces[three], rows[three], first)
    if count % 4 > 0:
        add_multiple(displaced, -forces[four], rows[four], first)


@njit(cache=True)
def _subtract_four(displaced, forces, one, two, three, four):
    for i in range(np.uint64(len(displaced))):
        part = displaced[i] - forces[0] * one[i] - forces[1] * two[i]
        displaced[i] = part - forces[2] * three[i] - forces[3] * four[i]
