"""A gear swept along its helix in eighteen-node wedges, bore held, factorised by MUMPS. Displacements are in the
frame that turns with the helix: layers of one thickness have one matrix."""

from dataclasses import dataclass

import numpy as np
from scipy import sparse
from tests.face_reference.section_mesh import Section, rotated

from fenics_gears import Material
from fenics_gears.elasticity.mumps import Factor

# Six points of degree 4 on the triangle (Dunavant 1985) and three of Gauss.
_A, _B, _WA, _WB = 0.445948490915965, 0.091576213509771, 0.223381589678011, 0.109951743655322
TRIANGLE_POINTS = np.array([(_A, _A), (1 - 2 * _A, _A), (_A, 1 - 2 * _A), (_B, _B), (1 - 2 * _B, _B), (_B, 1 - 2 * _B)])
TRIANGLE_WEIGHTS = 0.5 * np.array([_WA] * 3 + [_WB] * 3)
CELLS_AT_ONCE = 400


def line_shapes(t) -> tuple[np.ndarray, np.ndarray]:
    """Quadratic shape functions (..., 3) of nodes at -1, 0, 1 and their derivatives."""
    t = np.asarray(t, dtype=float)
    return np.stack([0.5 * t * (t - 1), 1 - t * t, 0.5 * t * (t + 1)], axis=-1), np.stack(
        [t - 0.5, -2 * t, t + 0.5], axis=-1
    )


