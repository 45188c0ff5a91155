"""Signorini's and Coulomb's laws at a contact node, as projections [24], [25]; by how much an iterate violates them and
equilibrium, and what is tolerated."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

# States of a contact node. Without friction a closed node counts as SLIP_FORWARD: it carries no tangential force.
OPEN, SLIP_FORWARD, SLIP_BACKWARD, STICK = 0, 1, 2, 3
# N. Without a load closed nodes carry round-off, below this.
NO_FORCE = 1e-9
STATUS_NAMES = ("open", "slips forward", "slips backward", "sticks")


class Tolerance(NamedTuple):
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


ROUND_OFF = 1e-12


PENETRATION, TENSION, CONE_EXCESS, STICK_SLIP, EQUILIBRIUM = range(5)


RESIDUAL_NAMES = ("penetration", "tension", "cone excess", "stick slip", "equilibrium")


RESIDUAL_UNITS = ("mm", "N", "N", "mm", "N")


@njit(cache=True, error_model="numpy")
def _force_round_off(equations, coordinates):
    """Round-off (N) of the forces: that of the load, and that of the lengths times the stiffnesses of springs and
    teeth."""
    stiffness, load, gap = equations.stiffness, equations.load, equations.gap
    largest_load, largest_spring, length = 0.0, 0.0, 0.0
    for c in range(len(load)):
        spring = 0.0
        for d in range(len(load)):
            spring += abs(stiffness[c, d] * coordinates[d])
        largest_load, largest_spring = max(largest_load, abs(load[c])), max(largest_spring, spring)
        length = max(length, abs(coordinates[c]))
    terms = largest_load + largest_spring
    if len(gap):
        for each in gap:
            length = max(length, abs(each))
        terms += 1e-2 * length / equations.compliance[0, 0]
    return ROUND_OFF * terms


@njit(cache=True)
def measure(residual, equations, iterate):
    """Violation of the laws and of equilibrium by an iterate, into `residual` (5,).

    Equilibrium is solved, not iterated: a residual within the round-off of a row's terms is no violation. A slip
    against its friction counts in proportion to that friction, as far as it exceeds the round-off of the forces.
    """
    _, load, _, _, gap, slip_before, friction, _, _, _ = equations
    status, forces, coordinates, displacement = iterate
    n, penetration, tension, excess, stick_slip = len(gap), 0.0, 0.0, 0.0, 0.0
    for j in range(n):
        penetration, tension = max(penetration, displacement[j] - gap[j]), max(tension, -forces[j])
    if len(slip_before):
        negligible = ROUND_OFF + _force_round_off(equations, coordinates) if len(load) else ROUND_OFF
        for j in range(n):
            excess = max(excess, abs(forces[n + j]) - friction * max(forces[j], 0.0))
            slip = displacement[n + j] + slip_before[j]
            against = forces[n + j] * slip < 0.0 and abs(forces[n + j]) > negligible
            if status[j] == STICK or status[j] != OPEN and against:
                stick_slip = max(stick_slip, abs(slip))
    residual[PENETRATION], residual[TENSION], residual[CONE_EXCESS] = penetration, tension, excess
    residual[STICK_SLIP], residual[EQUILIBRIUM] = stick_slip, _imbalance(equations, iterate)


@njit(cache=True)
def _imbalance(equations, iterate):
    """The largest force (N) by which a centre coordinate is out of equilibrium, beyond the round-off of its terms."""
    stiffness, load, jacobian = equations.stiffness, equations.load, equations.jacobian
    forces, coordinates, largest = iterate.forces, iterate.coordinates, 0.0
    balance = np.empty((2, len(load)))
    for c in range(len(load)):
        total, terms = -load[c], abs(load[c])
        for d in range(len(load)):
            term = stiffness[c, d] * coordinates[d]
            total, terms = total + term, terms + abs(term)
        balance[0, c], balance[1, c] = total, terms
    for i in range(len(forces)):
        force = forces[i]
        if force != 0.0:
            for c in range(len(load)):
                term = jacobian[i, c] * force
                balance[0, c] += term
                balance[1, c] += abs(term)
    for c in range(len(load)):
        largest = max(largest, abs(balance[0, c]) - ROUND_OFF * balance[1, c])
    return largest


@njit(cache=True)
def within(residual, equations, coordinates):
    """Whether a residual (5,) is within the tolerances of the equations, or round-off."""
    # Equilibrium is solved, not iterated: only the round-off of its largest terms may be left. A gap is a difference of
    # displacements and is known to their round-off only.
    longest = 0.0
    for each in coordinates:
        longest = max(longest, abs(each))
    length, force = equations.tolerance
    length += 1e-14 * longest
    return (
        residual[EQUILIBRIUM] <= 1e-2 * force + _force_round_off(equations, coordinates)
        and residual[PENETRATION] <= length
        and residual[STICK_SLIP] <= length
        and residual[TENSION] <= force
        and residual[CONE_EXCESS] <= force
    )
