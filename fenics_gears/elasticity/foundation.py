"""Springs evenly over the outer circle of an internal gear: its elastic foundation, in a sector's stiffness. Over the
face those along the axis are the tangential ones."""

from collections.abc import Callable, Iterator

import numpy as np
from scipy import sparse

from .element_nodes import dofs_of, numbers_at
from .mesh_data import BodyMesh

GAUSS_POINTS, GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(4)
PLACES = 0.5 * (1.0 + GAUSS_POINTS)
# Shape functions at PLACES along an edge, of its two ends, and of an edge of second order its middle too.
LINEAR = np.stack([1.0 - PLACES, PLACES])
QUADRATIC = np.stack(
    [(1.0 - PLACES) * (1.0 - 2.0 * PLACES), PLACES * (2.0 * PLACES - 1.0), 4.0 * PLACES * (1.0 - PLACES)]
)


def add_foundation(matrix, mesh: BodyMesh, order: int, nodes_at) -> None:
    """Add the foundation's stiffness, Young's modulus 1 MPa, to an assembled PETSc matrix. `nodes_at`: numbers of the
    nodes at coordinates (k, 2)."""
    for dofs, stiffness in _of_edges(mesh, order, nodes_at, 2):
        matrix.setValues(dofs.astype(np.int32), dofs.astype(np.int32), stiffness, addv=True)
    matrix.assemble()


def section_springs(mesh: BodyMesh, nodes: np.ndarray) -> sparse.csr_matrix:
    """The foundation's stiffness (3 n, 3 n) per length along the axis between nodes (n, 2) of a section, second
    order."""
    parts = list(_of_edges(mesh, 2, lambda places: numbers_at(nodes, places), 3))
    rows = np.concatenate([np.repeat(dofs, len(dofs)) for dofs, _ in parts])
    columns = np.concatenate([np.tile(dofs, len(dofs)) for dofs, _ in parts])
    values = np.concatenate([stiffness.ravel() for _, stiffness in parts])
    return sparse.csr_matrix((values, (rows, columns)), shape=(3 * len(nodes),) * 2)


def _of_edges(
    mesh: BodyMesh, order: int, nodes_at: Callable[[np.ndarray], np.ndarray], components: int
) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Dofs (k,) of each edge of the outer circle, and the stiffness (k, k) of its springs."""
    shapes = LINEAR if order == 1 else QUADRATIC
    ends = mesh.points[mesh.edges["hub"]]
    places = ends if order == 1 else np.concatenate([ends, ends.mean(axis=1, keepdims=True)], axis=1)
    numbers = nodes_at(places.reshape(-1, 2)).reshape(len(ends), -1)
    for own, edge in zip(numbers, ends):
        yield dofs_of(own, components), edge_stiffness(edge, shapes, mesh.foundation, components)


def edge_stiffness(
    ends: np.ndarray, shapes: np.ndarray, springs: tuple[float, float], components: int = 2
) -> np.ndarray:
    """Stiffness (c k, c k) of the radial and tangential springs along an edge (2, 2), about the origin; `shapes` (k,
    points) at PLACES."""
    at = (1.0 - PLACES)[:, None] * ends[0] + PLACES[:, None] * ends[1]
    radial = at / np.linalg.norm(at, axis=1)[:, None]
    outwards = np.pad(np.einsum("pi,pj->pij", radial, radial), ((0, 0), *[(0, components - 2)] * 2))
    per_area = springs[1] * np.eye(components) + (springs[0] - springs[1]) * outwards
    weights = 0.5 * np.linalg.norm(ends[1] - ends[0]) * GAUSS_WEIGHTS
    return np.einsum("p,ap,bp,pij->aibj", weights, shapes, shapes, per_area).reshape(components * len(shapes), -1)
