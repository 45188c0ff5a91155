"""The stiffness of the mesh at a step, from its contact solution.

Deflection delta (mm): by how much the undeformed flanks would overlap along the line of action, that is the transmission error of the teeth
beyond that of rigid flanks. Secant stiffness F/delta (N/mm) is the mesh stiffness of ISO 6336-1, load over deformation; the tangent dF/ddelta
is the spring that small vibrations meet: the closed contact nodes stay closed and friction forces stay as they are.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from fenics_gears.contact.ladder import StepSolution
from fenics_gears.contact.laws import OPEN
from fenics_gears.contact.operator import ContactOperator


@dataclass(frozen=True)
class MeshStiffness:
    """Of the flanks, drive or coast, that carry more: `force` N, `deflection` mm, `secant` and `tangent` N/mm, number of `pairs` that carry.

    All are zero where nothing touches.
    """

    force: float
    deflection: float
    secant: float
    tangent: float
    pairs: int


NOTHING_TOUCHES = MeshStiffness(0.0, 0.0, 0.0, 0.0, 0)


def mesh_stiffness(operator: ContactOperator, solution: StepSolution) -> MeshStiffness:
    """The mesh stiffness at a step; only of flanks that are elastic."""
    forces, closed, drive = solution.forces[: operator.nodes], solution.status != OPEN, operator.on_drive_flanks
    on_side = drive if forces @ drive >= forces @ ~drive else ~drive
    nodes = np.flatnonzero(closed & on_side)
    force = float(forces[nodes].sum())
    if force <= 0.0:
        return NOTHING_TOUCHES
    overlap = operator.rigid[: operator.nodes] @ solution.coordinates - operator.gap
    deflection = float(overlap[on_side].max())
    pairs = len(np.unique(operator.node_pair[nodes[forces[nodes] > 0.0]]))
    return MeshStiffness(force, deflection, force / deflection, _tangent(operator.compliance[np.ix_(nodes, nodes)]), pairs)


def _tangent(compliance: np.ndarray) -> float:
    """Force (N) by which nodes of a compliance (n, n), mm/N, answer when all approach by 1 mm."""
    ones = np.ones(len(compliance))
    return float(ones @ cho_solve(cho_factor(compliance, lower=True, check_finite=False), ones, check_finite=False))
