"""Stress at the nodes of a body, plane or swept, from its displacement: taken in each element where it is most
accurate, averaged where elements meet.

That is (Barlow, International Journal for Numerical Methods in Engineering 10, 1976) the middle of first-order cells
and the 2 x 2 Gauss points of Q2. Of P2 it is linear and taken at the nodes. Swept elements are as in
`face.swept_stiffness`.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from scipy import sparse

from fenics_gears.geometry.outline import rotation

from . import dolfinx_adapter as adapter
from .element_nodes import ElementNodes, dofs_of
from .face.layers import Sweep, shapes

# Of the reference triangle and square: corners counter-clockwise, middles of sides, middle, as in ElementNodes.
REFERENCE = {
    3: np.array([[0, 0], [1, 0], [0, 1], [0.5, 0], [0.5, 0.5], [0, 0.5]]),
    4: np.array([[0, 0], [1, 0], [1, 1], [0, 1], [0.5, 0], [1, 0.5], [0.5, 1], [0, 0.5], [0.5, 0.5]]),
}
GAUSS = 1.0 / np.sqrt(3.0)


class NodalStress:
    """Stress of a body in plane strain or, with a `sweep`, of the one swept from that section; Young's modulus 1 MPa,
    displacements in the mesh's unit of length.

    weight: (n,), areas of the elements that meet at the section's nodes. Beside a web the section is rim and hub alone;
    where there is no material stress is zero.
    """

    def __init__(self, nodes: ElementNodes, poissons_ratio: float, sweep: Sweep | None = None):
        self.nodes = nodes
        self.sweep = sweep
        self.components, self._heights = (2, 1) if sweep is None else (3, len(sweep.heights))
        whole, self.weight = _averaged_slopes(nodes)
        # First of layers in a web, or of all layers of a body without one; then of layers outside the web.
        self._slopes = {True: whole}
        self._there = {True: np.ones(len(nodes.points))}
        if sweep is not None and sweep.web is not None:
            outside = replace(nodes, cells=nodes.cells[sweep.web.outside(nodes.middles)])
            self._slopes[False], area = _averaged_slopes(outside)
            self._there[False] = (area > 0.0).astype(float)
        self._shear = 0.5 / (1.0 + poissons_ratio)
        self._lame = poissons_ratio / ((1.0 + poissons_ratio) * (1.0 - 2.0 * poissons_ratio))
        self._layers = [*self._gradients()]
        # Between two layers their mean counts: how many meet at a node (h, n).
        self._layers_at = np.zeros((self._heights, len(nodes.points)))
        for within, (heights, _) in zip([True] if sweep is None else sweep.in_web.tolist(), self._layers):
            self._layers_at[heights.start : heights.stop] += self._there[within]

    def at_nodes(self, displacement: np.ndarray) -> np.ndarray:
        """Stress (h, n, 3, 3) from displacement (h, n, 2) or (h, n, 3), both in the section's frame at each height."""
        total = np.zeros((*displacement.shape[:2], 3, 3))
        for heights, gradients in self._layers:
            moved = displacement[heights.start : heights.stop].ravel()
            for height, gradient in zip(heights, gradients):
                total[height] += self._stress((gradient @ moved).reshape(-1, 3, 3))
        return total / np.maximum(self._layers_at, 1.0)[:, :, None, None]

    def rows(
        self, nodes: np.ndarray, weights: np.ndarray, directions: np.ndarray, averages: np.ndarray
    ) -> sparse.csr_matrix:
        """Normal stress (S p, dofs) per displacement along `directions` (p, 3) at points between `nodes` (k,) by
        `weights` (p, k), averaged over the heights by `averages` (S, h).

        Dofs by height, node, component; directions in the section's frame at each height; rows by average, then point.
        """
        # t . sigma t over the nine entries of a gradient.
        normal = 2.0 * self._shear * np.einsum("pi,pj->pij", directions, directions) + self._lame * np.eye(3)
        between = sparse.csr_matrix((weights[:, :, None] * normal.reshape(-1, 1, 9)).reshape(len(weights), -1))
        chosen = dofs_of(nodes, 9)
        of_height = self.components * len(self.nodes.points)
        rows = sparse.csr_matrix((len(averages) * len(weights), of_height * self._heights))
        # The same at all these nodes, none of which is of a web.
        meeting = self._layers_at[:, nodes].max(axis=1)
        for heights, gradients in self._layers:
            for height, gradient in zip(heights, gradients):
                own = between @ gradient[chosen]
                # Columns of the layer's dofs among the body's.
                placed = sparse.csr_matrix(
                    (own.data, own.indices + of_height * heights.start, own.indptr), (len(weights), rows.shape[1])
                )
                rows = rows + sparse.kron(averages[:, [height]] / meeting[height], placed, format="csr")
        return rows

    def _stress(self, gradient: np.ndarray) -> np.ndarray:
        strain = 0.5 * (gradient + gradient.swapaxes(-1, -2))
        trace = np.trace(strain, axis1=-2, axis2=-1)[..., None, None]
        return 2.0 * self._shear * strain + self._lame * trace * np.eye(3)

    def _gradients(self) -> Iterator[tuple[range, list[sparse.csr_matrix]]]:
        """Heights of each layer, and for each of them the displacement's gradient (9 n, dofs of the layer)."""
        if self.sweep is None:
            yield range(1), [_along_section(self._slopes[True], np.eye(3)[:2], components=2)]
            return
        known: dict[tuple[float, bool], list[sparse.csr_matrix]] = {}
        for layer, kind in enumerate(zip(self.sweep.thicknesses.tolist(), self.sweep.in_web.tolist())):
            if kind not in known:
                known[kind] = [*self._of_layer(*kind)]
            yield range(2 * layer, 2 * layer + 3), known[kind]

    def _of_layer(self, thickness: float, within: bool) -> Iterator[sparse.csr_matrix]:
        """The gradient at a layer's three heights, taken in the frame of its middle."""
        slopes = self._slopes[within]
        there = sparse.diags(self._there[within])
        points = self.nodes.points
        angles = 0.5 * self.sweep.twist * thickness * np.array([-1.0, 0.0, 1.0])
        frames = [rotation(angle, 3) for angle in angles]
        turns = np.exp(1j * angles)
        axial = np.eye(3)[2:]
        for place, frame in enumerate(frames):
            change = shapes(place - 1.0)[1] / (0.5 * thickness)
            swept = points @ _as_matrix(change @ turns / turns[place]).T
            of_height = [slope * _along_section([there], axial) for slope in change]
            of_height[place] = (
                of_height[place]
                + _along_section(slopes, np.pad(_as_matrix(1.0 / turns[place]), ((0, 0), (0, 1))))
                - sum(_along_section([sparse.diags(swept[:, b]) @ slopes[b]], axial) for b in (0, 1))
            )
            back = sparse.kron(sparse.eye(len(points)), np.kron(frame.T, frame.T), format="csr")
            to_middle = [sparse.kron(sparse.eye(len(points)), each, format="csr") for each in frames]
            yield sparse.hstack([back @ part @ turn for part, turn in zip(of_height, to_middle)], format="csr")


