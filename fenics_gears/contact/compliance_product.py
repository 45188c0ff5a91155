"""The flank compliance seen by contact nodes: `N A N^T`, in the directions of the line of action (compiled)."""

from __future__ import annotations

import math

import numpy as np
from numba import njit


def directions(contact_roll: float, tangential: bool) -> np.ndarray:
    """Unit vectors e_x (and e_y), (1 or 2, 2), in the frame of a tooth that touches at `contact_roll` (rad)."""
    cosine, sine = math.cos(contact_roll), math.sin(contact_roll)
    normal = [cosine, -sine]
    return np.array([normal, [sine, cosine]] if tangential else [normal])


@njit(cache=True)
def compliance_product(block, responding, now, compliance, before, previous_compliance):
    """Add `N_a A N_b^T` of the contact nodes a of a flank and those b of another to compliances between all contact
    nodes, mm per N/mm.

    `block` (2n, 2n): displacement of the flank of a due to forces on the flank of b. `responding`: place of the first
    node of a among all, `near` and `first` of its FlankInterpolation, directions (d, 2) in the tooth's frame. `now`:
    the same of b; `before`: of b as it stood a step before. `compliance` (d, n, d, n): first d of the directions of a,
    nodes of b that come after those of a left out; `previous_compliance` (1, n, 2, n before): the direction that
    follows.
    """
    row, near, first, directions = responding
    start, end = block.shape[1] // 2, 0
    for loaded in (now, before):
        for begin in loaded[2]:
            start, end = min(start, begin), max(end, begin + loaded[1].shape[1])
    # A number that is written out in the call has it compiled once more.
    none = np.int64(0)
    kinds, forces, numbers = len(compliance), 2 * (end - start), block.reshape(-1)
    x, y, along = np.empty(forces), np.empty(forces), np.zeros((len(directions), len(near), forces))
    for i in range(len(near)):
        x[:], y[:] = 0.0, 0.0
        for node in range(near.shape[1]):
            at = 2 * (first[i] + node) * block.shape[1] + 2 * start
            add_multiple(x, near[i, node], numbers, at)
            add_multiple(y, near[i, node], numbers, at + block.shape[1])
        for d in range(len(directions)):
            add_multiple(along[d, i], directions[d, 0], x, none)
            add_multiple(along[d, i], directions[d, 1], y, none)
    _at_nodes(along[:kinds], start, row, now, compliance, True)
    _at_nodes(along[kinds:], start, row, before, previous_compliance, False)


@njit(cache=True)
def add_multiple(total, weight, values, first):
    """Add weight times the values from `first` on."""
    # A function of its own, and unsigned places (no look for a negative index): so the loop is compiled for several
    # numbers at a time.
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


@njit(cache=True)
def _at_nodes(along, start, row, loaded, result, symmetric):
    """Add displacements `along` directions (d, n, 2 k), by x and y of each flank node from `start` on, to rows of
    `result` (d, n, e, m) from `row` on.

    Where it is symmetric, only nodes up to the row's own, and what follows from them.
    """
    zero, one, two, row, column = np.uint64(0), np.uint64(1), np.uint64(2), np.uint64(row), np.uint64(loaded[0])
    _, near, first, directions = loaded
    for i in range(np.uint64(along.shape[1])):
        place = row + i
        nodes = min(np.uint64(len(near)), place + one - column) if symmetric else np.uint64(len(near))
        for node in range(nodes):
            at, other = two * np.uint64(first[node] - start), column + node
            for d in range(np.uint64(len(along))):
                by_x, by_y = 0.0, 0.0
                for k in range(np.uint64(near.shape[1])):
                    by_x += near[node, k] * along[d, i, at + two * k]
                    by_y += near[node, k] * along[d, i, at + two * k + one]
                for e in range(np.uint64(len(directions))):
                    value = directions[e, zero] * by_x + directions[e, one] * by_y
                    result[d, place, e, other] += value
                    if symmetric and other != place:
                        result[e, other, d, place] += value
