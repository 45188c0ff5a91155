"""A swept tooth sector folded along its tooth's centreline: two bodies of half its size that have nothing to do with
each other.

Theorem. Let H be half a turn about the tooth's centreline at mid-width: it exchanges the flanks and the cuts, and takes
z to -z; on motions it is an involution, H H = 1. Where the section is symmetric about the centreline, and the layers
are alike towards both end faces, H maps the sector on itself, whatever its twist. Its stiffness K then commutes with H.

Here: each motion u is the sum of an even one, H u = u, and of an odd one, H u = -u; K couples none of one kind with one
of the other, and either kind is given by its values on the drive flank's half: with u there, a node's image moves as
``s M u``, s = 1 or -1, with M the reflection at the centreline and at mid-width. In the ring (`half_turn`): the
harmonics of its cuts become real.
"""

import numpy as np
from scipy import sparse
from scipy.spatial import cKDTree

from fenics_gears.errors import ComputationError

from ..condensation import by_radius, dofs_of, line_of
from ..mesh_data import BodyMesh
from .layers import swept_nodes
from .swept_stiffness import ELEMENT

EVEN, ODD = 1.0, -1.0


class Fold:
    """Which nodes of a swept sector stand for all of them, hub held, and how the others follow.

    nodes: (n, 2), of the section; height by height they are the sector's. unknowns: dofs of the nodes kept, 3 each: of
    the drive flank's side, and at the section's centreline from mid-width on. flank, cut: dofs (f,), (c,) of the drive
    flank's and the upper cut's nodes in the half, by height, then radius. on_cut: which nodes of the section's cut at
    all heights these are. lines: the section's places (k, 2) of both; hub: (h, 2), held. axes: (3, 3), columns along
    the centreline, across it and along z; across: (2,), towards the drive flank. cut_turned, flank_turned: sparse (c,
    c), (f, f), from motions of the upper cut and the drive flank to those of the lower cut and the coast flank, their
    images.
    """

    def __init__(self, mesh: BodyMesh, nodes: np.ndarray, material: np.ndarray, centreline: float):
        """material: (h, n), which of the section's nodes there are at each height. centreline: polar angle (rad) of the
        tooth's centreline. Raises ComputationError for a section that is not symmetric about it."""
        self.nodes, self.heights = nodes, len(material)
        heights = self.heights
        along = np.array([np.cos(centreline), np.sin(centreline)])
        # Along the centreline a displacement keeps its sign, across it and along z it changes.
        self._mirror, self.axes = np.diag([0.0, 0.0, -1.0]), np.eye(3)
        self._mirror[:2, :2] = 2.0 * np.outer(along, along) - np.eye(2)
        self.axes[:2, :2] = [[along[0], -along[1]], [along[1], along[0]]]
        distance, image = cKDTree(nodes).query(nodes @ self._mirror[:2, :2])
        if distance.max() > 1e-9 * np.abs(nodes).max():
            raise ComputationError("swept sector: its section is not symmetric about the tooth's centreline")
        flank, hub = (mesh.edge_nodes(name, ELEMENT.order) for name in ("flank", "hub"))
        self.lines, self.hub = (by_radius(flank), line_of(mesh, "upper cut", ELEMENT.order)), hub
        self.across = self.axes[:2, 1] * np.sign((flank @ self.axes[:2, 1]).sum())
        side = nodes @ self.across
        own = np.arange(len(nodes))
        held = np.isin(own, swept_nodes(nodes, hub, 1))
        kept = np.where(image == own, np.arange(heights)[:, None] >= heights // 2, side > 0.0) & ~held & material
        self.unknowns, number = 3 * int(kept.sum()), np.cumsum(kept.ravel()) - 1
        swept = [swept_nodes(nodes, line, heights) for line in self.lines]
        there = [material.ravel()[numbers] for numbers in swept]
        self.on_cut = there[1]
        self.flank, self.cut = (dofs_of(number[numbers[own]], 3) for numbers, own in zip(swept, there))
        self.flank_turned, self.cut_turned = map(self._turned, there)

    def _turned(self, there: np.ndarray) -> sparse.csr_matrix:
        """there: which nodes of a line at all heights there are."""
        line = len(there) // self.heights
        height, place = np.divmod(np.flatnonzero(there), line)
        order = dofs_of((np.cumsum(there) - 1)[line * (self.heights - 1 - height) + place], 3)
        return sparse.kron(sparse.eye(len(height)), self._mirror, format="csr")[order]
