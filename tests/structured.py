"""Points that stand in rows and columns."""

import numpy as np


def cells_of(index: np.ndarray, corners: int = 4) -> np.ndarray:
    """Of the points' numbers (m, n): quadrilaterals, or twice as many triangles."""
    sides = index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]
    cells = np.stack([each.ravel() for each in sides], axis=-1)
    return cells if corners == 4 else np.vstack([cells[:, [0, 1, 2]], cells[:, [0, 2, 3]]])