def _along_section(slopes, axes: np.ndarray, components: int = 3) -> sparse.csr_matrix:
    """Gradients (9 n, components n) from derivatives (n, n) and the axes (j, 3) that each is along."""
    return sum(
        sparse.kron(slope, np.kron(np.eye(3)[:, :components], axis[:, None]), format="csr")
        for slope, axis in zip(slopes, axes)
    )


def _as_matrix(number: complex) -> np.ndarray:
    """Matrix (2, 2) that multiplies by a complex number."""
    return np.array([[number.real, -number.imag], [number.imag, number.real]])


def _averaged_slopes(nodes: ElementNodes) -> tuple[list[sparse.csr_matrix], np.ndarray]:
    """Operators (n, n) from values at the nodes to their derivatives by x and y there, averaged by area over the
    elements that meet, and those areas' sums (n,)."""
    gradients, areas = _gradients_in_cells(nodes)
    cells = nodes.cells
    count = len(nodes.points)
    weight = np.bincount(cells.ravel(), np.repeat(areas, cells.shape[1]), count)
    rows = np.broadcast_to(cells[:, :, None], gradients.shape[:3]).ravel()
    columns = np.broadcast_to(cells[:, None, :], gradients.shape[:3]).ravel()
    values = (gradients * areas[:, None, None, None]).reshape(-1, 2) / weight[rows, None]
    return [sparse.coo_matrix((each, (rows, columns)), shape=(count, count)).tocsr() for each in values.T], weight


def _gradients_in_cells(nodes: ElementNodes) -> tuple[np.ndarray, np.ndarray]:
    """Gradients (cells, nodes, nodes, 2) of the shape functions (third index) at each node (second), and areas
    (cells,)."""
    kind = nodes.corners
    vertices, own = (REFERENCE[kind][:count] for count in (kind, nodes.cells.shape[1]))
    if nodes.order == 1:
        samples = own.mean(axis=0, keepdims=True)
        to_nodes = np.ones((len(own), 1))
    elif kind == 4:
        samples = 0.5 + GAUSS * (vertices - 0.5)
        # Bilinear between the Gauss points.
        to_nodes = adapter.lagrange(vertices, 1, 0.5 + (own - 0.5) / GAUSS)[0]
    else:
        samples = own
        to_nodes = np.eye(len(own))
    corners = nodes.points[nodes.cells[:, :kind]]
    jacobian = np.einsum("sad,cax->csxd", adapter.lagrange(vertices, 1, samples)[1], corners)
    gradients = np.einsum("sad,csdx->csax", adapter.lagrange(own, nodes.order, samples)[1], np.linalg.inv(jacobian))
    along = corners[:, 1:-1] - corners[:, :1]
    across = corners[:, 2:] - corners[:, :1]
    areas = 0.5 * (along[..., 0] * across[..., 1] - along[..., 1] * across[..., 0]).sum(axis=1)
    return np.einsum("ns,csax->cnax", to_nodes, gradients), areas
