"""The stiffness of a swept section."""

import numpy as np
import pytest
from scipy import sparse
from scipy.sparse.linalg import spsolve
from tests.elasticity.face.swept import TWIST, in_frame, in_place, mesh, section, swept_points

from fenics_gears.elasticity.condensation import by_radius, condense, dofs_of, without
from fenics_gears.elasticity.face.layers import Sweep, swept_nodes
from fenics_gears.elasticity.face.swept_stiffness import ELEMENT, swept_stiffness
from fenics_gears.elasticity.mesh_data import corner_areas


def relative(difference, reference) -> float:
    return float(abs(difference).max() / abs(reference).max())


@pytest.mark.parametrize("twist", [0.0, TWIST])
def test_patch_test(twist):
    """Patch test, Irons and Razzaque 1972: a uniform strain leaves every inner node without force."""
    sweep, nodes = Sweep(np.linspace(-1.5, 1.5, 4), twist), section().nodes
    points = swept_points(nodes.points, sweep)
    gradient = np.random.default_rng(1).normal(size=(3, 3))
    forces = swept_stiffness(section(), sweep) @ in_frame(
        (in_place(points, twist) @ gradient.T)[:, :, None], points, twist
    )
    inner = np.setdiff1d(np.arange(len(nodes.points)), nodes.boundary_sides)
    assert abs(forces.reshape(-1, len(nodes.points), 3)[1:-1, inner]).max() < 1e-12 * abs(forces).max()


@pytest.mark.parametrize("twist", [0.0, TWIST])
def test_energy_of_uniform_strain(twist):
    """Exact: energy density times volume, which parabolas make smaller by turn^4 / 480 (integral of abs(w)^2)."""
    sweep = Sweep(np.linspace(-1.5, 1.5, 4), twist)
    points = swept_points(section().nodes.points, sweep)
    strain = np.diag([1.0, -0.4, 0.7]) + 0.3 * (np.ones((3, 3)) - np.eye(3))
    dofs = in_frame((in_place(points, twist) @ strain)[:, :, None], points, twist)
    area = 0.5 * corner_areas(mesh().points, mesh().cells)[:, 0].sum()
    first_lame, shear = 0.3 / (1.3 * 0.4), 1.0 / 2.6
    density = 0.5 * first_lame * np.trace(strain) ** 2 + shear * (strain**2).sum()
    energy = 0.5 * (dofs.T @ (swept_stiffness(section(), sweep) @ dofs)).item()
    assert energy == pytest.approx(3.0 * area * density * (1.0 - twist**4 / 480.0), rel=1e-10)


def test_body_without_variation_along_the_face_is_the_plane_section():
    """Exact identity: with u_z held and even loads, plane strain of the section's own mesh."""
    sweep, nodes = Sweep(np.array([-1.5, -1.0, 0.2, 1.5])), section().nodes.points
    hub = mesh().edge_nodes("hub", ELEMENT.order)
    flank = by_radius(without(mesh().edge_nodes("flank", ELEMENT.order), hub))
    plane = condense(mesh(), ELEMENT, 0.3, {"flank": flank, "hub": hub})
    expected = np.linalg.inv(plane.between("flank", "flank"))
    heights = len(sweep.heights)
    at = swept_nodes(nodes, flank, heights)
    # A load of 1 per length on a node of the section is, at the nodes' heights, the integral of each shape function.
    share = np.zeros(heights)
    for layer, thickness in enumerate(np.diff(sweep.boundaries)):
        share[2 * layer : 2 * layer + 3] += thickness * np.array([1.0, 4.0, 1.0]) / 6.0
    free = np.ones((heights * len(nodes), 3), dtype=bool)
    free[:, 2], free[swept_nodes(nodes, hub, heights)] = False, False
    free = np.flatnonzero(free.ravel())
    loads = np.zeros((3 * heights * len(nodes), 2 * len(flank)))
    loads[dofs_of(at, 3).reshape(heights, -1, 3)[:, :, :2].reshape(heights, -1)] = share[:, None, None] * np.eye(
        2 * len(flank)
    )
    solved = np.zeros_like(loads)
    solved[free] = spsolve(
        swept_stiffness(section(), sweep)[free][:, free].tocsc(), sparse.csc_matrix(loads[free])
    ).toarray()
    for height in solved[dofs_of(at, 3)].reshape(heights, len(flank), 3, -1)[:, :, :2]:
        assert relative(height.reshape(2 * len(flank), -1) - expected, expected) < 1e-8
