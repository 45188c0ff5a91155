"""A manufactured solution of plane strain on a distorted square."""

import numpy as np
import ufl
from scipy.sparse.linalg import spsolve
from tests.structured import cells_of

from fenics_gears.elasticity import dolfinx_adapter as adapter
from fenics_gears.elasticity.elements import ELEMENTS
from fenics_gears.elasticity.mesh_data import BodyMesh
from fenics_gears.elasticity.stiffness import assembled, displacement_space, stiffness_matrix, stress


def distorted_square(cells: int, corners: int) -> BodyMesh:
    """cells x cells quadrilaterals or twice as many triangles."""
    x, y = np.meshgrid(*2 * [np.linspace(0.0, 1.0, cells + 1)], indexing="ij")
    bump = 0.05 * np.sin(np.pi * x) * np.sin(np.pi * y)
    points = np.stack([(x + bump).ravel(), (y - bump).ravel()], axis=-1)
    index = np.arange((cells + 1) ** 2).reshape(cells + 1, cells + 1)
    return BodyMesh(points, cells_of(index, corners), {})


def exact_displacement(x, module):
    return (
        module.sin(2.0 * x[0]) * module.cos(1.5 * x[1]) + x[0] * x[1],
        module.exp(0.8 * x[0]) * module.sin(1.7 * x[1]),
    )


def l2_error(name: str, cells: int, poissons_ratio: float) -> float:
    """Error of the displacement, exact values on the boundary, the exact field's own body force inside."""
    element = ELEMENTS[name]
    space = displacement_space(distorted_square(cells, element.corners), element)
    stiffness = assembled(stiffness_matrix(space, element, poissons_ratio))
    x = ufl.SpatialCoordinate(space.mesh)
    exact = ufl.as_vector(exact_displacement(x, ufl))
    measure = ufl.dx(metadata={"quadrature_degree": 8})
    body_force = -ufl.div(stress(exact, adapter.constant(space.mesh, poissons_ratio)))
    test = ufl.TestFunction(space)
    load = adapter.fem.petsc.assemble_vector(adapter.compile_form(ufl.inner(body_force, test) * measure)).array
    nodes = adapter.node_coordinates(space)
    displacement = np.stack(exact_displacement(nodes.T, np), axis=-1).ravel()
    inside = np.repeat(np.all((nodes > 1e-9) & (nodes < 1.0 - 1e-9), axis=1), 2)
    held = displacement * ~inside
    displacement[inside] = spsolve(stiffness[inside][:, inside].tocsc(), (load - stiffness @ held)[inside])
    difference = adapter.function(space, displacement) - exact
    return np.sqrt(adapter.fem.assemble_scalar(adapter.compile_form(ufl.inner(difference, difference) * measure)))
