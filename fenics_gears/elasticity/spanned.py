"""Matrices of low rank by fewer columns."""

import numpy as np

# Part of a matrix that its columns may miss.
MISSING = 1e-10
# Random columns that tell what is missing.
TRIED = 8


def spanned(matrix: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Orthonormal columns (n, r), and what they are multiplied by (r, k), to give a matrix (n, k) but for a part of
    MISSING.

    Products of the matrix with random columns span its range (Halko, Martinsson, Tropp 2011); others tell what is
    missing.
    """
    # The same numbers in every run.
    generator = np.random.default_rng(0)
    most = min(matrix.shape)
    tried = generator.standard_normal((matrix.shape[1], TRIED))
    images = matrix @ tried
    columns = np.empty((len(matrix), 0))
    rows = np.empty((0, matrix.shape[1]))
    size = max(most // 4, 1)
    while columns.shape[1] + size < most:
        more = matrix @ generator.standard_normal((matrix.shape[1], size))
        for _ in range(2):
            more -= columns @ (columns.T @ more)
        more = np.linalg.qr(more)[0]
        columns = np.hstack([columns, more])
        rows = np.vstack([rows, more.T @ matrix])
        missing = np.linalg.norm(images - columns @ (rows @ tried), axis=0)
        if missing.max() <= MISSING * np.linalg.norm(images, axis=0).max():
            return columns, rows
        size = max(most // 40, 1)
    return np.eye(len(matrix)), matrix
