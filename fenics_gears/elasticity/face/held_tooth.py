"""A tooth that is held at its root, swept through some layers: what these leave out near a load (`near_field`).

Through 25 thin layers it has 35,000 dofs. But its sections move in some 230 ways under forces on the flank (Galerkin's
method, as of `cut_motions`): those in which few layers move them, thin ones and those of the body. Then alike layers
are joined by halves. Of the largest entry of D that leaves 2e-6, and takes half of the time of all dofs.
"""

from __future__ import annotations

from contextlib import closing

import numpy as np
from scipy import sparse
from scipy.linalg import eigh

from fenics_gears.geometry.gear import Gear

from ..condensation import by_radius
from ..element_nodes import dofs_of, numbers_at
from ..mesh_data import BodyMesh
from ..mumps import Factor
from .layer_run import WHAT, LayerRun
from .layers import Sweep, interpolation_along
from .near_field import NearField, neighbours, thin_boundaries, thin_layers
from .swept_stiffness import ELEMENT, SectionForms, layer_stiffness, of_motions, swept_stiffness

# Modules: how far below the root circle a tooth is held.
DEPTH = 0.3
# Layers whose sections tell the motions, thin ones and those of the body; motions below this part of the largest are
# left out.
THIN_LAYERS, THICK_LAYERS = 4, 5
LEAST_MOTION = 1e-5


