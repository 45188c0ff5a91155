"""Signorini's and Coulomb's laws at a contact node, as projections [24], [25], and the tolerance of a solution."""

from __future__ import annotations

from dataclasses import dataclass

from numba import njit

# States of a contact node. Without friction a closed node counts as SLIP_FORWARD: it carries no tangential force.
OPEN, SLIP_FORWARD, SLIP_BACKWARD, STICK = 0, 1, 2, 3
# N. Without a load closed nodes carry round-off, below this.
NO_FORCE = 1e-9
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
        """The tolerance for a transmitted force F = T/rb2 (N): 1e-4 um and 1e-6 F, at least 5e-9 N, which is above the
        round-off of stiff springs."""
        return cls(length=1e-7, force=1e-6 * max(transmitted_force, 5e-3))


@njit(cache=True)
def presses(closed, normal, u_n, gap):
    """Whether the normal force that is projected [24] is positive, else a node opens: an open node has no force and a
    closed one no gap, so that the projection's `r` does not decide."""
    return normal > 0.0 if closed else u_n > gap


@njit(cache=True)
def next_status(status, normal, pressed, frictional, trial, friction, through_stick):
    """The status that the projections give a node whose normal force is `normal`, whether it is `pressed`, and whose
    tangential one `trial`; with `through_stick` a reversal of slip stops at stick first."""
    if not pressed:
        return OPEN
    if not frictional:
        return SLIP_FORWARD
    if abs(trial) <= friction * max(normal, 0.0):
        return STICK
    wanted = SLIP_FORWARD if trial > 0.0 else SLIP_BACKWARD
    if through_stick and status != OPEN and status != STICK and status != wanted:
        return STICK
    return wanted