def _triangle_shapes(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Shape functions (q, 6) of corners and middles, and derivatives (q, 6, 2)."""
    r, s = points.T
    corner = np.stack([1 - r - s, r, s], axis=-1)
    slope = np.array([[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]])
    ends = ((0, 1), (1, 2), (2, 0))
    value = np.concatenate(
        [corner * (2 * corner - 1), np.stack([4 * corner[:, a] * corner[:, b] for a, b in ends], axis=-1)], axis=1
    )
    at_corner = (4 * corner - 1)[:, :, None] * slope
    at_side = np.stack([4 * (corner[:, a, None] * slope[b] + corner[:, b, None] * slope[a]) for a, b in ends], axis=1)
    return value, np.concatenate([at_corner, at_side], axis=1)


@dataclass(frozen=True)
class Sweep:
    """`heights` (2 layers + 1,), mm; `twist`, rad/mm counter-clockwise; `plane`: axial displacements held
    everywhere."""

    heights: np.ndarray
    twist: float = 0.0
    plane: bool = False


def layer_stiffness(section: Section, thickness: float, twist: float, material: Material) -> sparse.csr_matrix:
    """Stiffness (9 n, 9 n) of one layer on its three levels, each in its own turned frame."""
    count, number = len(section.points), np.arange(3)
    rows, columns, entries = [], [], []
    for cells, stiffness in wedges(section, section.cells, thickness, twist, material):
        nodes = np.concatenate([cells + level * count for level in number], axis=1)
        dofs = (3 * nodes[:, :, None] + number).reshape(-1, 54).astype(np.int32)
        rows.append(np.repeat(dofs, 54, axis=1).ravel())
        columns.append(np.tile(dofs, (1, 54)).ravel())
        entries.append(stiffness.ravel())
    shape = (9 * count, 9 * count)
    return sparse.coo_matrix((np.concatenate(entries), (np.concatenate(rows), np.concatenate(columns))), shape).tocsr()


def wedges(section: Section, all_cells: np.ndarray, thickness: float, twist: float, material: Material):
    """Cells (c, 6) some at a time, and stiffness (c, 54, 54) of the wedges on them, node by node of their three
    levels."""
    flat, flat_slope = _triangle_shapes(TRIANGLE_POINTS)
    gauss, gauss_weights = np.polynomial.legendre.leggauss(3)
    line, line_slope = line_shapes(gauss)
    weights = np.kron(gauss_weights, TRIANGLE_WEIGHTS)
    # Nodes of a wedge: level by level.
    slope = np.concatenate([
        np.einsum("gl,qnd->gqlnd", line, flat_slope), np.einsum("gl,qn->gqln", line_slope, flat)[..., None]
    ], axis=-1).reshape(len(weights), 18, 3)  # fmt: skip
    levels = thickness * np.array([0.0, 0.5, 1.0])
    elasticity, turn = _elasticity(material), _frames(twist * levels)
    for first in range(0, len(all_cells), CELLS_AT_ONCE):
        cells = all_cells[first : first + CELLS_AT_ONCE]
        points = np.concatenate(
            [
                np.concatenate([rotated(section.points[cells], twist * z), np.full((*cells.shape, 1), z)], axis=-1)
                for z in levels
            ],
            axis=1,
        )
        stiffness = _wedge_stiffness(points, slope, weights, elasticity)
        in_space = np.zeros((54, 54))
        for node, frame in enumerate(turn):
            in_space[3 * node : 3 * node + 3, 3 * node : 3 * node + 3] = frame
        yield cells, in_space.T @ stiffness @ in_space


def _frames(angles: np.ndarray) -> np.ndarray:
    """For the wedge's nodes (18, 3, 3): components in space from those in their level's frame."""
    turn = np.zeros((3, 3, 3))
    turn[:, 0, 0] = turn[:, 1, 1] = np.cos(angles)
    turn[:, 1, 0], turn[:, 0, 1], turn[:, 2, 2] = np.sin(angles), -np.sin(angles), 1.0
    return np.repeat(turn, 6, axis=0)


def _elasticity(material: Material) -> np.ndarray:
    """Hooke's law (6, 6), engineering shears."""
    young, poisson = material.youngs_modulus, material.poissons_ratio
    shear = 0.5 * young / (1 + poisson)
    law = np.diag([2 * shear] * 3 + [shear] * 3)
    law[:3, :3] += young * poisson / ((1 + poisson) * (1 - 2 * poisson))
    return law


def _wedge_stiffness(points, slope, weights, elasticity) -> np.ndarray:
    total = np.zeros((len(points), 54, 54))
    for at, weight in zip(slope, weights):
        jacobian = np.einsum("cni,nd->cid", points, at)
        gradient = np.einsum("nd,cdi->cni", at, np.linalg.inv(jacobian))
        strain = np.zeros((len(points), 6, 18, 3))
        for axis in range(3):
            strain[:, axis, :, axis] = gradient[:, :, axis]
        for row, (a, b) in enumerate(((0, 1), (1, 2), (2, 0)), 3):
            strain[:, row, :, a], strain[:, row, :, b] = gradient[:, :, b], gradient[:, :, a]
        strain = strain.reshape(len(points), 6, 54)
        scaled = (weight * np.linalg.det(jacobian))[:, None, None] * (elasticity @ strain)
        total += strain.transpose(0, 2, 1) @ scaled
    return total


class SweptGear:
    def __init__(self, section: Section, sweep: Sweep, material: Material):
        self.section, self.sweep = section, sweep
        self.nodes = len(section.points)
        levels = len(sweep.heights)
        held = (3 * (np.arange(levels)[:, None, None] * self.nodes + section.held[:, None]) + np.arange(3)).ravel()
        free = np.ones(3 * self.nodes * levels, dtype=bool)
        free[held] = False
        if sweep.plane:
            free[2::3] = False
        # Displacements of all nodes by the unknowns.
        self.spread = sparse.identity(len(free), format="csc")[:, free]
        self.unknowns = int(free.sum())
        self._free, self._material = free, material

    def factorised(self) -> Factor:
        return Factor(self._stiffness(self._material)[self._free][:, self._free], "the swept gear's stiffness")

    def _stiffness(self, material: Material) -> sparse.csr_matrix:
        heights, made, blocks = self.sweep.heights, {}, []
        size = 3 * self.nodes * len(heights)
        for layer in range(len(heights) // 2):
            thickness = round(heights[2 * layer + 2] - heights[2 * layer], 9)
            if thickness not in made:
                made[thickness] = layer_stiffness(self.section, thickness, self.sweep.twist, material).tocoo()
            first, block = 6 * self.nodes * layer, made[thickness]
            blocks.append((block.data, block.row.astype(np.int32) + first, block.col.astype(np.int32) + first))
        data, rows, columns = (np.concatenate(parts) for parts in zip(*blocks))
        del blocks, made
        return sparse.coo_matrix((data, (rows, columns)), (size, size)).tocsr()
