"""Element orders by a manufactured solution."""

import numpy as np
import pytest
import ufl
from scipy.sparse import csr_matrix
from scipy.sparse.linalg import spsolve

from fenics_gears.elasticity import dolfinx_adapter as adapter
from fenics_gears.elasticity.elements import ELEMENTS, element_named
from fenics_gears.elasticity.mesh_data import BodyMesh
from fenics_gears.elasticity.stiffness import displacement_space, stiffness_form, stress
from fenics_gears.errors import SceneError

ORDERS = {"P1": 2, "P2": 3, "Q1": 2, "Q2": 3}


def distorted_square(cells: int, corners: int) -> BodyMesh:
    """Unit square of cells x cells quadrilaterals or twice as many triangles, smoothly distorted inside."""
    x, y = np.meshgrid(*2 * [np.linspace(0.0, 1.0, cells + 1)], indexing="ij")
    bump = 0.05 * np.sin(np.pi * x) * np.sin(np.pi * y)
    points = np.stack([(x + bump).ravel(), (y - bump).ravel()], axis=-1)
    index = np.arange((cells + 1) ** 2).reshape(cells + 1, cells + 1)
    square = [index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]]
    square = np.stack([part.ravel() for part in square], axis=-1)
    if corners == 3:
        square = np.vstack([square[:, [0, 1, 2]], square[:, [0, 2, 3]]])
    return BodyMesh(points, square, {})


def exact_displacement(x, module):
    """Smooth field that no element holds exactly."""
    return (
        module.sin(2.0 * x[0]) * module.cos(1.5 * x[1]) + x[0] * x[1],
        module.exp(0.8 * x[0]) * module.sin(1.7 * x[1]),
    )


def l2_error(name: str, cells: int, poissons_ratio: float) -> float:
    """Error of the displacement, exact values held on the boundary, the exact field's own body force inside."""
    element = ELEMENTS[name]
    space = displacement_space(distorted_square(cells, element.corners), element)
    matrix = adapter.assemble_matrix(stiffness_form(space, element, poissons_ratio))
    rows, columns, values = matrix.getValuesCSR()
    stiffness = csr_matrix((values, columns, rows), shape=matrix.getSize())
    x = ufl.SpatialCoordinate(space.mesh)
    exact = ufl.as_vector(exact_displacement(x, ufl))
    measure = ufl.dx(metadata={"quadrature_degree": 8})
    body_force = -ufl.div(stress(exact, adapter.constant(space.mesh, poissons_ratio)))
    test = ufl.TestFunction(space)
    load = adapter.assemble_vector(adapter.compile_form(ufl.inner(body_force, test) * measure))
    nodes = adapter.node_coordinates(space)
    displacement = np.stack(exact_displacement(nodes.T, np), axis=-1).ravel()
    inside = np.repeat(np.all((nodes > 1e-9) & (nodes < 1.0 - 1e-9), axis=1), 2)
    held = displacement * ~inside
    displacement[inside] = spsolve(stiffness[inside][:, inside].tocsc(), (load - stiffness @ held)[inside])
    difference = adapter.function(space, displacement) - exact
    return np.sqrt(adapter.assemble_scalar(adapter.compile_form(ufl.inner(difference, difference) * measure)))


@pytest.mark.parametrize("name", ELEMENTS)
def test_order_of_the_displacement_error(name):
    """Known order (e.g. Brenner & Scott, ch. 5): the L2 error of elements of order p falls as h^(p + 1)."""
    errors = [l2_error(name, cells, 0.3) for cells in (6, 12, 24)]
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert abs(orders[-1] - ORDERS[name]) < 0.15


@pytest.mark.parametrize("name", ["P2", "Q2"])
def test_second_order_elements_do_not_lock(name):
    """Hard case 14: nearly incompressible, second order elements still converge with order 2 or better."""
    errors = [l2_error(name, cells, 0.499) for cells in (8, 16)]
    assert np.log2(errors[0] / errors[1]) > 2.0


def test_unknown_element_is_refused_with_the_nearest_name():
    """A misspelt element names the known ones and the nearest."""
    with pytest.raises(SceneError, match="did you mean 'P2'"):
        element_named("p2")
