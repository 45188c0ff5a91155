"""The stiffness of the mesh at a step, from its contact solution.

Deflection delta (mm): overlap of the undeformed flanks along the line of action, that is the transmission error of the
teeth beyond that of rigid flanks. Secant stiffness F/delta (N/mm) is the mesh stiffness of ISO 6336-1, load over
deformation; the tangent dF/ddelta is the spring that small vibrations meet: the closed contact nodes stay closed and
friction forces stay as they are.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from fenics_gears.contact.laws import NO_FORCE, OPEN
from fenics_gears.contact.mixed_form import product, solved, system_of


@njit(cache=True)
def mesh_stiffness(contact, status, forces, coordinates):
    """Secant and tangent stiffness, N/mm, of the drive or coast flanks, whichever carry more, and how many tooth pairs
    carry there.

    `contact`: the `addresses.Arrays` of elastic flanks; others as of StepSolution. All zero where nothing touches.
    """
    # Taken out of the record once: in a loop that would cost more than the numbers.
    jacobian, gap, on_drive_flanks, node_pair = (
        contact.jacobian, contact.gap, contact.on_drive_flanks, contact.node_pair,
    )  # fmt: skip
    n, drive, whole = len(gap), 0.0, 0.0
    for node in range(n):
        whole += forces[node]
        drive += forces[node] if on_drive_flanks[node] else 0.0
    side = 2.0 * drive >= whole
    closed, count, force, pairs, last = np.empty(n, dtype=np.int64), 0, 0.0, 0, -1
    for node in range(n):
        if status[node] != OPEN and on_drive_flanks[node] == side:
            closed[count], count, force = node, count + 1, force + forces[node]
            if forces[node] > 0.0 and node_pair[node] != last:
                pairs, last = pairs + 1, node_pair[node]
    if force <= NO_FORCE:
        return np.zeros(3)
    overlap = np.full(n, -np.inf)
    for node in range(n):
        if on_drive_flanks[node] == side:
            overlap[node] = product(jacobian[node], coordinates) - gap[node]
    deflection = _highest(overlap, node_pair)
    # Of a gear so heavy that it does not move, the deflection is below the last digit of its rotation.
    secant = force / deflection if deflection > 0.0 else np.nan
    return np.array([secant, _tangent(contact.compliance, closed[:count]), pairs])


@njit(cache=True)
def _highest(overlap, node_pair):
    """Largest overlap (mm) of flanks with overlaps (n,) at evenly spaced nodes: vertex of the parabola through the
    largest and its neighbours.

    The deepest overlap lies between two nodes as a rule; at nodes alone it would be too small by up to spacing^2/(8
    rho).
    """
    top = np.argmax(overlap)
    at = overlap[top]
    if top == 0 or top == len(overlap) - 1 or not node_pair[top - 1] == node_pair[top] == node_pair[top + 1]:
        return at
    before, after = overlap[top - 1], overlap[top + 1]
    bend = 2.0 * at - before - after
    return at + (after - before) ** 2 / (8.0 * bend) if bend > 0.0 else at


@njit(cache=True)
def _tangent(compliance, nodes):
    """Force (N) on some nodes of a compliance (m, m), mm/N, when all of them approach by 1 mm."""
    matrix = system_of(len(nodes))
    for i in range(len(nodes)):
        for j in range(len(nodes)):
            matrix[i, j] = compliance[nodes[i], nodes[j]]
    return solved(matrix, np.ones(len(nodes)), len(nodes)).sum()
