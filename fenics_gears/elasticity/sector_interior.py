"""The inside of a tooth sector between its held cuts and hub: its stiffness factored once by PETSc, solved for any
load."""

from __future__ import annotations

import numpy as np
from scipy import sparse
from scipy.spatial import cKDTree

from fenics_gears.elasticity.condensation import by_radius, dofs_of, without
from fenics_gears.elasticity.element_nodes import element_nodes
from fenics_gears.elasticity.elements import Element
from fenics_gears.elasticity.mesh_data import BodyMesh
from fenics_gears.elasticity.mumps import Factor
from fenics_gears.elasticity.stiffness import compile_ahead, displacement_space, nodes_at, stiffness_matrix
from fenics_gears.errors import ComputationError


class SectorInterior:
    """A meshed sector, Young's modulus 1 MPa, unit thickness; nodes are those of `nodes` (ElementNodes), dofs
    interleaved x, y.

    lower, upper: (c,) nodes of the cuts by radius, without those on the hub; hub: (h,). stiffness: (2 n, 2 n) sparse,
        of all nodes.
    Release the factor by `close`.
    """

    def __init__(self, mesh: BodyMesh, element: Element, poissons_ratio: float):
        self.mesh, self.element, self.poissons_ratio = mesh, element, poissons_ratio
        self.nodes = element_nodes(mesh, element)
        self.hub = self._at(hub := mesh.edge_nodes("hub", element.order))
        self.lower, self.upper = (
            self._at(by_radius(without(mesh.edge_nodes(cut, element.order), hub))) for cut in ("lower cut", "upper cut")
        )
        self.stiffness = self._assembled()
        held = np.concatenate([self.lower, self.upper, self.hub])
        self.free = dofs_of(np.setdiff1d(np.arange(len(self.nodes.points)), held))
        self._factor = Factor(self.stiffness[self.free][:, self.free], "a tooth sector for its stresses")
        self._to_lower, self._to_upper = (
            self.stiffness[self.free][:, dofs_of(cut)] for cut in (self.lower, self.upper)
        )

    def close(self) -> None:
        """Give the factor's memory back."""
        self._factor.close()

    def flank_nodes(self, side: str) -> np.ndarray:
        """Nodes (k,) of the "flank" or the "coast" flank by radius, as the flank compliance has them."""
        return self._at(by_radius(self.mesh.edge_nodes(side, self.element.order)))

    def at_held_cuts(self, loads: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Loads (2 c, k) that reach the lower and the upper cut from loads (2 n, k) on any nodes while cuts and hub are
        held."""
        inside = self._factor.solve(loads[self.free])
        return tuple(
            loads[dofs_of(cut)] - coupling.T @ inside
            for cut, coupling in ((self.lower, self._to_lower), (self.upper, self._to_upper))
        )

    def between_cuts(self, lower: np.ndarray, upper: np.ndarray, loads: np.ndarray) -> np.ndarray:
        """Displacement (2 n, k) under loads (2 n, k) inside, where the cuts move by lower and upper (2 c, k), the hub
        held."""
        displacement = np.zeros_like(loads)
        displacement[dofs_of(self.lower)], displacement[dofs_of(self.upper)] = lower, upper
        displacement[self.free] = self._factor.solve(loads[self.free] - self._to_lower @ lower - self._to_upper @ upper)
        return displacement

    def _at(self, coordinates: np.ndarray) -> np.ndarray:
        distance, found = cKDTree(self.nodes.points).query(coordinates)
        if distance.max(initial=0.0) > 1e-9 * np.abs(self.nodes.points).max():
            raise ComputationError("recovery: a node of the sector's boundary is not among the nodes of its elements")
        return found

    def _assembled(self) -> sparse.csr_matrix:
        compile_ahead(self.element)
        space = displacement_space(self.mesh, self.element)
        matrix = stiffness_matrix(space, self.element, self.poissons_ratio, self.mesh.web)
        starts, columns, values = matrix.getValuesCSR()
        assembled = sparse.csr_matrix((values.copy(), columns.copy(), starts.copy()), shape=matrix.getSize())
        matrix.destroy()
        order = dofs_of(nodes_at(space, self.nodes.points))
        return assembled[order][:, order]
