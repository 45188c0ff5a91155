"""The laws [9], [11], [25] written out."""

import numpy as np


def law_residual(
    forces: np.ndarray, displacement: np.ndarray, gap: np.ndarray, slip_before: np.ndarray | None, friction: float
) -> dict[str, float]:
    """Penetration and stick slip (mm), tension and cone excess (N). `forces`, `displacement` (m,): normals, then
    tangents with friction; `slip_before` (n,): w_old of [25], mm, or None."""
    n = len(gap)
    normal, opening = forces[:n], gap - displacement[:n]
    residual = {
        "penetration": float(np.max(-opening, initial=0.0)),
        "tension": float(np.max(-normal, initial=0.0)),
        "force_across_gap": float(np.max(np.where(opening > 0.0, np.abs(normal) * opening, 0.0), initial=0.0)),
    }
    if slip_before is not None:
        tangential, slip = forces[n:], displacement[n:] + slip_before
        limit = friction * np.maximum(normal, 0.0)
        inside = np.abs(tangential) < limit * (1.0 - 1e-9)
        residual["cone_excess"] = float(np.max(np.abs(tangential) - limit, initial=0.0))
        residual["stick_slip"] = float(np.max(np.where(inside, np.abs(slip), 0.0), initial=0.0))
        residual["wrong_way"] = float(np.max(-tangential * slip, initial=0.0))
    return residual
