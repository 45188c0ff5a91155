"""Condense a meshed body onto chosen parts of its boundary."""

from __future__ import annotations

from dataclasses import dataclass
from time import perf_counter

import numpy as np

from fenics_gears.elasticity.elements import Element
from fenics_gears.elasticity.mesh_data import BodyMesh
from fenics_gears.elasticity.schur import schur_complement
from fenics_gears.elasticity.stiffness import compile_ahead, displacement_space, nodes_at, nodes_in_cells, stiffness_matrix


@dataclass(frozen=True)
class CondensedBody:
    """Stiffness of a body on named groups of boundary nodes, Young's modulus 1 MPa, unit thickness.

    points: coordinates (k, 2) of each group's nodes, mm. stiffness: (2 K, 2 K), N/mm per mm, over the groups in the order of
    ``points``, dofs interleaved x, y, in the mesh's own frame. timings: seconds and unknowns.
    """

    points: dict[str, np.ndarray]
    stiffness: np.ndarray
    timings: dict

    def dofs(self, name: str) -> np.ndarray:
        """Rows of a group's dofs."""
        names = list(self.points)
        first = 2 * sum(len(self.points[other]) for other in names[: names.index(name)])
        return np.arange(first, first + 2 * len(self.points[name]))

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

    cells_of: for groups with several nodes in one place, as on the faces of a crack, the centre (k, 2) of a cell of each node.
    """
    clock = perf_counter()
    compile_ahead(element)
    compiled = perf_counter()
    space = displacement_space(mesh, element)
    matrix = stiffness_matrix(space, element, poissons_ratio)
    assembled = perf_counter()
    cells_of = cells_of or {}
    nodes = np.concatenate([
        nodes_in_cells(space, places, cells_of[name]) if name in cells_of else nodes_at(space, places) for name, places in points.items()
    ])
    stiffness = schur_complement(matrix, (2 * nodes[:, None] + [0, 1]).ravel())
    unknowns = matrix.getSize()[0]
    matrix.destroy()
    timings = {
        "time_compile": compiled - clock,
        "time_assemble": assembled - compiled,
        "time_schur": perf_counter() - assembled,
        "unknowns": unknowns,
        "condensed_unknowns": len(stiffness),
    }
    return CondensedBody(points, stiffness, timings)


def by_radius(points: np.ndarray) -> np.ndarray:
    """Points (k, 2) sorted by their distance from the gear's centre."""
    return points[np.argsort(np.linalg.norm(points, axis=1))]


def without(points: np.ndarray, excluded: np.ndarray) -> np.ndarray:
    """Points (k, 2) without the excluded ones (j, 2)."""
    distance = np.linalg.norm(points[:, None] - excluded[None], axis=-1).min(axis=1)
    return points[distance > 1e-9 * np.abs(points).max()]
