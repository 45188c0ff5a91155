"""The stiffness of the mesh at a step, from its contact solution.

Deflection delta (mm): overlap of the undeformed flanks along the line of action, that is the transmission error of the teeth
beyond that of rigid flanks. Secant stiffness F/delta (N/mm) is the mesh stiffness of ISO 6336-1, load over deformation; the tangent dF/ddelta
is the spring that small vibrations meet: the closed contact nodes stay closed and friction forces stay as they are.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg.lapack import dposv

from fenics_gears.contact.laws import NO_FORCE, OPEN
from fenics_gears.contact.operator import ContactOperator
from fenics_gears.contact.step_solver import StepSolution


@dataclass(frozen=True)
class MeshStiffness:
    """Of the drive or coast flanks, whichever carry more: `force` N, `deflection` mm, `secant` and `tangent` N/mm, number of loaded `pairs`.

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
    forces, drive = solution.forces[: operator.nodes], operator.on_drive_flanks
    on_side = drive if 2.0 * forces.dot(drive) >= forces.sum() else ~drive
    nodes = (on_side & (solution.status != OPEN)).nonzero()[0]
    force = float(forces[nodes].sum())
    if force <= NO_FORCE:
        return NOTHING_TOUCHES
    overlap = operator.jacobian[: operator.nodes] @ solution.coordinates - operator.gap
    deflection = _highest(np.where(on_side, overlap, -np.inf), operator.node_pair)
    pairs = np.count_nonzero(np.bincount(operator.node_pair[nodes], forces[nodes]))
    return MeshStiffness(force, deflection, force / deflection, _tangent(operator.compliance, nodes), pairs)


def _highest(overlap: np.ndarray, node_pair: np.ndarray) -> float:
    """Largest overlap (mm) of flanks with overlaps (n,) at evenly spaced nodes: vertex of the parabola through the largest and its neighbours.

    The deepest overlap lies between two nodes as a rule; at nodes alone it would be too small by up to spacing^2/(8 rho).
    """
    top = int(overlap.argmax())
    if not 0 < top < len(overlap) - 1 or not node_pair[top - 1] == node_pair[top] == node_pair[top + 1]:
        return float(overlap[top])
    before, at, after = (float(value) for value in overlap[top - 1 : top + 2])
    bend = 2.0 * at - before - after
    return at + (after - before) ** 2 / (8.0 * bend) if bend > 0.0 else at


def _tangent(compliance: np.ndarray, nodes: np.ndarray) -> float:
    """Force (N) on some nodes of a compliance (m, m), mm/N, when all of them approach by 1 mm."""
    return float(dposv(compliance[nodes[:, None], nodes], np.ones(len(nodes)))[1].sum())
