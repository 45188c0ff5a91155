"""Frictionless contact without tension by a primal-dual active set."""

import numpy as np
from scipy.linalg import cho_factor, cho_solve

MOST_STEPS = 200


def pressed(compliance: np.ndarray, gaps: np.ndarray, areas: np.ndarray, force: float) -> tuple[np.ndarray, float]:
    """Pressures (k,), MPa, and approach (mm, along n) of a `force` (N); compliance (k, k), gaps, areas (k,) of
    `contact_points`: on closed nodes compliance p + gaps = approach areas. Raises RuntimeError where the sets do not
    settle."""
    closed = gaps / areas <= np.quantile(gaps / areas, 0.3)
    pressure = np.zeros(len(gaps))
    seen = set()
    for _ in range(MOST_STEPS):
        on = np.flatnonzero(closed)
        factor = cho_factor(compliance[np.ix_(on, on)])
        from_gap, from_approach = cho_solve(factor, gaps[on]), cho_solve(factor, areas[on])
        approach = (force + areas[on] @ from_gap) / (areas[on] @ from_approach)
        pressure[:] = 0.0
        pressure[on] = approach * from_approach - from_gap
        opened = (compliance @ pressure + gaps - approach * areas) / areas
        wrong = np.where(closed, pressure < 0.0, opened < -1e-12)
        if not wrong.any():
            return pressure, float(approach)
        key = closed.tobytes()
        if key in seen:
            # The sets go round in a circle: one change at a time ends it (Murty's rule).
            wrong &= np.arange(len(wrong)) == np.flatnonzero(wrong).max()
        seen.add(key)
        closed = closed ^ wrong
    raise RuntimeError(
        f"contact did not settle in {MOST_STEPS} steps: {int(wrong.sum())} of {len(wrong)} nodes are still wrong"
    )
