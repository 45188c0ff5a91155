"""Cracks in a meshed body: sides of its boundary that lie on each other, and the nodes that face each other there."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from fenics_gears.elasticity.element_nodes import ElementNodes


@dataclass(frozen=True)
class CrackNodes:
    """Nodes (k,) on one face of a body's cracks, those that face them (k,), and the normals (k, 2) out of the first face.

    The faces stand apart by (u[other] - u[one]) . normal, negative where they would pass through each other.
    """

    one: np.ndarray
    other: np.ndarray
    normals: np.ndarray

    @property
    def both(self) -> np.ndarray:
        """All of them, ascending."""
        return np.unique(np.concatenate([self.one, self.other]))


def crack_nodes(nodes: ElementNodes) -> CrackNodes:
    """The facing nodes of all cracks of a body; a tip belongs to both faces and is left out."""
    sides = nodes.boundary_sides
    ends = nodes.points[sides[:, :2]]
    tolerance = 1e-9 * np.abs(nodes.points).max()
    pairs = cKDTree(ends.mean(axis=1)).query_pairs(tolerance, output_type="ndarray").reshape(-1, 2)
    one, other = sides[pairs[:, 0]], sides[pairs[:, 1]]
    # Cells go counter-clockwise: along a side the body is on the left, and both faces run against each other.
    other = other[:, [1, 0, *range(2, other.shape[1])]]
    along = ends[pairs[:, 0], 1] - ends[pairs[:, 0], 0]
    normals = np.stack([along[:, 1], -along[:, 0]], axis=-1) / np.linalg.norm(along, axis=1)[:, None]
    normals = np.repeat(normals, one.shape[1], axis=0)
    one, other = one.ravel(), other.ravel()
    apart = one != other
    return CrackNodes(one[apart], other[apart], normals[apart])
