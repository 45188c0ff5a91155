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
    """Add `N_a A N_b^T` of the contact nodes a of a flank and those b of another to compliances between all contact nodes, mm per N/mm.

    `block` (2n, 2n): displacement of the flank of a due to forces on the flank of b. `responding`: place of the first node of a among all,
    `near` and `first` of its FlankInterpolation, directions (d, 2) in the tooth's frame. `now`: the same of b; `before`: of b as it stood a step
    before. `compliance` (d, n, d, n): first d of the directions of a; `previous_compliance` (1, n, 2, n before): the one that follows.
    """
    row, near, first, directions_a = responding
    (_, _, first_now, _), (_, _, first_before, _) = now, before
    width_now, width_before = now[1].shape[1], before[1].shape[1]
    start, end = len(block) // 2, 0
    if len(first_now):
        start, end = first_now.min(), first_now.max() + width_now
    if len(first_before):
        start, end = min(start, first_before.min()), max(end, first_before.max() + width_before)
    kinds, along = len(compliance), np.empty((len(directions_a), 2 * (end - start)))
    for i in range(len(near)):
        _response(block, near[i], first[i], directions_a, start, along)
        _at_nodes(along[:kinds], start, now, compliance, row + i)
        _at_nodes(along[kinds:], start, before, previous_compliance, row + i)


@njit(cache=True)
def _response(block, near, first, directions, start, along):
    """Displacement `along` directions (d, 2) of one contact node by forces on the other flank's nodes from `start` on (d, 2 k), x and y in turn."""
    # Unsigned numbers: compiled code does not look for a negative index.
    zero, one, two, first = np.uint64(0), np.uint64(1), np.uint64(2), np.uint64(first)
    for column in range(zero, np.uint64(along.shape[1]), two):
        at = two * np.uint64(start) + column
        x_by_x, x_by_y, y_by_x, y_by_y = 0.0, 0.0, 0.0, 0.0
        for node in range(np.uint64(len(near))):
            weight, dof = near[node], two * (first + node)
            x_by_x += weight * block[dof, at]
            x_by_y += weight * block[dof, at + one]
            y_by_x += weight * block[dof + one, at]
            y_by_y += weight * block[dof + one, at + one]
        for d in range(np.uint64(len(directions))):
            along[d, column] = directions[d, zero] * x_by_x + directions[d, one] * y_by_x
            along[d, column + one] = directions[d, zero] * x_by_y + directions[d, one] * y_by_y


@njit(cache=True)
def _at_nodes(along, start, loaded, result, row):
    """Add the displacements by forces of contact nodes to a row of `result` (d, n, e, m)."""
    zero, one, two, column = np.uint64(0), np.uint64(1), np.uint64(2), np.uint64(loaded[0])
    _, near, first, directions = loaded
    for node in range(np.uint64(len(near))):
        at = two * np.uint64(first[node] - start)
        for d in range(np.uint64(len(along))):
            by_x, by_y = 0.0, 0.0
            for k in range(np.uint64(near.shape[1])):
                by_x += near[node, k] * along[d, at + two * k]
                by_y += near[node, k] * along[d, at + two * k + one]
            for e in range(np.uint64(len(directions))):
                result[d, row, e, column + node] += directions[e, zero] * by_x + directions[e, one] * by_y
