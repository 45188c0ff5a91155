"""What the layers of a body over the face leave out near a load.

A load on part of a layer moves the flank more than a parabola over the layer can tell. What is missing varies along the
face within a layer, and so decays within that length, down the tooth too: it does not depend on rim, web, bore or
neighbours. It is the difference between two teeth that are held at their root and differ in their layers alone:

    D = T(thin layers) - I T(layers of the body) I^T

with I the interpolation of the second along the face. D is added to the body's compliance of a tooth under its own
load, along the contact normal of each flank node. Of each layer it is found on the layer and its neighbours
(measured: docs/evidence/third_dimension.md).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import ceil

import numpy as np
from scipy import sparse
from scipy.linalg import cho_factor, cho_solve

from fenics_gears.geometry.gear import Gear

from ..condensation import by_radius, dofs_of
from ..element_nodes import numbers_at
from ..mesh_data import BodyMesh
from ..mumps import schur_complement
from .layers import Sweep, interpolation_along
from .swept_stiffness import ELEMENT, SectionForms, swept_stiffness

# Modules: thickness of the thin layers, and how far below the root circle a tooth is held.
THIN, DEPTH = 0.3, 0.3


@dataclass(frozen=True)
class NearField:
    """heights: (H,), mm, of the nodes of the thin layers. normals: (flanks, n, 3), of the flank nodes of a section.
    compliance: of each flank, sparse (H n, H n), mm/N, along these normals."""

    heights: np.ndarray
    normals: np.ndarray
    compliance: tuple[sparse.csr_matrix, ...]

    def scaled(self, module: float, youngs_modulus: float) -> NearField:
        """Of a gear of that module (mm) and Young's modulus (MPa), from that of one of module 1 and 1 MPa."""
        factor = 1.0 / (module * youngs_modulus)
        return replace(self, heights=module * self.heights, compliance=tuple(factor * each for each in self.compliance))

    @property
    def arrays(self) -> dict[str, np.ndarray]:
        """For the cache."""
        found = {"near_heights": self.heights, "near_normals": self.normals}
        for number, each in enumerate(self.compliance):
            parts = {"data": each.data, "indices": each.indices, "indptr": each.indptr}
            found |= {f"near_{name}_{number}": part for name, part in parts.items()}
        return found

    @classmethod
    def of_arrays(cls, arrays: dict[str, np.ndarray]) -> NearField:
        """From what `arrays` gave."""
        heights, normals = (arrays[f"near_{name}"] for name in ("heights", "normals"))
        size = len(heights) * normals.shape[1]
        compliance = (
            sparse.csr_matrix(
                tuple(arrays[f"near_{part}_{number}"] for part in ("data", "indices", "indptr")), shape=(size, size)
            )
            for number in range(len(normals))
        )
        return cls(heights, normals, tuple(compliance))


