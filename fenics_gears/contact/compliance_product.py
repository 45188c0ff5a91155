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


@njit(cache=True, fastmath=False)
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
    column_start, column_end = first_b.min(), last_b.max()
    response = np.zeros((2, column_end - column_start))
    for i in range(n_a):
        for d in range(len(directions_a)):
            response[:] = 0.0
            for node in range(first_a[i], last_a[i]):
                along_x = weights_a[i, node] * directions_a[d, 0]
                along_y = weights_a[i, node] * directions_a[d, 1]
                for column in range(column_start, column_end):
                    for component in range(2):
                        response[component, column - column_start] += (
                            along_x * block[2 * node, 2 * column + component]
                            + along_y * block[2 * node + 1, 2 * column + component]
                        )
            for e in range(len(directions_b)):
                for j in range(n_b):
                    total = 0.0
                    for column in range(first_b[j], last_b[j]):
                        total += weights_b[j, column] * (
                            directions_b[e, 0] * response[0, column - column_start]
                            + directions_b[e, 1] * response[1, column - column_start]
                        )
                    result[d, i, e, j] += total
