"""The quadrilateral with incompatible modes."""

import numpy as np
import pytest
from scipy.linalg import eigvalsh
from scipy.sparse.linalg import spsolve
from tests.structured import cells_of

from fenics_gears.elasticity import dolfinx_adapter as adapter
from fenics_gears.elasticity.elements import ELEMENTS
from fenics_gears.elasticity.mesh_data import BodyMesh
from fenics_gears.elasticity.stiffness import assembled, displacement_space, stiffness_matrix

ELEMENT = ELEMENTS["Q1 incompatible"]
RATIOS = [0.0, 0.3, 0.499]


def rectangle(along: int, across: int, length: float, height: float, distortion: float = 0.0) -> BodyMesh:
    """Quadrilaterals whose inner corners are moved by up to `distortion` cell sizes."""
    x, y = np.meshgrid(np.linspace(0.0, length, along + 1), np.linspace(0.0, height, across + 1), indexing="ij")
    draw = np.random.default_rng(0)
    x[1:-1, 1:-1] += distortion * length / along * draw.uniform(-1.0, 1.0, (along - 1, across - 1))
    y[1:-1, 1:-1] += distortion * height / across * draw.uniform(-1.0, 1.0, (along - 1, across - 1))
    index = np.arange(x.size).reshape(x.shape)
    return BodyMesh(np.stack([x.ravel(), y.ravel()], axis=-1), cells_of(index), {})


def nodes_and_stiffness(mesh: BodyMesh, poissons_ratio: float, name: str = ELEMENT.name):
    space = displacement_space(mesh, ELEMENTS[name])
    return adapter.node_coordinates(space), assembled(stiffness_matrix(space, ELEMENTS[name], poissons_ratio))


def inner_dofs(nodes: np.ndarray) -> np.ndarray:
    return np.repeat(np.all((nodes > 1e-9) & (nodes < 1.0 - 1e-9), axis=1), 2)


@pytest.mark.parametrize("poissons_ratio", RATIOS)
def test_patch_of_distorted_cells(poissons_ratio):
    """Exact (Irons' patch test): uniform strain on the boundary is uniform inside."""
    nodes, stiffness = nodes_and_stiffness(rectangle(5, 4, 1.0, 1.0, distortion=0.35), poissons_ratio)
    uniform = (nodes @ np.array([[1.0, 0.3], [-0.2, 0.7]])).ravel()
    inside = inner_dofs(nodes)
    found = spsolve(stiffness[inside][:, inside].tocsc(), -(stiffness[inside][:, ~inside] @ uniform[~inside]))
    assert np.abs(found - uniform[inside]).max() <= 1e-10


@pytest.mark.parametrize("poissons_ratio", RATIOS)
def test_rigid_motions_cost_nothing_and_nothing_else_does(poissons_ratio):
    """Exact: three rigid motions in the kernel of distorted cells."""
    _, stiffness = nodes_and_stiffness(rectangle(5, 4, 1.0, 1.0, distortion=0.35), poissons_ratio)
    values = eigvalsh(stiffness.toarray())
    assert np.abs(values[:3]).max() <= 1e-13 * values[-1]
    assert values[3] >= 1e-5 * values[-1]


def bent(name: str, poissons_ratio: float) -> float:
    """Deflection of a beam of 10 cells, one high, under an end couple, over M L^2/(2 E' I), E' = E/(1 - nu^2)."""
    length, height = 10.0, 1.0
    nodes, stiffness = nodes_and_stiffness(rectangle(10, 1, length, height), poissons_ratio, name)
    at_wall, at_end = nodes[:, 0] < 1e-9, nodes[:, 0] > length - 1e-9
    below = nodes[:, 1] < 1e-9
    held = np.concatenate([2 * np.flatnonzero(at_wall), 2 * np.flatnonzero(at_wall & below) + 1])
    free = np.setdiff1d(np.arange(stiffness.shape[0]), held)
    force = np.zeros(stiffness.shape[0])
    force[2 * np.flatnonzero(at_end)] = np.where(below[at_end], -1.0, 1.0)
    displacement = np.zeros_like(force)
    displacement[free] = spsolve(stiffness[free][:, free].tocsc(), force[free])
    exact = height * length**2 * (1.0 - poissons_ratio**2) / (2.0 * height**3 / 12.0)
    return float(-displacement[2 * np.flatnonzero(at_end & below) + 1][0] / exact)


@pytest.mark.parametrize("poissons_ratio", RATIOS)
def test_beam_of_one_element_across(poissons_ratio):
    """Exact: pure bending at any Poisson's ratio, where the bilinear element locks."""
    assert bent(ELEMENT.name, poissons_ratio) == pytest.approx(1.0, abs=1e-9)
    assert bent("Q1", poissons_ratio) < 0.7
