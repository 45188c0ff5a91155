"""A meshed gear divided by tooth sectors into parts that are condensed by themselves; and its cracks, sides of the
boundary that lie on each other.

Any division gives the same result; by teeth the parts are small and meet in short lines of nodes.
"""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.outline import centreline_angle

from ..element_nodes import ElementNodes, element_nodes
from ..elements import Element
from ..mesh_data import BodyMesh


@dataclass(frozen=True)
class Part:
    """One part of a body: its mesh, and nodes of the whole body that are kept of it.

    flank: (f,), by radius. interface: (i,), shared with other parts, not on the hub. hub: (h,). faces: (c,), on the
    faces of cracks, with the centres (c, 2) of a cell of each.
    """

    mesh: BodyMesh
    flank: np.ndarray
    interface: np.ndarray
    hub: np.ndarray
    faces: np.ndarray
    face_cells: np.ndarray


@dataclass(frozen=True)
class CrackNodes:
    """Nodes (k,) on one face of a body's cracks, the opposite nodes (k,), and the normals (k, 2) out of the first face.
    A crack is open by (u[other] - u[one]) . normal."""

    one: np.ndarray
    other: np.ndarray
    normals: np.ndarray

    @property
    def both(self) -> np.ndarray:
        """All of them, ascending."""
        return np.unique(np.concatenate([self.one, self.other]))


@dataclass(frozen=True)
class DividedBody:
    """The nodes of a body, one part for each tooth, all interface nodes (k,), ascending, and its cracks."""

    nodes: ElementNodes
    parts: tuple[Part, ...]
    interface: np.ndarray
    cracks: CrackNodes


def divided_body(mesh: BodyMesh, gear: Gear, element: Element) -> DividedBody:
    """Divide a whole gear (`whole_body.outline`) into its teeth."""
    nodes = element_nodes(mesh, element)
    owner = part_of_cells(mesh, gear)
    hub = nodes_on(nodes, mesh.edges["hub"])
    touched, by = np.divmod(np.unique(gear.teeth * nodes.cells + owner[:, None]), gear.teeth)
    shared = np.flatnonzero(np.bincount(touched, minlength=len(nodes.points)) > 1)
    interface = np.setdiff1d(shared, hub)
    cracks = crack_nodes(nodes)
    parts = []
    for tooth in range(gear.teeth):
        own = touched[by == tooth]
        flank = nodes_on(nodes, mesh.edges[f"flank {tooth}"])
        flank = flank[np.argsort(np.linalg.norm(nodes.points[flank], axis=1))]
        faces = np.setdiff1d(np.intersect1d(own, cracks.both), np.concatenate([interface, hub, flank]))
        parts.append(
            Part(
                _sub_mesh(mesh, owner == tooth), flank, np.intersect1d(own, interface), np.intersect1d(own, hub),
                faces, _centres_of(nodes, faces),
            )
        )  # fmt: skip
    return DividedBody(nodes, tuple(parts), interface, cracks)


def _centres_of(nodes: ElementNodes, chosen: np.ndarray) -> np.ndarray:
    """Centre (k, 2) of a cell of each of the chosen nodes (k,)."""
    flat = nodes.cells.ravel()
    order = np.argsort(flat, kind="stable")
    cells = order[np.searchsorted(flat, chosen, sorter=order)] // nodes.cells.shape[1]
    return nodes.points[nodes.cells[cells]].mean(axis=1)


def part_of_cells(mesh: BodyMesh, gear: Gear) -> np.ndarray:
    """Number of the part (cells,): that of the tooth; all cells on one face of a crack together, and those on a flank
    with its tooth. Parts that shared a node on a crack could not distinguish it from its twin on the other face."""
    centre = mesh.points[mesh.cells].mean(axis=1)
    ahead = np.arctan2(centre[:, 1], centre[:, 0]) - centreline_angle(gear)
    owner = np.floor(np.mod(ahead, 2.0 * np.pi) / gear.angular_pitch + 0.5).astype(int) % gear.teeth
    for face in crack_faces(mesh):
        owner[face] = np.bincount(owner[face]).argmax()
    for tooth in range(gear.teeth):
        on_flank = np.isin(mesh.cells, mesh.edge_points(f"flank {tooth}")).any(axis=1)
        owner[on_flank] = tooth
    return owner


def crack_faces(mesh: BodyMesh) -> list[np.ndarray]:
    """Cells at each face of each crack: those that touch points with a twin in the same place, joined by such
    points."""
    twins = np.unique(cKDTree(mesh.points).query_pairs(1e-9 * np.abs(mesh.points).max(), output_type="ndarray"))
    touching = np.isin(mesh.cells, twins)
    cells = np.flatnonzero(touching.any(axis=1))
    if not len(cells):
        return []
    rows, columns = np.nonzero(touching[cells])
    points = np.searchsorted(twins, mesh.cells[cells[rows], columns])
    incidence = coo_matrix((np.ones(len(rows)), (rows, points)), shape=(len(cells), len(twins))).tocsr()
    count, face = connected_components(incidence @ incidence.T, directed=False)
    return [cells[face == number] for number in range(count)]


def crack_nodes(nodes: ElementNodes) -> CrackNodes:
    """The facing nodes of all cracks of a body; a tip belongs to both faces and is left out."""
    sides = nodes.boundary_sides
    ends = nodes.points[sides[:, :2]]
    tolerance = 1e-9 * np.abs(nodes.points).max()
    pairs = cKDTree(ends.mean(axis=1)).query_pairs(tolerance, output_type="ndarray").reshape(-1, 2)
    one = sides[pairs[:, 0]]
    other = sides[pairs[:, 1]]
    # Cells go counter-clockwise: along a side the body is on the left, and both faces run against each other.
    other = other[:, [1, 0, *range(2, other.shape[1])]]
    along = ends[pairs[:, 0], 1] - ends[pairs[:, 0], 0]
    normals = np.stack([along[:, 1], -along[:, 0]], axis=-1) / np.linalg.norm(along, axis=1)[:, None]
    normals = np.repeat(normals, one.shape[1], axis=0)
    one = one.ravel()
    other = other.ravel()
    apart = one != other
    return CrackNodes(one[apart], other[apart], normals[apart])


def nodes_on(nodes: ElementNodes, sides: np.ndarray) -> np.ndarray:
    """Nodes (k,) on sides (j, 2) of the body's boundary, the middles of second-order ones included."""
    if nodes.order == 1:
        return np.unique(sides)
    table = nodes.boundary_sides
    count = len(nodes.points)
    keys = np.sort(table[:, :2], axis=1) @ [count, 1]
    order = np.argsort(keys)
    numbers = order[np.searchsorted(keys, np.sort(sides, axis=1) @ [count, 1], sorter=order)]
    return np.unique(np.concatenate([np.unique(sides), table[numbers, 2]]))


def _sub_mesh(mesh: BodyMesh, chosen: np.ndarray) -> BodyMesh:
    used, cells = np.unique(mesh.cells[chosen], return_inverse=True)
    return BodyMesh(mesh.points[used], cells.reshape(-1, mesh.cells.shape[1]), {})
