"""Row 6: condensing a sector and joining a ring of them is only another way to solve the whole gear."""

from functools import lru_cache

import numpy as np
import pytest
from scipy.sparse.linalg import splu
from tests.coarse_sector import PINION, coarse_condensed_sector, coarse_sector_mesh, relative
from tests.whole_gear import whole_gear_mesh

from fenics_gears.elasticity import dolfinx_adapter as adapter
from fenics_gears.elasticity.condensation import by_radius
from fenics_gears.elasticity.elements import ELEMENTS
from fenics_gears.elasticity.ring import ring_compliance
from fenics_gears.elasticity.stiffness import assembled, displacement_space, nodes_at, stiffness_matrix
from fenics_gears.geometry.outline import rotation


@lru_cache
def held_gear(name: str):
    """The whole gear, hub held, factorised by SuperLU: its displacement space, free dofs, factors."""
    element, mesh = ELEMENTS[name], whole_gear_mesh(coarse_sector_mesh(name), PINION.teeth)
    space = displacement_space(mesh, element)
    stiffness = assembled(stiffness_matrix(space, element, 0.3))
    hub = nodes_at(space, mesh.edge_nodes("hub", element.order))
    free = np.setdiff1d(np.arange(stiffness.shape[0]), (2 * hub[:, None] + [0, 1]).ravel())
    return mesh, space, free, splu(stiffness[free][:, free].tocsc())


@pytest.mark.parametrize(
    "name",
    [name if name in ("P2", "Q1 incompatible") else pytest.param(name, marks=pytest.mark.nightly) for name in ELEMENTS],
)
def test_condensed_equals_uncondensed(name, measured):
    """Exact identity: the full system of the whole gear, solved by another solver than PETSc."""
    element = ELEMENTS[name]
    mesh, space, free, factors = held_gear(name)
    flanks = [nodes_at(space, by_radius(mesh.edge_nodes(f"flank {tooth}", element.order))) for tooth in range(4)]
    flank = flanks[0]
    forces = np.random.default_rng(6).normal(size=(2 * len(flank), 3))
    right = np.zeros((2 * len(adapter.node_coordinates(space)), 3))
    right[(2 * flank[:, None] + [0, 1]).ravel()] = forces
    displacement = np.zeros_like(right)
    displacement[free] = factors.solve(right[free])
    blocks = ring_compliance(coarse_condensed_sector(name), PINION.teeth, 3)
    differences = []
    for offset, nodes in enumerate(flanks):
        into_frame = np.kron(np.eye(len(nodes)), rotation(offset * PINION.angular_pitch)).T
        found, expected = blocks[offset] @ forces, into_frame @ displacement[(2 * nodes[:, None] + [0, 1]).ravel()]
        differences.append(relative(found - expected, expected))
    measured(f"condensed and uncondensed, {name}: difference", max(differences), 1e-9)