def near_field(
    gear: Gear, mesh: BodyMesh, sweep: Sweep, poissons_ratio: float, rolls: np.ndarray, both: bool = False
) -> NearField:
    """Of a gear of module one, Young's modulus 1 MPa. `rolls` (n,), rad, of the section's flank nodes."""
    tooth = _HeldTooth(gear, mesh, sweep.twist, poissons_ratio, rolls)
    thick = [float(each) for each in sweep.thicknesses]
    of_flanks = [_joined(tooth, thick)]
    normals = [tooth.normals]
    if both:
        # Half a turn about a tooth's centreline takes one flank to the other, and z to -z.
        order = _reversed_heights(of_flanks[0].shape[0] // len(rolls), len(rolls))
        mirrored = of_flanks[0] if thick == thick[::-1] else _joined(tooth, thick[::-1])
        of_flanks.append(mirrored[order][:, order].tocsr())
        normals.append(tooth.normals * [1.0, 1.0, -1.0])
    return NearField(Sweep(_thin(sweep.boundaries)).heights, np.array(normals), tuple(of_flanks))


def _reversed_heights(heights: int, nodes: int) -> np.ndarray:
    return np.arange(heights * nodes).reshape(heights, nodes)[::-1].ravel()


def _thin(boundaries: np.ndarray) -> np.ndarray:
    """Boundaries of thin layers, among them those given."""
    inner = [np.linspace(*ends, _parts(ends[1] - ends[0]) + 1)[:-1] for ends in zip(boundaries, boundaries[1:])]
    return np.append(np.concatenate(inner), boundaries[-1])


def _parts(thickness: float) -> int:
    """Thin layers of a layer."""
    return ceil(thickness / THIN - 1e-9)


class _HeldTooth:
    """A tooth of a section, swept through some layers and held at its root."""

    def __init__(self, gear: Gear, mesh: BodyMesh, twist: float, poissons_ratio: float, rolls: np.ndarray):
        self._section, self._twist = SectionForms(mesh, poissons_ratio), twist
        points = self._section.nodes.points
        free = np.linalg.norm(points, axis=1) > gear.root_radius - DEPTH
        for held in ("lower cut", "upper cut", "hub"):
            free[numbers_at(points, mesh.edge_nodes(held, ELEMENT.order))] = False
        self._free = free
        flank = numbers_at(points, by_radius(mesh.edge_nodes("flank", ELEMENT.order)))
        self._flank = (np.cumsum(free) - 1)[flank]
        slope = -twist * gear.base_radius
        transverse = np.column_stack([np.cos(rolls), -np.sin(rolls), np.full(len(rolls), slope)])
        self.normals = transverse / np.sqrt(1.0 + slope**2)
        self._along = _along_normals(int(free.sum()), self._flank, self.normals)
        self._known: dict[tuple, np.ndarray] = {}

    @property
    def nodes(self) -> int:
        """Of a section's flank."""
        return len(self._flank)

    def missing(self, thick: tuple[float, ...], layer: int) -> np.ndarray:
        """D (h n, H n) of layers of some thicknesses: displacements of one `layer`, at its thin layers' nodes, under
        forces on all."""
        if (thick, layer) not in self._known:
            boundaries = np.concatenate([[0.0], np.cumsum(thick)])
            thin = Sweep(_thin(boundaries)).heights
            along = sparse.kron(interpolation_along(boundaries, thin), sparse.eye(self.nodes), format="csr")
            whole = self._compliance(_thin(boundaries)) - along @ (along @ self._compliance(boundaries)).T
            first = 2 * sum(_parts(each) for each in thick[:layer])
            own = slice(first * self.nodes, (first + 2 * _parts(thick[layer]) + 1) * self.nodes)
            self._known[thick, layer] = whole[own]
        return self._known[thick, layer]

    def _compliance(self, boundaries: np.ndarray) -> np.ndarray:
        """T (H n, H n), along the normals, of layers between boundaries."""
        sweep = Sweep(boundaries, self._twist)
        heights, nodes = len(sweep.heights), int(self._free.sum())
        free = dofs_of(np.flatnonzero(np.tile(self._free, heights)), 3)
        along = sparse.kron(sparse.eye(heights), self._along, format="csr")
        stiffness = along.T @ swept_stiffness(self._section, sweep)[free][:, free] @ along
        on_flank = 3 * (nodes * np.arange(heights)[:, None] + self._flank).ravel()
        found = cho_solve(cho_factor(schur_complement(stiffness.tocsr(), on_flank)), np.eye(len(on_flank)))
        return 0.5 * (found + found.T)


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
    parts = np.array([_parts(each) for each in thick])
    first, heights = 2 * (np.cumsum(parts) - parts), 2 * int(parts.sum()) + 1
    found = sparse.csr_matrix((heights * tooth.nodes,) * 2)
    for layer in range(len(thick)):
        low, high = max(layer - 1, 0), min(layer + 2, len(thick))
        missing = tooth.missing(tuple(thick[low:high]), layer - low)
        # Nodes between two layers have half of either's.
        share = np.ones(2 * parts[layer] + 1)
        share[[0, -1]] = 1.0 if layer == 0 else 0.5, 1.0 if layer == len(thick) - 1 else 0.5
        block = sparse.coo_matrix(np.repeat(share, tooth.nodes)[:, None] * missing)
        places = block.row + first[layer] * tooth.nodes, block.col + first[low] * tooth.nodes
        found = found + sparse.csr_matrix((block.data, places), shape=found.shape)
    return (0.5 * (found + found.T)).tocsr()
