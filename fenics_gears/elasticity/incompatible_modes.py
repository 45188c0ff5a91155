"""The bilinear quadrilateral with Wilson's two incompatible modes, in Taylor's form that passes the patch test on any
cell.

The displacement is ``sum N_i u_i + (1 - xi^2) a_1 + (1 - eta^2) a_2``; the modes' derivatives are taken with the
Jacobian at the cell's centre, ``d(1 - xi^2)/dx = -2 xi (j_0/j) J_0^-T e_xi``, so that a uniform stress does no work on
them. Being a cell's own, the amplitudes `a` are condensed: ``K = K_uu - K_au^T K_aa^-1 K_au``. E. L. Wilson et al.,
Incompatible displacement models, 1973; R. L. Taylor, P. J. Beresford, E. L. Wilson, IJNME 10, 1976, 1211-1219.
"""

import numpy as np
import ufl

from . import dolfinx_adapter as adapter

MODES = 4  # amplitudes of a cell: two modes, two directions
# Reference coordinates of a cell's corners, row by row as DOLFINx numbers them.
XI = np.array([-1.0, 1.0, -1.0, 1.0])
ETA = np.array([-1.0, -1.0, 1.0, 1.0])


def condensed_stiffness(space, stress_of_strain, measure):
    """Assembled PETSc matrix of a bilinear displacement space with the modes condensed; its sparsity is the space's
    own.

    stress_of_strain: UFL stress of a UFL strain. measure: cells, with the full Gauss rule.
    """
    displacements, coupling, modes = (
        adapter.assemble_matrix(form) for form in mode_forms(space, stress_of_strain, measure)
    )
    inverse = adapter.block_diagonal(modes.invertBlockDiagonal())
    released = inverse.matMult(coupling)
    stiffness = coupling.transposeMatMult(released)
    displacements.axpy(-1.0, stiffness)
    for matrix in (coupling, modes, inverse, released, stiffness):
        matrix.destroy()
    return displacements


def mode_forms(space, stress_of_strain, measure) -> tuple:
    """Compiled forms of K_uu, K_au (a row for each amplitude) and K_aa."""
    amplitudes = adapter.cell_space(space.mesh, 0, MODES)
    mode_strain = _mode_strain(space.mesh)
    trial = ufl.TrialFunction(space)
    test = ufl.TestFunction(space)
    mode_trial = ufl.TrialFunction(amplitudes)
    mode_test = ufl.TestFunction(amplitudes)

    def strain(displacement):
        return ufl.sym(ufl.grad(displacement))

    integrands = (
        ufl.inner(stress_of_strain(strain(trial)), strain(test)),
        ufl.inner(stress_of_strain(strain(trial)), mode_strain(mode_test)),
        ufl.inner(stress_of_strain(mode_strain(mode_trial)), mode_strain(mode_test)),
    )
    return tuple(adapter.compile_form(integrand * measure) for integrand in integrands)


def _mode_strain(mesh):
    """UFL strain of amplitudes (a_1x, a_1y, a_2x, a_2y)."""
    corners = adapter.cell_space(mesh, 1, 1)
    cells = adapter.cell_nodes(corners)
    xi, eta = (adapter.function(corners, _by_node(cells, values)) for values in (XI, ETA))
    gradients = adapter.cell_space(mesh, 0, MODES)
    at_centre = adapter.function(gradients, _scaled_centre_gradients(adapter.node_coordinates(corners)[cells]).ravel())
    jacobian = ufl.Jacobian(mesh)
    # DOLFINx's reference cell has sides of one, this element's of two.
    determinant = abs(jacobian[0, 0] * jacobian[1, 1] - jacobian[0, 1] * jacobian[1, 0]) / 4.0
    of_xi = -2.0 * xi / determinant * ufl.as_vector([at_centre[0], at_centre[1]])
    of_eta = -2.0 * eta / determinant * ufl.as_vector([at_centre[2], at_centre[3]])

    def strain(amplitude):
        first = ufl.as_vector([amplitude[0], amplitude[1]])
        second = ufl.as_vector([amplitude[2], amplitude[3]])
        return ufl.sym(ufl.outer(first, of_xi) + ufl.outer(second, of_eta))

    return strain


def _by_node(cells: np.ndarray, corner_values: np.ndarray) -> np.ndarray:
    """Values (nodes,) of a discontinuous function that is the same at the corners (4,) of all cells (m, 4)."""
    values = np.empty(cells.size)
    values[cells] = corner_values
    return values


def _scaled_centre_gradients(corners: np.ndarray) -> np.ndarray:
    """abs(j_0) grad xi, abs(j_0) grad eta (m, 2, 2) at the centre of cells with corners (m, 4, 2), row by row."""
    jacobian = 0.25 * np.stack([np.einsum("k,mki->mi", at, corners) for at in (XI, ETA)], axis=-1)
    return np.abs(np.linalg.det(jacobian))[:, None, None] * np.linalg.inv(jacobian)
