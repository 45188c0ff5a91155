"""The ring of sectors against brute force, and what must hold of any condensed gear."""

from math import pi, radians

import numpy as np
import pytest

from fenics_gears.elasticity import dolfinx_adapter as adapter
from fenics_gears.elasticity.compliance import FlankCompliance
from fenics_gears.elasticity.condensation import by_radius
from fenics_gears.elasticity.element_sizes import ElementSizes
from fenics_gears.elasticity.elements import ELEMENTS
from fenics_gears.elasticity.ring import centre_motion, condensed_sector, ring_compliance, ring_stiffness, rotation
from fenics_gears.elasticity.sector_mesh import sector_mesh, whole_gear_mesh
from fenics_gears.elasticity.stiffness import displacement_space, nodes_at, stiffness_form
from fenics_gears.elasticity.whole_gear import whole_gear_compliance
from fenics_gears.errors import ComputationError
from fenics_gears.geometry.gear import Gear


def relative(difference, reference):
    return np.abs(difference).max() / np.abs(reference).max()


@pytest.mark.parametrize("name", ELEMENTS)
def test_ring_equals_fully_meshed_gear(name, pinion, steel, coarse_sector):
    """Exact identity (hard case 6, 1e-9): the ring of sectors is the whole gear, only solved otherwise."""
    sector = condensed_sector(coarse_sector(name), ELEMENTS[name], 0.3)
    ring = ring_compliance(sector, pinion.teeth, 3) / steel.youngs_modulus
    whole = whole_gear_compliance(
        whole_gear_mesh(coarse_sector(name), pinion.teeth), pinion, steel, element=name, tooth_offsets=3
    )
    for offset in range(4):
        assert relative(ring[offset] - whole.blocks[offset], whole.blocks[offset]) < 1e-9


def test_ring_of_an_odd_number_of_teeth(steel):
    """Exact identity as above; with an odd number no harmonic but the mean is its own conjugate."""
    gear = Gear(13, 2.0, radians(20.0), 0.3, 15.6, 11.1, 5.0, 0.76)
    mesh = sector_mesh(gear, ElementSizes(flank=0.5, fillet=0.3, coast=0.6, body=1.5))
    ring = ring_compliance(condensed_sector(mesh, ELEMENTS["P2"], 0.3), 13, 12) / steel.youngs_modulus
    whole = whole_gear_compliance(whole_gear_mesh(mesh, 13), gear, steel, tooth_offsets=12)
    assert relative(ring - whole.blocks, whole.blocks) < 1e-9


def test_every_tooth_is_the_same_and_teeth_behind_are_the_transpose(pinion, steel, coarse_sector):
    """Exact identities: isotropy under rotation by whole pitches; Betti's reciprocal theorem for the tooth behind."""
    whole = whole_gear_mesh(coarse_sector("P2"), pinion.teeth)
    first = whole_gear_compliance(whole, pinion, steel, tooth_offsets=pinion.teeth - 1)
    fifth = whole_gear_compliance(whole, pinion, steel, loaded_tooth=5, tooth_offsets=2)
    assert relative(first.blocks[:3] - fifth.blocks, fifth.blocks) < 1e-9
    for offset in (1, 2):
        behind = first.blocks[pinion.teeth - offset]
        assert relative(behind - fifth.block(-offset), behind) < 1e-9


def test_condensed_equals_uncondensed(pinion, steel, coarse_sector):
    """Exact identity (hard case 6, 1e-9): solve the whole gear's full system with one force on a flank, hub held."""
    element, mesh = ELEMENTS["P2"], whole_gear_mesh(coarse_sector("P2"), pinion.teeth)
    space = displacement_space(mesh, element)
    matrix = adapter.assemble_matrix(stiffness_form(space, element, 0.3))
    flank = nodes_at(space, by_radius(mesh.edge_nodes("flank 0", 2)))
    ahead = nodes_at(space, by_radius(mesh.edge_nodes("flank 1", 2)))
    hub = nodes_at(space, mesh.edge_nodes("hub", 2))
    dense = csr(matrix)
    held = (2 * hub[:, None] + [0, 1]).ravel()
    free = np.setdiff1d(np.arange(dense.shape[0]), held)
    force = np.zeros(dense.shape[0])
    force[2 * flank[3]:2 * flank[3] + 2] = [1.0, -0.4]
    from scipy.sparse.linalg import spsolve

    displacement = np.zeros_like(force)
    displacement[free] = spsolve(dense[free][:, free].tocsc(), force[free]) / steel.youngs_modulus
    blocks = ring_compliance(condensed_sector(coarse_sector("P2"), element, 0.3), pinion.teeth, 1) / steel.youngs_modulus
    for offset, nodes in enumerate((flank, ahead)):
        in_frame = displacement.reshape(-1, 2)[nodes] @ rotation(offset * pinion.angular_pitch)
        expected = blocks[offset][:, 6:8] @ [1.0, -0.4]
        assert relative(in_frame.ravel() - expected, expected) < 1e-9


