"""A plane mesh as plain arrays, and the checks of its cells."""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_matrix

from fenics_gears.errors import ComputationError
from fenics_gears.geometry.gear_data import Web


@dataclass(frozen=True)
class BodyMesh:
    """Straight-sided mesh of a gear body or of a sector of it.

    points: (n, 2), mm (modules where a sector was meshed in them), in the canonical frame of its tooth (of tooth 0 for
    a whole gear). cells: (m, 3) triangles or (m, 4) quadrilaterals, corners counter-clockwise. edges: named parts of
    the boundary, each (k, 2) point indices. A sector has "flank", "hub", "lower cut" and "upper cut" (clockwise and
    counter-clockwise side; of an internal gear the other way round); a whole gear has "hub" and "flank 0", "flank 1",
    ... counted counter-clockwise. web: part of the body that is less wide than the rest. foundation: springs on the
    hub, as of a `Gear`; None where it is held.
    """

    points: np.ndarray
    cells: np.ndarray
    edges: dict[str, np.ndarray]
    web: Web | None = None
    foundation: tuple[float, float] | None = None

    def edge_points(self, name: str) -> np.ndarray:
        """Sorted point indices of a named part of the boundary."""
        if name not in self.edges:
            known = ", ".join(sorted(self.edges))
            raise ComputationError(f"mesh: no boundary part '{name}'; there are: {known}")
        return np.unique(self.edges[name])

    def edge_nodes(self, name: str, order: int) -> np.ndarray:
        """Coordinates of the nodes of an element of that order on a named part, (k, 2)."""
        corners = self.points[self.edge_points(name)]
        if order == 1:
            return corners
        return np.vstack([corners, self.points[self.edges[name]].mean(axis=1)])


def corner_areas(points: np.ndarray, cells: np.ndarray) -> np.ndarray:
    """Twice the signed area of the triangle at each corner of each cell, (cells, corners): all positive exactly when
    every cell's Jacobian determinant is positive everywhere."""
    corner = points[cells]
    ahead = np.roll(corner, -1, axis=1) - corner
    behind = np.roll(corner, 1, axis=1) - corner
    return ahead[..., 0] * behind[..., 1] - ahead[..., 1] * behind[..., 0]


def oriented(points: np.ndarray, cells: np.ndarray) -> np.ndarray:
    """Cells with their corners counter-clockwise; raises ComputationError for a folded one."""
    clockwise = corner_areas(points, cells).sum(axis=1) < 0
    turned = np.where(clockwise[:, None], cells[:, ::-1], cells)
    folded = np.flatnonzero(corner_areas(points, turned).min(axis=1) <= 0)
    if folded.size:
        where = points[turned[folded[0]]].mean(axis=0)
        raise ComputationError(
            f"mesh: {folded.size} of {len(cells)} cells have a Jacobian determinant that is not positive, "
            f"the first near x = {where[0]:.3f}, y = {where[1]:.3f} in the mesh's unit of length; "
            "choose other element sizes or a triangular element"
        )
    return turned


def sides_of(cells: np.ndarray) -> np.ndarray:
    """Sides (cells times corners, 2), one cell's after the other's, as they run counter-clockwise."""
    return np.stack([cells, np.roll(cells, -1, axis=1)], axis=-1).reshape(-1, 2)


def distinct(sides: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Sides (k, 2) each once, ascending, the smaller point first; and the number among them of each given side (j,
    2)."""
    # By one number for each side: numpy takes ten times as long to sort rows.
    size = sides.max(initial=0) + 1
    numbers, places = np.unique(np.sort(sides, axis=1) @ [size, 1], return_inverse=True)
    return np.stack(np.divmod(numbers, size), axis=-1), places.ravel()


def boundary_sides(cells: np.ndarray) -> np.ndarray:
    """Sides (k, 2) that belong to one cell only, the smaller point first."""
    sides, of_cells = distinct(sides_of(cells))
    return sides[np.bincount(of_cells) == 1]


def joined_cells(cells: np.ndarray) -> np.ndarray:
    """Number of the connected piece of each cell (cells,); cells hold together along whole sides."""
    from scipy.sparse.csgraph import connected_components

    sides, of_cells = distinct(sides_of(cells))
    owner = np.repeat(np.arange(len(cells)), cells.shape[1])
    incidence = coo_matrix((np.ones(len(owner)), (owner, of_cells)), shape=(len(cells), len(sides))).tocsr()
    return connected_components(incidence @ incidence.T, directed=False)[1]


def split_to_quadrilaterals(
    points: np.ndarray, polygons: list[np.ndarray], exact: dict[tuple[int, int], np.ndarray]
) -> tuple[np.ndarray, np.ndarray, dict[tuple[int, int], int]]:
    """Split every triangle into three and every quadrilateral into four quadrilaterals.

    polygons: (k, 3) and (k, 4) arrays of point indices. exact: where the new point of a boundary edge (smaller index
    first) lies if not midway. Returns the points, the cells and the new point of each edge.
    """
    unique_sides, side_of = distinct(np.vstack([sides_of(cells) for cells in polygons]))
    middle = points[unique_sides].mean(axis=1)
    middle_index = {tuple(side): len(points) + i for i, side in enumerate(unique_sides.tolist())}
    for side, position in exact.items():
        middle[middle_index[side] - len(points)] = position
    all_points = [points, middle]
    quadrilaterals = []
    used = 0
    count = len(points) + len(middle)
    for cells in polygons:
        corners = cells.shape[1]
        ahead = len(points) + side_of[used : used + cells.size].reshape(cells.shape)
        used += cells.size
        centre = count + np.arange(len(cells))
        count += len(cells)
        all_points.append(points[cells].mean(axis=1))
        for corner in range(corners):
            quadrilaterals.append(np.stack([cells[:, corner], ahead[:, corner], centre, ahead[:, corner - 1]], axis=1))
    return np.vstack(all_points), np.vstack(quadrilaterals), middle_index
