"""Condense a meshed body onto chosen parts of its boundary."""

from dataclasses import dataclass
from functools import partial
from time import perf_counter

import numpy as np

from .element_nodes import dofs_of
from .elements import Element
from .mesh_data import BodyMesh
from .mumps import schur_complement
from .stiffness import compile_ahead, displacement_space, nodes_at, nodes_in_cells, stiffness_matrix


@dataclass(frozen=True)
class CondensedBody:
    """Stiffness of a body on named groups of boundary nodes, Young's modulus 1 MPa, unit thickness.

    points: coordinates of each group's nodes, mm: (k, 2), or (k, 3) in three dimensions. stiffness: (2 K, 2 K), N/mm
    per mm, over the groups in the order of ``points``, dofs interleaved x, y, in the mesh's own frame; (3 K, 3 K),
    N/mm, in three dimensions.
    """

    points: dict[str, np.ndarray]
    stiffness: np.ndarray
    timings: dict

    def dofs(self, name: str) -> np.ndarray:
        """Rows of a group's dofs."""
        names = list(self.points)
        first = sum(self.points[other].size for other in names[: names.index(name)])
        return np.arange(first, first + self.points[name].size)

    def between(self, row: str, column: str) -> np.ndarray:
        """Stiffness block of two groups."""
        return self.stiffness[np.ix_(self.dofs(row), self.dofs(column))]


def condense(
    mesh: BodyMesh,
    element: Element,
    poissons_ratio: float,
    points: dict[str, np.ndarray],
    cells_of: dict[str, np.ndarray] | None = None,
) -> CondensedBody:
    """Schur complement of a body's stiffness onto groups of nodes, disjoint and given by coordinates (mm).

    cells_of: for groups with several nodes in one place, as on the faces of a crack, the centre (k, 2) of a cell of
    each node.
    """
    clock = perf_counter()
    compile_ahead(element)
    timings = {"time_compile": perf_counter() - clock}
    space = displacement_space(mesh, element)
    matrix = stiffness_matrix(space, element, poissons_ratio, mesh.web)
    if mesh.foundation is not None:
        from .foundation import add_foundation

        add_foundation(matrix, mesh, element.order, partial(nodes_at, space))
    stiffness = schur_complement(matrix, dofs_of(_nodes(space, points, cells_of or {})))
    matrix.destroy()
    return CondensedBody(points, stiffness, timings)


def _nodes(space, points: dict[str, np.ndarray], cells_of: dict[str, np.ndarray]) -> np.ndarray:
    """Numbers (K,) of all groups' nodes; unique places are searched for at once, since each search makes a tree."""
    places = {name: group for name, group in points.items() if name not in cells_of}
    ends = np.cumsum([len(group) for group in places.values()])
    nodes = dict(zip(places, np.split(nodes_at(space, np.vstack([*places.values()])), ends[:-1])))
    nodes |= {name: nodes_in_cells(space, points[name], cells) for name, cells in cells_of.items()}
    return np.concatenate([nodes[name] for name in points])


def held_nodes(mesh: BodyMesh, order: int) -> dict[str, np.ndarray]:
    """The group "hub" of nodes that are held; none on a foundation."""
    return {"hub": mesh.edge_nodes("hub", order)} if mesh.foundation is None else {}


def by_radius(points: np.ndarray) -> np.ndarray:
    """Points (k, 2) sorted by their distance from the gear's centre."""
    return points[np.argsort(np.linalg.norm(points, axis=1))]


def line_of(mesh: BodyMesh, name: str, order: int) -> np.ndarray:
    """Nodes (k, 2) of an element of that order on a part of a mesh's boundary, without those of a hub that is held, by
    radius."""
    if mesh.foundation is not None:
        return by_radius(mesh.edge_nodes(name, order))
    return by_radius(without(mesh.edge_nodes(name, order), mesh.edge_nodes("hub", order)))


def without(points: np.ndarray, excluded: np.ndarray) -> np.ndarray:
    """Points (k, 2) without the excluded ones (j, 2)."""
    distance = np.linalg.norm(points[:, None] - excluded[None], axis=-1).min(axis=1)
    return points[distance > 1e-9 * np.abs(points).max()]
