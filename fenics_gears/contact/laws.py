"""Signorini's and Coulomb's laws at a contact node, as projections [24], [25], and how far a solution misses them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit

# What a contact node does. Without friction a closed node counts as SLIP_FORWARD: it carries no tangential force.
OPEN, SLIP_FORWARD, SLIP_BACKWARD, STICK = 0, 1, 2, 3
STATUS_NAMES = ("open", "slips forward", "slips backward", "sticks")


@dataclass(frozen=True)
class Tolerance:
    """When a solution counts as converged, in physical units (model.md section 4).

    `length`: penetration and stick slip, mm; `force`: tension and cone excess, and residual of equilibrium, N.
    """

    length: float = 1e-7
    force: float = 1e-6

    @classmethod
    def of_load(cls, transmitted_force: float) -> Tolerance:
        """The tolerance for a transmitted force F = T/rb2 (N): 1e-4 um and 1e-6 F, at least 1e-9 N."""
        return cls(length=1e-7, force=1e-6 * max(transmitted_force, 1e-3))


@njit(cache=True)
def project(normal, tangential, u_n, gap, slip, r_n, r_t, friction):
    """The right-hand sides of [24] and [25] for one node: (p_n, p_t) that the laws ask for."""
    pressed = max(normal + r_n * (u_n - gap), 0.0)
    limit = friction * max(normal, 0.0)
    return pressed, min(max(tangential + r_t * slip, -limit), limit)


@njit(cache=True)
def next_status(status, normal, tangential, u_n, gap, slip, r_n, r_t, friction, through_stick):
    """The status that the projections give a node; with `through_stick` a reversal of slip stops at stick first."""
    if normal + r_n * (u_n - gap) <= 0.0:
        return OPEN
    if r_t == 0.0:
        return SLIP_FORWARD
    trial, limit = tangential + r_t * slip, friction * max(normal, 0.0)
    if abs(trial) <= limit:
        return STICK
    wanted = SLIP_FORWARD if trial > 0.0 else SLIP_BACKWARD
    if through_stick and status != OPEN and status != STICK and status != wanted:
        return STICK
    return wanted


def law_residual(
    forces: np.ndarray,
    displacement: np.ndarray,
    gap: np.ndarray,
    slip_before: np.ndarray | None,
    friction: float,
) -> dict[str, float]:
    """How far a solution misses the contact laws: penetration and stick slip (mm), tension and cone excess (N).

    `forces`, `displacement` (m,): normals, then tangents with friction; `slip_before` (n,): w_old of [25], mm, or None.
    """
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
