"""A swept gear whose layers are thin near the lines of contact alone. Each node of the section has layers of its own
along the face, halved where it needs them: displacements are the sum of the section's shapes times parabolas along the
face, and remain continuous whatever the neighbours have."""

from dataclasses import dataclass

import numpy as np
from scipy import sparse
from tests.face_reference.section_mesh import Section
from tests.face_reference.swept_gear import Sweep, line_shapes, wedges

from fenics_gears import Material
from fenics_gears.elasticity.mumps import Factor

WEDGES_AT_ONCE = 6000


@dataclass(frozen=True)
class Grading:
    """Layers' thickness: `finest` of the thinnest, mm, within `near` mm of a line of contact, thicker by `growth` per
    distance, `halvings` from thinnest to thickest."""

    near: float = 0.25
    growth: float = 0.7
    halvings: int = 4


def halvings_wanted(distances: np.ndarray, finest: float, grading: Grading) -> np.ndarray:
    """How often the thinnest layer is doubled (n, layers), for distances (mm) of nodes from the lines of contact."""
    size = finest + grading.growth * np.maximum(distances - grading.near, 0.0)
    found = np.full(size.shape, -1, dtype=np.int8)
    for doubled in range(grading.halvings, -1, -1):
        width = 2**doubled
        least = size.reshape(len(size), -1, width).min(axis=2)
        free = found.reshape(least.shape + (width,)).max(axis=2) < 0
        fits = free & ((least >= (1 - 1e-9) * width * finest) | (doubled == 0))
        found[np.repeat(fits, width, axis=1)] = doubled
    return found


class GradedGear:
    """`doubled` (n, layers): of each node of the section (`halvings_wanted`)."""

    def __init__(self, section: Section, sweep: Sweep, material: Material, doubled: np.ndarray):
        self.section, self.sweep, self._material, self._doubled = section, sweep, material, doubled
        self.nodes, self.layers = len(section.points), doubled.shape[1]
        self.spread = self._spread()
        self.unknowns = self.spread.shape[1]

    def _spread(self) -> sparse.csc_matrix:
        """Displacements at all levels of all nodes by the unknowns."""
        rows, columns, values = [], [], []
        for layer in range(self.layers):
            width = 2 ** self._doubled[:, layer].astype(int)
            first = layer // width * width
            for step in (0, 1) if layer < self.layers - 1 else (0, 1, 2):
                half = 2 * layer + step
                shape = line_shapes((half - 2 * first) / width - 1.0)[0]
                for third in range(3):
                    rows.append(half * self.nodes + np.arange(self.nodes))
                    columns.append((2 * first + third * width) * self.nodes + np.arange(self.nodes))
                    values.append(shape[:, third])
        values = np.concatenate(values)
        columns = np.concatenate(columns)
        there = np.abs(values) > 1e-12
        held = np.isin(columns % self.nodes, self.section.held)
        used = np.unique(columns[there & ~held])
        there &= ~held
        place = np.searchsorted(used, columns[there])
        size = (2 * self.layers + 1) * self.nodes
        scalar = sparse.csr_matrix((values[there], (np.concatenate(rows)[there], place)), (size, len(used)))
        return sparse.kron(scalar, sparse.identity(3), format="csr")

    def factorised(self) -> Factor:
        return Factor(self._stiffness(), "the graded gear's stiffness")

    def _stiffness(self) -> sparse.csr_matrix:
        height = self.sweep.heights[2] - self.sweep.heights[0]
        of_cells = self._doubled[self.section.cells].min(axis=1)
        total = None
        for doubled in np.unique(of_cells):
            width = 2 ** int(doubled)
            here = (of_cells == doubled)[:, ::width]
            cells = np.flatnonzero(here.any(axis=1))
            made = wedges(self.section, self.section.cells[cells], width * height, self.sweep.twist, self._material)
            stiffness = np.concatenate([each for _, each in made])
            which, layer = np.nonzero(here[cells])
            for first in range(0, len(which), WEDGES_AT_ONCE):
                part = slice(first, first + WEDGES_AT_ONCE)
                block = self._block(self.section.cells[cells[which[part]]], layer[part] * width, width,
                                    stiffness[which[part]])  # fmt: skip
                total = block if total is None else total + block
        return total

    def _block(self, cells, layer, width, stiffness) -> sparse.csr_matrix:
        levels = 2 * layer[:, None] + width * np.arange(3)
        nodes = (levels[:, :, None] * self.nodes + cells[:, None, :]).reshape(-1, 18)
        dofs = (3 * nodes[:, :, None] + np.arange(3)).reshape(-1, 54)
        used, dofs = np.unique(dofs, return_inverse=True)
        dofs = dofs.reshape(-1, 54).astype(np.int32)
        rows, columns = np.repeat(dofs, 54, axis=1).ravel(), np.tile(dofs, (1, 54)).ravel()
        whole = sparse.coo_matrix((stiffness.ravel(), (rows, columns)), (len(used), len(used))).tocsr()
        spread = self.spread[used]
        return (spread.T @ whole @ spread).tocsr()
