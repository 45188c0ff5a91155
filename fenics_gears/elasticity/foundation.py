"""Springs evenly over the outer circle of an internal gear: its elastic foundation, in a sector's stiffness."""

import numpy as np

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
    shapes = LINEAR if order == 1 else QUADRATIC
    ends = mesh.points[mesh.edges["hub"]]
    places = ends if order == 1 else np.concatenate([ends, ends.mean(axis=1, keepdims=True)], axis=1)
    numbers = nodes_at(places.reshape(-1, 2)).reshape(len(ends), -1)
    for own, edge in zip(numbers, ends):
        dofs = (2 * own[:, None] + np.arange(2)).ravel().astype(np.int32)
        matrix.setValues(dofs, dofs, edge_stiffness(edge, shapes, mesh.foundation), addv=True)
    matrix.assemble()


def edge_stiffness(ends: np.ndarray, shapes: np.ndarray, springs: tuple[float, float]) -> np.ndarray:
    """Stiffness (2 k, 2 k) of the radial and tangential springs along an edge (2, 2), about the origin; `shapes` (k,
    points) at PLACES."""
    at = (1.0 - PLACES)[:, None] * ends[0] + PLACES[:, None] * ends[1]
    radial = at / np.linalg.norm(at, axis=1)[:, None]
    across = np.column_stack([-radial[:, 1], radial[:, 0]])
    per_area = sum(each * np.einsum("pi,pj->pij", way, way) for each, way in zip(springs, (radial, across)))
    weights = 0.5 * np.linalg.norm(ends[1] - ends[0]) * GAUSS_WEIGHTS
    return np.einsum("p,ap,bp,pij->aibj", weights, shapes, shapes, per_area).reshape(2 * len(shapes), -1)
