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

from __future__ import annotations

import numpy as np
from scipy import sparse
from scipy.spatial import cKDTree

from fenics_gears.elasticity.condensation import by_radius, dofs_of, without
from fenics_gears.elasticity.face.layers import swept_nodes
from fenics_gears.elasticity.face.swept_stiffness import ELEMENT
from fenics_gears.elasticity.mesh_data import BodyMesh
from fenics_gears.errors import ComputationError

EVEN, ODD = 1.0, -1.0


class Fold:
    """Which nodes of a swept sector stand for all of them, hub held, and how the others follow.

    nodes: (n, 2), of the section; height by height they are the sector's. kept: (m,), numbers of those kept: of the
    drive flank's side, and at the section's centreline from mid-width on; standing: (k,), the section's nodes some of
    which are kept. Half the unknowns are their dofs, 3 each; at mid-width on the centreline some of them are dead.
    flank, cut: dofs (f,), (c,) of the drive flank's and the upper cut's nodes in the half, by height, then radius.
    on_cut: which nodes of the section's cut at all heights these are. lines: the section's places (k, 2) of both; hub:
    (h, 2), held. axes: (3, 3), columns along the centreline, across it and along z; across: (2,), towards the drive
    flank.
    cut_turned, flank_turned: sparse (c, c), (f, f), from motions of the upper cut and the drive flank to those of the
    lower cut and the coast flank, their images.
    """

    def __init__(self, mesh: BodyMesh, nodes: np.ndarray, material: np.ndarray, centreline: float):
        """material: (h, n), which of the section's nodes there are at each height, alike towards both end faces.
        centreline: polar angle (rad) of the tooth's centreline. Raises ComputationError for a section that is not
        symmetric about it."""
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
        flank, cut, hub = (mesh.edge_nodes(name, ELEMENT.order) for name in ("flank", "upper cut", "hub"))
        self.lines, self.hub = (by_radius(flank), by_radius(without(cut, hub))), hub
        self.across = self.axes[:2, 1] * np.sign((flank @ self.axes[:2, 1]).sum())
        side = nodes @ self.across
        own = np.arange(len(nodes))
        held = np.isin(own, swept_nodes(nodes, hub, 1))
        self.standing = np.flatnonzero(((image == own) | (side > 0.0)) & ~held)
        kept = np.where(image == own, np.arange(heights)[:, None] >= heights // 2, side > 0.0) & ~held & material
        self.kept = np.flatnonzero(kept)
        self._image = len(nodes) * (heights - 1 - self.kept // len(nodes)) + image[self.kept % len(nodes)]
        number = np.cumsum(kept.ravel()) - 1
        swept = [swept_nodes(nodes, line, heights) for line in self.lines]
        there = [material.ravel()[numbers] for numbers in swept]
        self.on_cut = there[1]
        self.flank, self.cut = (dofs_of(number[numbers[own]], 3) for numbers, own in zip(swept, there))
        self.flank_turned, self.cut_turned = map(self._turned, there)

    @property
    def unknowns(self) -> int:
        """Of half the sector."""
        return 3 * len(self.kept)

    def places(self, height: range) -> range:
        """Numbers of the kept nodes at consecutive heights."""
        first, last = np.searchsorted(self.kept, [len(self.nodes) * height.start, len(self.nodes) * height.stop])
        return range(int(first), int(last))

    def folded(self, rows: sparse.csr_matrix, own: range, sign: float) -> sparse.csr_matrix:
        """Rows of the half's stiffness for EVEN or ODD motions, of the sector's rows of consecutive heights and of the
        standing nodes."""
        places = self.places(own)
        onto, dead = self._unfolding(sign, range(len(self.kept)))
        # By symmetry what half a turn brings back to the rows of the kept nodes is as much again.
        kept = self._unfolding(sign, places, half=True)[0][
            dofs_of((len(self.nodes) * np.array(own)[:, None] + self.standing).ravel(), 3)
        ]
        return (kept.T @ (rows @ onto) + dead[3 * places.start : 3 * places.stop]).tocsr()

    def _unfolding(self, sign: float, places: range, half: bool = False) -> tuple[sparse.csr_matrix, sparse.csr_matrix]:
        """Orthonormal motions (3 n h, 3 k) of the sector for the dofs of some kept nodes; a diagonal (3 m, 3 m), 1
        where a dof is dead.

        half: what they are on the kept nodes alone, times two where there is an image.
        """
        kept, image = self.kept[places.start : places.stop], self._image[places.start : places.stop]
        alone, dofs = kept == image, np.arange(3 * len(kept)).reshape(-1, 3)
        alive = np.array([1.0, 0.0, 0.0]) if sign == EVEN else np.array([0.0, 1.0, 1.0])
        own = np.where(alone[:, None, None], self.axes * alive, (2.0 if half else 1.0) * 0.5**0.5 * np.eye(3))
        parts = [_blocks(kept, dofs, own)]
        if not half:
            parts.append(
                _blocks(
                    image[~alone],
                    dofs[~alone],
                    np.broadcast_to(sign * 0.5**0.5 * self._mirror, (int((~alone).sum()), 3, 3)),
                )
            )
        values, row, column = (np.concatenate(each) for each in zip(*parts))
        motions = sparse.csr_matrix((values, (row, column)), shape=(3 * len(self.nodes) * self.heights, dofs.size))
        return motions, sparse.diags(np.where(alone[:, None], 1.0 - alive, 0.0).ravel(), format="csr")

    def _turned(self, there: np.ndarray) -> sparse.csr_matrix:
        """there: which nodes of a line at all heights there are."""
        line = len(there) // self.heights
        height, place = np.divmod(np.flatnonzero(there), line)
        order = dofs_of((np.cumsum(there) - 1)[line * (self.heights - 1 - height) + place], 3)
        return sparse.kron(sparse.eye(len(height)), self._mirror, format="csr")[order]


def _blocks(rows: np.ndarray, columns: np.ndarray, blocks: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Values, rows and columns of blocks (k, 3, 3) at the dofs of nodes (k,) and at columns (k, 3)."""
    row = np.broadcast_to((3 * rows[:, None] + np.arange(3))[:, :, None], blocks.shape)
    return blocks.ravel(), row.ravel(), np.broadcast_to(columns[:, None, :], blocks.shape).ravel()
