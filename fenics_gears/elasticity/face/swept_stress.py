"""Stress at the nodes of a swept body from its displacement; the geometry of its elements is that of
`swept_stiffness`."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy import sparse

from fenics_gears.elasticity.element_nodes import ElementNodes
from fenics_gears.elasticity.face.layers import Sweep, shapes
from fenics_gears.elasticity.nodal_stress import gradients_at_nodes
from fenics_gears.elasticity.ring import rotation


class SweptStress:
    """Stress of a section's nodes swept along a face, Young's modulus 1 MPa, displacements in the mesh's unit of
    length."""

    def __init__(self, nodes: ElementNodes, sweep: Sweep, poissons_ratio: float):
        self.points, self.sweep = nodes.points, sweep
        self._slopes = _averaged_slopes(nodes)
        self._shear = 0.5 / (1.0 + poissons_ratio)
        self._lame = poissons_ratio / ((1.0 + poissons_ratio) * (1.0 - 2.0 * poissons_ratio))

    def at_nodes(self, displacement: np.ndarray) -> np.ndarray:
        """Stress (h, n, 3, 3) from displacement (h, n, 3), both in the section's frame at each height; between layers
        the mean of both."""
        total, count = np.zeros((*displacement.shape, 3)), np.zeros(len(displacement))
        for layer, thickness in enumerate(self.sweep.thicknesses.tolist()):
            heights = slice(2 * layer, 2 * layer + 3)
            total[heights] += self._of_layer(displacement[heights], thickness)
            count[heights] += 1.0
        return total / count[:, None, None, None]

    def rows(
        self, nodes: np.ndarray, weights: np.ndarray, directions: np.ndarray, averages: np.ndarray
    ) -> sparse.csr_matrix:
        """Normal stress (S p, 3 n h) along `directions` (p, 3) at points between `nodes` (k,) by `weights` (p, k),
        averaged over the heights by `averages` (S, h).

        As of `at_nodes`, per displacement: dofs by height, node, component; directions in the section's frame at each
            height; rows by average, then point.
        """
        size, heights = 3 * len(self.points), averages.shape[1]
        layers_at = np.full(heights, 1.0)
        layers_at[2:-1:2] = 2.0
        found = sparse.csr_matrix((len(averages) * len(weights), size * heights))
        for layer, thickness in enumerate(self.sweep.thicknesses.tolist()):
            first = 2 * layer
            for height, own in enumerate(self._rows_of_layer(thickness, nodes, weights, directions), first):
                share = sparse.csr_matrix(averages[:, height : height + 1] / layers_at[height])
                ends = [sparse.csr_matrix((own.shape[0], size * count)) for count in (first, heights - first - 3)]
                found = found + sparse.kron(share, sparse.hstack([ends[0], own, ends[1]]), format="csr")
        return found

    def _rows_of_layer(
        self, thickness: float, nodes: np.ndarray, weights: np.ndarray, directions: np.ndarray
    ) -> Iterator[sparse.csr_matrix]:
        """Of the three heights of a layer (p, 9 n), as `_of_layer`."""
        angles = 0.5 * self.sweep.twist * thickness * np.array([-1.0, 0.0, 1.0])
        frames, count, three = [rotation(angle, 3) for angle in angles], len(self.points), sparse.eye(3)
        common = [
            sparse.kron(np.eye(3)[place : place + 1], sparse.kron(sparse.eye(count), frame), format="csr")
            for place, frame in enumerate(frames)
        ]
        slopes_of, own = (
            [sparse.kron(slope[nodes], three, format="csr") for slope in self._slopes],
            sparse.kron(sparse.eye(count, format="csr")[nodes], three),
        )
        for place, frame in enumerate(frames):
            slopes = shapes(place - 1.0)[1] / (0.5 * thickness)
            turn, change = np.exp(1j * angles[place]), slopes @ np.exp(1j * angles)
            inverse, swept = _as_matrix(1.0 / turn), self.points[nodes] @ _as_matrix(change / turn).T
            along = [slope @ common[place] for slope in slopes_of]
            whole = [inverse[0, axis] * along[0] + inverse[1, axis] * along[1] for axis in (0, 1)]
            axial = own @ sum(slope * each for slope, each in zip(slopes, common))
            whole.append(axial - sum(sparse.diags(np.repeat(swept[:, axis], 3)) @ along[axis] for axis in (0, 1)))
            turned = directions @ frame.T
            found = sparse.csr_matrix((len(weights), 3 * 3 * count))
            for axis, gradient in enumerate(whole):
                factors = 2.0 * self._shear * turned * turned[:, axis : axis + 1] + self._lame * np.eye(3)[axis]
                found = (
                    found
                    + sparse.csr_matrix((weights[:, :, None] * factors[:, None]).reshape(len(weights), -1)) @ gradient
                )
            yield found

    def _of_layer(self, displacement: np.ndarray, thickness: float) -> np.ndarray:
        """Of the three heights of a layer (3, n, 3, 3)."""
        angles = 0.5 * self.sweep.twist * thickness * np.array([-1.0, 0.0, 1.0])
        frames = [rotation(angle, 3) for angle in angles]
        # In the frame of the layer's middle.
        common = np.stack([own @ frame.T for own, frame in zip(displacement, frames)])
        along = [np.stack([slope @ own for slope in self._slopes], axis=-1) for own in common]
        found = []
        for place, (frame, gradient) in enumerate(zip(frames, along)):
            slopes = shapes(place - 1.0)[1] / (0.5 * thickness)
            turn, change = np.exp(1j * angles[place]), slopes @ np.exp(1j * angles)
            # Products with 1/w, and with w'/w times the place in the section.
            inverse, sweep = _as_matrix(1.0 / turn), _as_matrix(change / turn)
            axial = np.einsum("k,kni->ni", slopes, common) - np.einsum("nij,nj->ni", gradient, self.points @ sweep.T)
            whole = np.concatenate([gradient @ inverse, axial[..., None]], axis=-1)
            found.append(frame.T @ self._stress(whole) @ frame)
        return np.stack(found)

    def _stress(self, gradient: np.ndarray) -> np.ndarray:
        strain = 0.5 * (gradient + gradient.swapaxes(-1, -2))
        return 2.0 * self._shear * strain + self._lame * np.trace(strain, axis1=-2, axis2=-1)[..., None, None] * np.eye(
            3
        )


def _as_matrix(number: complex) -> np.ndarray:
    """Matrix (2, 2) that multiplies by a complex number."""
    return np.array([[number.real, -number.imag], [number.imag, number.real]])


def _averaged_slopes(nodes: ElementNodes) -> tuple[sparse.csr_matrix, sparse.csr_matrix]:
    """Operators (n, n) from values at the nodes to their derivatives by x and y there, averaged by area over the
    elements that meet."""
    gradients, areas = gradients_at_nodes(nodes)
    cells, count = nodes.cells, len(nodes.points)
    weight = np.bincount(cells.ravel(), np.repeat(areas, cells.shape[1]), count)
    rows = np.broadcast_to(cells[:, :, None], gradients.shape[:3])
    columns = np.broadcast_to(cells[:, None, :], gradients.shape[:3])
    found = []
    for axis in (0, 1):
        values = gradients[..., axis] * areas[:, None, None]
        found.append(
            sparse.coo_matrix(
                (values.ravel() / weight[rows.ravel()], (rows.ravel(), columns.ravel())), shape=(count, count)
            ).tocsr()
        )
    return found[0], found[1]
