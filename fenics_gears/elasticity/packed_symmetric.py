"""Symmetric matrices without their lower triangles, for files."""

from __future__ import annotations

import numpy as np
from scipy.linalg.lapack import dtpttr, dtrttp


def packed(matrices: np.ndarray) -> np.ndarray:
    """The upper triangles (k, n (n + 1) / 2) of symmetric matrices (k, n, n), column by column."""
    # LAPACK wants columns in a row, which the transposes of these matrices have.
    return np.stack([dtrttp(matrix.T)[0] for matrix in matrices])


def unpacked(triangles: np.ndarray) -> np.ndarray:
    """The symmetric matrices (k, n, n), bit for bit, of what `packed` gave.

    >>> unpacked(packed(np.array([[[1.0, 2.0], [2.0, 5.0]]]))).tolist()
    [[[1.0, 2.0], [2.0, 5.0]]]
    """
    size = int(np.sqrt(2 * triangles.shape[1]))
    result = np.empty((len(triangles), size, size))
    lower = np.tri(size, k=-1, dtype=bool)
    for matrix, triangle in zip(result, triangles):
        matrix[:] = dtpttr(size, triangle)[0]
        np.copyto(matrix, matrix.T.copy(), where=lower)
    return result
