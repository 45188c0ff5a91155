"""A tooth sector factored once, its hub held: its stiffness between the cuts, and its displacement under any load."""

from functools import partial

import numpy as np
from scipy import sparse

from .condensation import by_radius
from .element_nodes import ElementNodes, dofs_of, element_nodes
from .elements import Element
from .face.layers import Sweep, swept_nodes
from .face.swept_stiffness import SectionForms, swept_stiffness
from .foundation import add_foundation
from .mesh_data import BodyMesh
from .mumps import Factor
from .stiffness import assembled, compile_ahead, displacement_space, nodes_at, stiffness_matrix


class Sector:
    """A sector, Young's modulus 1 MPa: plane and of unit thickness, or swept along the face by `sweep`.

    Nodes go by height, then by the section's (ElementNodes); a plane sector has one height. Dofs are interleaved: x, y
    and of a swept sector z, in the section's frame turned with it. cuts: (c,) nodes of the lower and of the upper cut
    by height and radius. hub: (h,). there: (nodes,), which nodes there are, all unless given. The others do not move,
    and are in no link. link: stiffness (2 d, 2 d) between the dofs of both cuts off the hub. Release the factor by
    `close`.
    """

    def __init__(
        self,
        mesh: BodyMesh,
        section: ElementNodes,
        stiffness: sparse.csr_matrix,
        sweep: Sweep | None = None,
        there: np.ndarray | None = None,
    ):
        self.mesh = mesh
        self.section = section
        self.sweep = sweep
        self.components, self.heights = (2, np.zeros(1)) if sweep is None else (3, sweep.heights)
        self.hub = self._swept("hub")
        self.cuts = tuple(self._swept(f"{name} cut") for name in ("lower", "upper"))
        moves = np.ones(self.nodes, dtype=bool) if there is None else there.copy()
        moves[self.hub] = mesh.foundation is not None
        free = np.repeat(moves, self.components)
        self._free = np.flatnonzero(free)
        number = np.cumsum(free) - 1
        self.lower, self.upper = (cut[moves[cut]] for cut in self.cuts)
        self._between = dofs_of(np.concatenate([self.lower, self.upper]), self.components)
        self._factor = Factor(stiffness[free][:, free], "a tooth sector for its stresses", number[self._between])
        # Before any solve: then the factor holds it no longer as it is.
        self.link = self._factor.schur()

    def close(self) -> None:
        """Give the factor's memory back."""
        self._factor.close()

    @property
    def nodes(self) -> int:
        """Number of nodes."""
        return len(self.section.points) * len(self.heights)

    @property
    def held(self) -> np.ndarray:
        """The section's nodes (k,) on cuts and hub."""
        return np.unique(np.concatenate([*self.cuts, self.hub]) % len(self.section.points))

    def flank_nodes(self, side: str) -> np.ndarray:
        """Nodes (heights f,) of the "flank" or the "coast" flank by height and radius, as the compliance has them."""
        return self._swept(side)

    def free_motion(self, loads: np.ndarray) -> np.ndarray:
        """Displacement (dofs, k) under loads (dofs, k), the cuts free."""
        motion = np.zeros_like(loads)
        motion[self._free] = self._factor.solve(loads[self._free])
        return motion

    def at_cuts(self, vectors: np.ndarray) -> np.ndarray:
        """Rows (2 d, k) of the lower, then of the upper cut."""
        return vectors[self._between]

    def pulled(self, forces: np.ndarray) -> np.ndarray:
        """Loads (dofs, k) of forces (2 d, k) on the cuts alone."""
        loads = np.zeros((self.components * self.nodes, forces.shape[1]))
        loads[self._between] = forces
        return loads

    def _swept(self, part: str) -> np.ndarray:
        """Nodes (heights k,) of a part of the section's boundary."""
        line = by_radius(self.mesh.edge_nodes(part, self.section.order))
        return swept_nodes(self.section.points, line, len(self.heights))


def plane_sector(mesh: BodyMesh, element: Element, poissons_ratio: float) -> Sector:
    """A sector in plane strain."""
    compile_ahead(element)
    space = displacement_space(mesh, element)
    nodes = element_nodes(mesh, element)
    matrix = stiffness_matrix(space, element, poissons_ratio, mesh.web)
    if mesh.foundation is not None:
        add_foundation(matrix, mesh, element.order, partial(nodes_at, space))
    stiffness = assembled(matrix)
    order = dofs_of(nodes_at(space, nodes.points))
    return Sector(mesh, nodes, stiffness[order][:, order])


def swept_sector(mesh: BodyMesh, sweep: Sweep, poissons_ratio: float) -> Sector:
    """A sector in three dimensions."""
    forms = SectionForms(mesh, poissons_ratio, sweep.web)
    return Sector(mesh, forms.nodes, swept_stiffness(forms, sweep), sweep, forms.material(sweep).ravel())
