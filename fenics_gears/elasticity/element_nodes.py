"""Nodes of a meshed body, numbered from its mesh alone and not as the finite element library numbers them."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fenics_gears.errors import ComputationError
from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.involute import arc_length, roll_angle_at_arc_length

from .elements import Element
from .mesh_data import BodyMesh, distinct, sides_of

# Cells of straight sides into which the nodes of a second-order cell divide it.
SUBCELLS = {
    (3, 1): [[0, 1, 2]],
    (3, 2): [[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]],
    (4, 1): [[0, 1, 2, 3]],
    (4, 2): [[0, 4, 8, 7], [4, 1, 5, 8], [8, 5, 2, 6], [7, 8, 6, 3]],
}


@dataclass(frozen=True)
class ElementNodes:
    """Nodes of a body's elements: the mesh's points, then, of second order, the middles of its sides and of
    quadrilaterals.

    points: (n, 2), the mesh's unit of length. cells: (m, k) node indices: corners counter-clockwise, middles of the
    sides in the same order, the middle of a quadrilateral.
    """

    points: np.ndarray
    cells: np.ndarray
    corners: int
    order: int

    @property
    def middles(self) -> np.ndarray:
        """Means (m, 2) of the cells' corners."""
        return self.points[self.cells[:, : self.corners]].mean(axis=1)

    @property
    def subcells(self) -> np.ndarray:
        """First-order cells (j, 3) or (j, 4) over all nodes."""
        return np.vstack([self.cells[:, part] for part in SUBCELLS[self.corners, self.order]])

    @cached_property
    def boundary_sides(self) -> np.ndarray:
        """Sides (j, 2), or (j, 3) with the middle last, that belong to one cell only."""
        sides = sides_of(self.cells[:, : self.corners])
        _, number = distinct(sides)
        outer = np.flatnonzero(np.bincount(number)[number] == 1)
        outer = outer[np.argsort(number[outer])]
        if self.order == 1:
            return sides[outer]
        return np.column_stack([sides[outer], self.cells[:, self.corners : 2 * self.corners].reshape(-1)[outer]])


def element_nodes(mesh: BodyMesh, element: Element) -> ElementNodes:
    """The nodes of a body meshed with an element."""
    if element.order == 1:
        return ElementNodes(mesh.points, mesh.cells, element.corners, 1)
    unique, of_cell = distinct(sides_of(mesh.cells))
    points = [mesh.points, mesh.points[unique].mean(axis=1)]
    cells = [mesh.cells, len(mesh.points) + of_cell.reshape(mesh.cells.shape)]
    if element.quadrilateral:
        points.append(mesh.points[mesh.cells].mean(axis=1))
        cells.append(len(mesh.points) + len(unique) + np.arange(len(mesh.cells))[:, None])
    return ElementNodes(np.vstack(points), np.hstack(cells), element.corners, 2)


def numbers_at(nodes: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Numbers (k,) of the nodes (n, 2) at places (k, 2); ComputationError where there is none, or more than one."""
    # 50 ms that a run with gears from the cache does not take.
    from scipy.spatial import cKDTree

    distance, nearest = cKDTree(nodes).query(places, k=2)
    tolerance = 1e-9 * np.abs(nodes).max()
    for wrong, what in ((distance[:, 0] > tolerance, "no node"), (distance[:, 1] <= tolerance, "more than one node")):
        if wrong.any():
            x, y = places[np.flatnonzero(wrong)[0]]
            raise ComputationError(
                f"body: {what} at x = {x:.6f}, y = {y:.6f} in the mesh's unit of length, of a part of the boundary"
            )
    return nearest[:, 0]


def dofs_of(nodes: np.ndarray, components: int = 2) -> np.ndarray:
    """Dofs (components k,) of nodes (k,)."""
    return (components * np.asarray(nodes)[:, None] + np.arange(components)).ravel()


def node_roll_angles(gear: Gear, vertices: np.ndarray, order: int) -> np.ndarray:
    """Roll angles (n,), rad, of the flank's nodes from its element vertices (k, 2), form circle to tip; a node between
    two vertices is midway in arc length."""
    radius = np.linalg.norm(vertices, axis=1)
    # Round-off may put the first vertex a hair below the base circle, where the form circle can lie.
    vertex_angles = gear.roll_angle(np.maximum(radius, abs(gear.base_radius)))
    if order == 1:
        return vertex_angles
    length = arc_length(gear.base_radius, vertex_angles)
    nodes = np.empty(2 * len(length) - 1)
    nodes[::2] = vertex_angles
    nodes[1::2] = roll_angle_at_arc_length(gear.base_radius, 0.5 * (length[1:] + length[:-1]))
    return nodes
