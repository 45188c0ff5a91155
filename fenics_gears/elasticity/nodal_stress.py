"""Stress at the nodes of a body from its displacement: taken in each element where it is most accurate, averaged where
elements meet.

The points of an element where the error of its stress is one order smaller (Barlow, International Journal for Numerical
Methods in Engineering 10, 1976) are the middle of first-order cells and the 2 x 2 Gauss points of Q2; that of P2 is
linear and taken at the nodes.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import sparse

from fenics_gears.elasticity.element_nodes import ElementNodes

GAUSS = 1.0 / np.sqrt(3.0)
# Corners, middles of sides, middle of the reference triangle (0, 1) and quadrilateral (-1, 1).
TRIANGLE_NODES = np.array([[0, 0], [1, 0], [0, 1], [0.5, 0], [0.5, 0.5], [0, 0.5]])
SQUARE_NODES = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1], [0, -1], [1, 0], [0, 1], [-1, 0], [0, 0]], dtype=float)
TRIANGLE_POWERS = {1: [(0, 0), (1, 0), (0, 1)], 2: [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)]}
SQUARE_POWERS = {order: [(i, j) for i in range(order + 1) for j in range(order + 1)] for order in (1, 2)}


@dataclass(frozen=True)
class NodalStress:
    """Averaged stress as a sparse operator, for Young's modulus 1 MPa and displacements in the mesh's unit of length.

    weighted: (3 n, 2 n): displacement (2 n,) to sums over elements of area times stress, xx, yy, xy at each node;
        weight: (n,), the
    sums of areas. A node on a cut has part of its elements in the neighbouring sector, whose sums are added before
    dividing.
    """

    weighted: sparse.csr_matrix
    weight: np.ndarray

    def rows(self, nodes: np.ndarray) -> sparse.csr_matrix:
        """Stress xx, yy, xy (3 k, 2 n) at nodes (k,) all of whose elements are in this body."""
        chosen = (3 * nodes[:, None] + [0, 1, 2]).ravel()
        return sparse.diags(np.repeat(1.0 / self.weight[nodes], 3)) @ self.weighted[chosen]


def nodal_stress(nodes: ElementNodes, poissons_ratio: float) -> NodalStress:
    """The operator of a body in plane strain."""
    gradients, areas = gradients_at_nodes(nodes)
    cells, count = nodes.cells, len(nodes.points)
    per_cell = cells.shape[1]
    # Stress xx, yy, xy of (cell, node) by displacement x, y of (cell, other node).
    shear = 0.5 / (1.0 + poissons_ratio)
    lame = poissons_ratio / ((1.0 + poissons_ratio) * (1.0 - 2.0 * poissons_ratio))
    d_x, d_y = gradients[..., 0], gradients[..., 1]
    stress = (
        np.array(
            [
                [(lame + 2.0 * shear) * d_x, lame * d_y],
                [lame * d_x, (lame + 2.0 * shear) * d_y],
                [shear * d_y, shear * d_x],
            ]
        )
        * areas[:, None, None]
    )  # (3, 2, cells, nodes, nodes)
    component, direction = np.arange(3)[:, None, None, None, None], np.arange(2)[None, :, None, None, None]
    rows = np.broadcast_to(3 * cells[None, None, :, :, None] + component, stress.shape)
    columns = np.broadcast_to(2 * cells[None, None, :, None, :] + direction, stress.shape)
    weighted = sparse.coo_matrix(
        (stress.ravel(), (rows.ravel(), columns.ravel())), shape=(3 * count, 2 * count)
    ).tocsr()
    weight = np.bincount(cells.ravel(), np.repeat(areas, per_cell), count)
    return NodalStress(weighted, weight)


def gradients_at_nodes(nodes: ElementNodes) -> tuple[np.ndarray, np.ndarray]:
    """Gradients (cells, nodes, nodes, 2) of the shape functions (third index) that count at each node (second), and
    areas (cells,)."""
    square = nodes.corners == 4
    reference = (SQUARE_NODES if square else TRIANGLE_NODES)[: nodes.cells.shape[1]]
    powers = (SQUARE_POWERS if square else TRIANGLE_POWERS)[nodes.order]
    if nodes.order == 1:
        samples, to_nodes = reference.mean(axis=0, keepdims=True), np.ones((len(reference), 1))
    elif square:
        samples = GAUSS * SQUARE_NODES[:4]
        to_nodes = _shapes(reference / GAUSS, SQUARE_NODES[:4], SQUARE_POWERS[1])
    else:
        samples, to_nodes = reference, np.eye(len(reference))
    geometry = (SQUARE_POWERS if square else TRIANGLE_POWERS)[1]
    corners = nodes.points[nodes.cells[:, : nodes.corners]]
    jacobian = np.einsum("sad,cax->csxd", _slopes(samples, reference[: nodes.corners], geometry), corners)
    inverse = np.linalg.inv(jacobian)
    gradients = np.einsum("sad,csdx->csax", _slopes(samples, reference, powers), inverse)
    along, across = corners[:, 1:-1] - corners[:, :1], corners[:, 2:] - corners[:, :1]
    areas = 0.5 * (along[..., 0] * across[..., 1] - along[..., 1] * across[..., 0]).sum(axis=1)
    return np.einsum("ns,csax->cnax", to_nodes, gradients), areas


def _shapes(points: np.ndarray, nodes: np.ndarray, powers) -> np.ndarray:
    """Shape functions (points, nodes) of the nodes (k, 2) at points (j, 2)."""
    return _monomials(points, powers) @ np.linalg.inv(_monomials(nodes, powers))


def _slopes(points: np.ndarray, nodes: np.ndarray, powers) -> np.ndarray:
    """Derivatives (points, nodes, 2) of the shape functions by the reference coordinates."""
    x, y = points.T
    by_x = np.stack([i * x ** max(i - 1, 0) * y**j for i, j in powers], axis=-1)
    by_y = np.stack([j * x**i * y ** max(j - 1, 0) for i, j in powers], axis=-1)
    coefficients = np.linalg.inv(_monomials(nodes, powers))
    return np.stack([by_x @ coefficients, by_y @ coefficients], axis=-1)


def _monomials(points: np.ndarray, powers) -> np.ndarray:
    x, y = points.T
    return np.stack([x**i * y**j for i, j in powers], axis=-1)
