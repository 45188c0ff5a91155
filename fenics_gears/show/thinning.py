"""Long curves with fewer points and all their peaks."""

from __future__ import annotations

import numpy as np

# As many as a screen tells apart, and few enough to keep some twenty curves of a page below 10 MB.
MOST_POINTS = 2000


def thinned(values: np.ndarray, most: int = MOST_POINTS) -> np.ndarray:
    """Places (k,) of the values (n,) that a curve is drawn through: all of them up to `most`; beyond, of each of most/2
    slices the smallest and the largest value, and a place that is not a number where there is one, so that gaps stay;
    both ends of the curve."""
    count = len(values)
    if count <= most:
        return np.arange(count)
    width = -(-count // (most // 2))
    padded = np.concatenate([values, np.full(-count % width, values[-1])]).reshape(-1, width)
    missing = np.isnan(padded)
    lowest = np.where(missing, np.inf, padded).argmin(axis=1)
    highest = np.where(missing, -np.inf, padded).argmax(axis=1)
    first = width * np.arange(len(padded))
    gaps = (first + missing.argmax(axis=1))[missing.any(axis=1)]
    places = np.concatenate([first + lowest, first + highest, gaps, [0, count - 1]])
    return np.unique(np.minimum(places, count - 1))
