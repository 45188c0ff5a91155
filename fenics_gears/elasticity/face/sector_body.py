"""A swept tooth sector factored once, its hub held: its stiffness between the cuts, and its displacement under any
load."""

from __future__ import annotations

import numpy as np

from fenics_gears.elasticity.condensation import by_radius, dofs_of, without
from fenics_gears.elasticity.face.layers import Sweep, swept_nodes
from fenics_gears.elasticity.face.swept_stiffness import ELEMENT, SectionForms, swept_stiffness
from fenics_gears.elasticity.mesh_data import BodyMesh
from fenics_gears.elasticity.mumps import Factor


class SectorBody:
    """A swept sector, Young's modulus 1 MPa; nodes by height, then the section's; dofs interleaved x, y, z in the
    section's frame turned with it.

    `section`: nodes (ElementNodes) of the plane mesh. lower, upper: (c,) nodes of the cuts by height and radius,
        without those on the `hub`.
    between_cuts: (6 c, 6 c), stiffness of the sector between its cuts. Release the factor by `close`.
    """

    def __init__(self, mesh: BodyMesh, sweep: Sweep, poissons_ratio: float):
        self.mesh, self.sweep, self.poissons_ratio = mesh, sweep, poissons_ratio
        forms = SectionForms(mesh, poissons_ratio)
        self.section, self.heights = forms.nodes, sweep.heights
        hub = mesh.edge_nodes("hub", ELEMENT.order)
        self.hub = self.swept(hub)
        self.lower, self.upper = (
            self.swept(by_radius(without(mesh.edge_nodes(f"{cut} cut", ELEMENT.order), hub)))
            for cut in ("lower", "upper")
        )
        free = np.ones(3 * self.nodes, dtype=bool)
        free[dofs_of(self.hub, 3)] = False
        self._free, number = np.flatnonzero(free), np.cumsum(free) - 1
        self._cuts = dofs_of(np.concatenate([self.lower, self.upper]), 3)
        stiffness = swept_stiffness(forms, sweep)[free][:, free]
        self._factor = Factor(stiffness, "a swept tooth sector for its stresses", number[self._cuts])
        # Before any solve: then the factor holds it no longer as it is.
        self.between_cuts = self._factor.schur()

    def close(self) -> None:
        """Give the factor's memory back."""
        self._factor.close()

    @property
    def nodes(self) -> int:
        """Number of nodes."""
        return len(self.section.points) * len(self.heights)

    def swept(self, line: np.ndarray) -> np.ndarray:
        """Nodes (heights k,) swept from places (k, 2) of the section, by height."""
        return swept_nodes(self.section.points, line, len(self.heights))

    def place(self, nodes: np.ndarray) -> np.ndarray:
        """X, Y, z (k, 3) of nodes (k,)."""
        count = len(self.section.points)
        return np.column_stack([self.section.points[nodes % count], self.heights[nodes // count]])

    def flank_nodes(self, side: str) -> np.ndarray:
        """Nodes (heights f,) of the "flank" or the "coast" flank by height and radius, as the face compliance has
        them."""
        return self.swept(by_radius(self.mesh.edge_nodes(side, ELEMENT.order)))

    def free_motion(self, loads: np.ndarray) -> np.ndarray:
        """Displacement (3 n, k) under loads (3 n, k), the cuts free."""
        found = np.zeros_like(loads)
        found[self._free] = self._factor.solve(loads[self._free])
        return found

    def at_cuts(self, vectors: np.ndarray) -> np.ndarray:
        """Rows (6 c, k) of the lower, then of the upper cut."""
        return vectors[self._cuts]

    def pulled(self, forces: np.ndarray) -> np.ndarray:
        """Loads (3 n, k) of forces (6 c, k) on the cuts alone."""
        loads = np.zeros((3 * self.nodes, forces.shape[1]))
        loads[self._cuts] = forces
        return loads
