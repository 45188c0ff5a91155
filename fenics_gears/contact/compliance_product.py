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
def compliance_product(
    block, weights_a, first_a, last_a, directions_a, weights_b, first_b, last_b, directions_b, result
):
    """Add `N_a A N_b^T` to `result` (directions_a, n_a, directions_b, n_b), mm per N/mm.

    `block` (2n, 2n): displacement of the flank of tooth a due to forces on the flank of tooth b; `weights_*`,
    `first_*`, `last_*`: a FlankInterpolation; `directions_*` (d, 2): the directions in either tooth's frame.
    """
    n_a, n_b = len(first_a), len(first_b)
    if n_a == 0 or n_b == 0:
        return
    start, end = 2 * first_b.min(), 2 * last_b.max()
    along_x, along_y, along = np.empty(end - start), np.empty(end - start), np.empty(end - start)
    for i in range(n_a):
        along_x[:] = 0.0
        along_y[:] = 0.0
        for node in range(first_a[i], last_a[i]):
            weight, row_x, row_y = weights_a[i, node], block[2 * node], block[2 * node + 1]
            for column in range(start, end):
                along_x[column - start] += weight * row_x[column]
                along_y[column - start] += weight * row_y[column]
        for d in range(len(directions_a)):
            for column in range(end - start):
                along[column] = directions_a[d, 0] * along_x[column] + directions_a[d, 1] * along_y[column]
            for j in range(n_b):
                total_x, total_y = 0.0, 0.0
                for node in range(first_b[j], last_b[j]):
                    total_x += weights_b[j, node] * along[2 * node - start]
                    total_y += weights_b[j, node] * along[2 * node + 1 - start]
                for e in range(len(directions_b)):
                    result[d, i, e, j] += directions_b[e, 0] * total_x + directions_b[e, 1] * total_y