def csr(matrix):
    from scipy.sparse import csr_matrix

    rows, columns, values = matrix.getValuesCSR()
    return csr_matrix((values, columns, rows), shape=matrix.getSize())


@pytest.mark.parametrize("name", ELEMENTS)
def test_kernel_is_the_three_rigid_motions(name, pinion, coarse_sector):
    """Exact identity (hard case 5): norm(S R)/norm(S) <= 1e-10, symmetric, no other zero eigenvalue."""
    sector = condensed_sector(coarse_sector(name), ELEMENTS[name], 0.3)
    stiffness = ring_stiffness(sector, pinion.teeth, (0, 1, 5))
    motion = flank_motion(sector, pinion, (0, 1, 5))
    rigid = np.vstack([motion, np.eye(3)])
    assert np.linalg.norm(stiffness @ rigid) <= 1e-10 * np.linalg.norm(stiffness)
    np.testing.assert_array_equal(stiffness, stiffness.T)
    eigenvalues = np.linalg.eigvalsh(stiffness)
    assert np.abs(eigenvalues[:3]).max() <= 1e-10 * eigenvalues[-1]
    assert eigenvalues[3] > 1e-6 * eigenvalues[-1]


def test_compliance_and_rigid_motion_hold_the_whole_stiffness(pinion, coarse_sector):
    """Exact identity (model.md, section 2): S_ff = A^-1, S_fq = -S_ff G, S_qq = G^T S_ff G."""
    sector = condensed_sector(coarse_sector("P2"), ELEMENTS["P2"], 0.3)
    blocks = ring_compliance(sector, pinion.teeth, 1)
    stiffness = ring_stiffness(sector, pinion.teeth, (0, 1))
    compliance = np.block([[blocks[0], blocks[1].T], [blocks[1], blocks[0]]])
    flank, motion = np.linalg.inv(compliance), flank_motion(sector, pinion, (0, 1))
    expected = np.block([[flank, -flank @ motion], [-motion.T @ flank, motion.T @ flank @ motion]])
    assert relative(stiffness - expected, expected) < 1e-9


def flank_motion(sector, gear, teeth):
    return np.vstack([centre_motion(sector.points["flank"], tooth * gear.angular_pitch) for tooth in teeth])


def test_cuts_that_do_not_match_are_refused(pinion, coarse_sector):
    """A ring of one tooth more has another pitch than the sector was meshed for."""
    sector = condensed_sector(coarse_sector("P1"), ELEMENTS["P1"], 0.3)
    with pytest.raises(ComputationError, match="do not match"):
        ring_compliance(sector, pinion.teeth + 1, 1)


def test_offset_that_was_not_computed_is_refused():
    """A tooth outside the blocks is an error, not a wrapped index."""
    compliance = FlankCompliance(np.linspace(0.1, 0.6, 2), 1, np.zeros((2, 4, 4)))
    with pytest.raises(ComputationError, match="offset -2"):
        compliance.block(-2)


def test_centre_motion_in_a_turned_frame():
    """Exact identity: the rotation of a point about the centre does not depend on the frame, (dx, dy) turns with it."""
    motion = centre_motion(np.array([[2.0, 0.0]]), 0.5 * pi)
    np.testing.assert_allclose(motion, [[0.0, 1.0, 0.0], [-1.0, 0.0, 2.0]], atol=1e-15)
