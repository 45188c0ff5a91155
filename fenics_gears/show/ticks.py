"""Round numbers along an axis, and how they are written."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.ticker import LogLocator, MaxNLocator


def ticks(ends: Sequence[float], most: float, logarithmic: bool = False) -> np.ndarray:
    """Round numbers (n,) between an axis' ends."""
    low, high = sorted(ends)
    if logarithmic:
        places, beyond = LogLocator(subs=(1.0,) if high > 100.0 * low else (1.0, 2.0, 5.0)).tick_values(low, high), 0.0
    else:
        places, beyond = (
            MaxNLocator(max(2, min(10, int(most))), steps=[1, 2, 2.5, 5, 10]).tick_values(low, high),
            1e-9 * (high - low),
        )
    return places[(places >= low - beyond) & (places <= high + beyond)]


def written(places: np.ndarray, logarithmic: bool = False) -> list[str]:
    """Numbers with as many decimals as the finest of them needs; with powers of ten where they are large or small."""
    if logarithmic or len(places) < 2 or not 1e-4 <= np.abs(places).max() < 1e6:
        words = [f"{place:g}" for place in places]
    else:
        step = places[1] - places[0]
        decimals = next(count for count in range(12) if np.abs(np.round(places, count) - places).max() < 1e-3 * step)
        words = [f"{place:.{decimals}f}" for place in np.round(places, decimals) + 0.0]
    return [each.replace("-", "−") for each in words]
