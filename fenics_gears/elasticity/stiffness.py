"""Plane strain stiffness of a meshed body for Young's modulus 1 MPa and unit thickness."""

from functools import cache

import numpy as np
import ufl
from scipy import sparse
from scipy.spatial import cKDTree

from fenics_gears.errors import ComputationError
from fenics_gears.geometry.gear_data import Web

from . import dolfinx_adapter as adapter
from .element_nodes import numbers_at
from .elements import Element
from .incompatible_modes import condensed_stiffness
from .mesh_data import BodyMesh

WEB_QUADRATURE = 8


def stress(displacement, poissons_ratio):
    """UFL stress in plane strain of a displacement, Young's modulus 1."""
    return stress_of_strain(ufl.sym(ufl.grad(displacement)), poissons_ratio)


def stress_of_strain(strain, poissons_ratio):
    """UFL stress lambda tr(eps) I + 2 mu eps, in plane strain (strain 2 by 2) or in three dimensions, Young's modulus
    1."""
    shear_modulus = 1.0 / (2.0 * (1.0 + poissons_ratio))
    first_lame = poissons_ratio / ((1.0 + poissons_ratio) * (1.0 - 2.0 * poissons_ratio))
    return first_lame * ufl.tr(strain) * ufl.Identity(strain.ufl_shape[0]) + 2.0 * shear_modulus * strain


def stiffness_matrix(space, element: Element, poissons_ratio: float, web: Web | None = None):
    """Assembled PETSc matrix of the strain energy on a displacement space, no boundary conditions.

    A web less wide than the face is in plane strain too, and stiff by its share of the face width.
    """
    if element.incompatible_modes:
        poisson = adapter.constant(space.mesh, poissons_ratio)
        return condensed_stiffness(
            space, lambda strain: _of_width(web, space.mesh, stress_of_strain(strain, poisson)), _cells(element, web)
        )
    return adapter.assemble_matrix(stiffness_form(space, element, poissons_ratio, web))


def stiffness_form(space, element: Element, poissons_ratio: float, web: Web | None = None):
    """Compiled bilinear form of the strain energy of a displacement alone, without modes within the cells."""
    trial = ufl.TrialFunction(space)
    test = ufl.TestFunction(space)
    poisson = adapter.constant(space.mesh, poissons_ratio)
    return adapter.compile_form(
        ufl.inner(_of_width(web, space.mesh, stress(trial, poisson)), ufl.sym(ufl.grad(test))) * _cells(element, web)
    )


def _of_width(web: Web | None, mesh, stress):
    """UFL stress times the body's width over the face width."""
    if web is None:
        return stress
    place = ufl.SpatialCoordinate(mesh)
    values = web.hub_radius**2, web.rim_radius**2, web.stiff_share or web.share
    inner, outer, share = (adapter.constant(mesh, value) for value in values)
    square = ufl.inner(place, place)
    return ufl.conditional(ufl.And(ufl.gt(square, inner), ufl.lt(square, outer)), share, 1.0) * stress


def _cells(element: Element, web: Web | None = None):
    # The web's ends lie within cells.
    return ufl.dx(metadata={"quadrature_degree": element.quadrature_degree if web is None else WEB_QUADRATURE})


def displacement_space(mesh: BodyMesh, element: Element):
    """DOLFINx displacement space on a body, on this process alone."""
    return adapter.vector_space(adapter.create_mesh(mesh.points, mesh.cells), element.order)


@cache
def compile_ahead(element: Element) -> None:
    """Compile all that an element needs, on a body of one cell; once in a process."""
    square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    cell = BodyMesh(square[: element.corners], np.arange(element.corners)[None], {})
    stiffness_matrix(displacement_space(cell, element), element, 0.3).destroy()


def assembled(matrix) -> sparse.csr_matrix:
    """A PETSc matrix as scipy's; the former is given back."""
    starts, columns, values = matrix.getValuesCSR()
    copied = sparse.csr_matrix((values.copy(), columns.copy(), starts.copy()), shape=matrix.getSize())
    matrix.destroy()
    return copied


def nodes_at(space, coordinates: np.ndarray) -> np.ndarray:
    """Numbers (k,) of the space's nodes at coordinates (k, 2), by `numbers_at`."""
    return numbers_at(adapter.node_coordinates(space), coordinates)


def nodes_in_cells(space, coordinates: np.ndarray, centres: np.ndarray) -> np.ndarray:
    """Numbers (k,) of the space's nodes at coordinates (k, 2) in the cells with centres (k, 2), which distinguish nodes
    in one place. Raises ComputationError where there is no such cell or node."""
    if not len(coordinates):
        return np.empty(0, dtype=np.int64)
    nodes = adapter.node_coordinates(space)
    cells = adapter.cell_nodes(space)
    tolerance = 1e-9 * np.abs(nodes).max()
    distance, cell = cKDTree(nodes[cells].mean(axis=1)).query(centres)
    apart = np.linalg.norm(nodes[cells[cell]] - coordinates[:, None], axis=-1)
    if max(distance.max(), apart.min(axis=1).max()) > tolerance:
        raise ComputationError("stiffness: a node on the face of a crack is not among the nodes of its cell")
    return cells[cell, np.argmin(apart, axis=1)]