def near_field(
    gear: Gear, mesh: BodyMesh, sweep: Sweep, poissons_ratio: float, rolls: np.ndarray, both: bool = False
) -> NearField:
    """Of a gear of module one, Young's modulus 1 MPa. `rolls` (n,), rad, of the section's flank nodes."""
    tooth = _HeldTooth(gear, mesh, sweep, poissons_ratio, rolls)
    thick = [float(each) for each in sweep.thicknesses]
    of_flanks = [_joined(tooth, thick)]
    normals = [tooth.normals]
    if both:
        # Half a turn about a tooth's centreline takes one flank to the other, and z to -z.
        order = _reversed_heights(of_flanks[0].shape[0] // len(rolls), len(rolls))
        mirrored = of_flanks[0] if thick == thick[::-1] else _joined(tooth, thick[::-1])
        of_flanks.append(mirrored[order][:, order].tocsr())
        normals.append(tooth.normals * [1.0, 1.0, -1.0])
    return NearField(Sweep(thin_boundaries(sweep.boundaries)).heights, np.array(normals), tuple(of_flanks))


def _reversed_heights(heights: int, nodes: int) -> np.ndarray:
    return np.arange(heights * nodes).reshape(heights, nodes)[::-1].ravel()


class _HeldTooth:
    """A tooth of a section, swept through some layers and held at its root."""

    def __init__(self, gear: Gear, mesh: BodyMesh, sweep: Sweep, poissons_ratio: float, rolls: np.ndarray):
        self._section = SectionForms(mesh, poissons_ratio)
        self._twist = sweep.twist
        points = self._section.nodes.points
        free = gear.sign * np.linalg.norm(points, axis=1) > gear.root_radius - DEPTH
        for held in ("lower cut", "upper cut", "hub"):
            free[numbers_at(points, mesh.edge_nodes(held, ELEMENT.order))] = False
        flank = numbers_at(points, by_radius(mesh.edge_nodes("flank", ELEMENT.order)))
        slope = -sweep.twist * gear.base_radius
        transverse = np.column_stack([np.cos(rolls), -np.sin(rolls), np.full(len(rolls), slope)])
        self.normals = transverse / np.sqrt(1.0 + slope**2)
        own = (np.cumsum(free) - 1)[flank]
        along = _along_normals(int(free.sum()), own, self.normals)
        # Those along the normals come last, as a LayerRun has them.
        order = np.concatenate([np.setdiff1d(np.arange(along.shape[1]), 3 * own), 3 * own])
        self._all = sparse.eye(3 * len(points), format="csr")[:, dofs_of(np.flatnonzero(free), 3)] @ along[:, order]
        self._motions = self._section_motions(sweep.thicknesses.tolist())
        self._runs: dict[tuple[float, ...], LayerRun] = {}
        self._known: dict[tuple[float, ...], np.ndarray] = {}

    @property
    def nodes(self) -> int:
        """Of a section's flank."""
        return len(self.normals)

    def missing(self, thick: tuple[float, ...], layer: int) -> np.ndarray:
        """D (h n, H n) of layers of some thicknesses: displacements of one `layer`, at its thin layers' nodes, under
        forces on all."""
        if thick not in self._known:
            boundaries = np.concatenate([[0.0], np.cumsum(thick)])
            thin = thin_boundaries(boundaries)
            along = sparse.kron(interpolation_along(boundaries, Sweep(thin).heights), sparse.eye(self.nodes), "csr")
            self._known[thick] = self._compliance(thin) - along @ (along @ self._compliance(boundaries)).T
        first = 2 * sum(thin_layers(each) for each in thick[:layer])
        last = first + 2 * thin_layers(thick[layer]) + 1
        return self._known[thick][first * self.nodes : last * self.nodes]

    def _section_motions(self, thick: list[float]) -> np.ndarray:
        """Motions (3 n, r) of sections of a face of layers of some thicknesses: those in which forces along the normals
        move few layers; last those along the normals themselves."""
        thickest = max(thick)
        thin = (thickest / thin_layers(thickest),) * THIN_LAYERS
        # From either end, so that the mirrored face has the mirrored motions.
        bodies = dict.fromkeys([thin, tuple(thick[:THICK_LAYERS]), tuple(thick[-THICK_LAYERS:])])
        others = self._all.shape[1] - self.nodes
        moved = np.hstack([self._moved(np.concatenate([[0.0], np.cumsum(each)]))[:others] for each in bodies])
        sizes, directions = eigh(moved @ moved.T)
        kept = directions[:, sizes > LEAST_MOTION**2 * sizes[-1]]
        return np.hstack([self._all[:, :others] @ kept, self._all[:, others:].toarray()])

    def _moved(self, boundaries: np.ndarray) -> np.ndarray:
        """How sections move (3 n, k) under forces of one on each flank node at each height of some layers."""
        stiffness = swept_stiffness(self._section, Sweep(boundaries, self._twist), self._all)
        size = self._all.shape[1]
        number = np.arange(stiffness.shape[0])
        on_flank = number[number % size >= size - self.nodes]
        forces = np.zeros((len(number), len(on_flank)))
        forces[on_flank, np.arange(len(on_flank))] = 1.0
        with closing(Factor(stiffness, WHAT)) as factor:
            return np.hstack(factor.solve(forces).reshape(-1, size, len(on_flank)))

    def _compliance(self, boundaries: np.ndarray) -> np.ndarray:
        """T (H n, H n), along the normals, of layers between boundaries."""
        return self._run(tuple(Sweep(boundaries).thicknesses.tolist())).compliance()

    def _run(self, thick: tuple[float, ...]) -> LayerRun:
        """Layers of some thicknesses. Alike parts of them are condensed once."""
        if thick not in self._runs:
            if len(thick) == 1:
                blocks = layer_stiffness(self._section, thick[0], self._twist)
                self._runs[thick] = LayerRun.of_layer(of_motions(blocks, self._motions), self.nodes)
            else:
                # Of two alike halves, or of one that is.
                lower = 1 << ((len(thick) - 1).bit_length() - 1)
                self._runs[thick] = self._run(thick[:lower]).joined(self._run(thick[lower:]))
        return self._runs[thick]


def _along_normals(nodes: int, flank: np.ndarray, normals: np.ndarray) -> sparse.csr_matrix:
    """Motions (3 nodes, 3 nodes) in x, y, z of those whose first component is along the `normals` (n, 3) at `flank`
    nodes."""
    blocks = np.tile(np.eye(3), (nodes, 1, 1))
    for node, normal in zip(flank, normals):
        blocks[node] = np.linalg.qr(np.column_stack([normal, np.eye(3)[:, 1:]]))[0]
        blocks[node][:, 0] = normal
    return sparse.block_diag(list(blocks), format="csr")


def _joined(tooth: _HeldTooth, thick: list[float]) -> sparse.csr_matrix:
    """D of a whole face, of layers of some thicknesses: of each with its neighbours."""
    parts = np.array([thin_layers(each) for each in thick])
    first, heights = 2 * (np.cumsum(parts) - parts), 2 * int(parts.sum()) + 1
    joined = sparse.csr_matrix((heights * tooth.nodes,) * 2)
    for layer, near in enumerate(neighbours(thick)):
        missing = tooth.missing(tuple(thick[near]), layer - near.start)
        # Nodes between two layers have half of either's.
        share = np.ones(2 * parts[layer] + 1)
        share[[0, -1]] = 1.0 if layer == 0 else 0.5, 1.0 if layer == len(thick) - 1 else 0.5
        block = sparse.coo_matrix(np.repeat(share, tooth.nodes)[:, None] * missing)
        places = block.row + first[layer] * tooth.nodes, block.col + first[near.start] * tooth.nodes
        joined = joined + sparse.csr_matrix((block.data, places), shape=joined.shape)
    return (0.5 * (joined + joined.T)).tocsr()
