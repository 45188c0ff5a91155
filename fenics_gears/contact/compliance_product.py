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
def compliance_product(block, near_a, first_a, last_a, directions_a, near_b, first_b, last_b, directions_b, result):
    """Add `N_a A N_b^T` to `result` (directions_a, n_a, directions_b, n_b), mm per N/mm.

    `block` (2n, 2n): displacement of the flank of tooth a due to forces on the flank of tooth b; `near_*`,
    `first_*`, `last_*`: a FlankInterpolation; `directions_*` (d, 2): the directions in either tooth's frame.
    """
    n_a, n_b = len(first_a), len(first_b)
    if n_a == 0 or n_b == 0:
        return
    start, end = 2 * first_b.min(), 2 * last_b.max()
    width = end - start
    along_x, along_y = np.zeros((n_a, width)), np.zeros((n_a, width))
    for i in range(n_a):
        to_x, to_y = along_x[i], along_y[i]
        for node in range(first_a[i], last_a[i]):
            _add_rows(to_x, to_y, near_a[i, node - first_a[i]], block[2 * node, start:end], block[2 * node + 1, start:end])
    # Turned over, so that the inner loops run over neighbours in memory once more.
    along, total_x, total_y = np.empty((width, n_a)), np.empty(n_a), np.empty(n_a)
    for d in range(len(directions_a)):
        for i in range(n_a):
            for column in range(width):
                along[column, i] = directions_a[d, 0] * along_x[i, column] + directions_a[d, 1] * along_y[i, column]
        for j in range(n_b):
            total_x[:] = 0.0
            total_y[:] = 0.0
            for node in range(first_b[j], last_b[j]):
                _add_rows(total_x, total_y, near_b[j, node - first_b[j]], along[2 * node - start], along[2 * node + 1 - start])
            for e in range(len(directions_b)):
                for i in range(n_a):
                    result[d, i, e, j] += directions_b[e, 0] * total_x[i] + directions_b[e, 1] * total_y[i]


@njit(cache=True)
def _add_rows(to_x, to_y, weight, row_x, row_y):
    for i in range(len(to_x)):
        to_x[i] += weight * row_x[i]
        to_y[i] += weight * row_y[i]
