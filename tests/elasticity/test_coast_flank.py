"""The coast flank in a gear's compliance: the drive flank's mirror image, and the drive flank's own as without it."""

from dataclasses import replace

import numpy as np
import pytest

from fenics_gears.elasticity.elements import ELEMENTS
from fenics_gears.elasticity.gear_compliance import element_sizes, flank_compliance
from fenics_gears.elasticity.mesh_data import corner_areas
from fenics_gears.elasticity.sector_boundary import sector_boundary
from fenics_gears.elasticity.sector_mesh import sector_mesh


@pytest.fixture(scope="module", params=ELEMENTS)
def either(request, pinion, steel):
    """Both flanks, for every element."""
    return flank_compliance(pinion, steel, element=request.param, flank_element_size=0.4, tooth_offsets=2, coast_flank=True)


@pytest.fixture(scope="module")
def both(pinion, steel):
    return flank_compliance(pinion, steel, element="P2", flank_element_size=0.4, tooth_offsets=2, coast_flank=True)


def split(both, offset):
    block, size = both.blocks[offset], 2 * both.nodes
    return block[:size, :size], block[:size, size:], block[size:, :size], block[size:, size:]


def difference(first, second):
    """In the Frobenius norm, relative."""
    return np.linalg.norm(first - second) / np.linalg.norm(second)


def test_coast_flank_is_the_drive_flanks_mirror_image(either):
    """Exact identity: symmetry of the tooth, whose mesh is symmetric too."""
    drive, to_drive, to_coast, coast = split(either, 0)
    assert difference(drive, coast) < 1e-12
    assert difference(to_drive, to_coast) < 1e-12


def test_mirroring_turns_ahead_into_behind(either):
    """Exact identity: seen in the mirror, the tooth ahead is the tooth behind."""
    for offset in (1, 2):
        drive, _, _, coast = split(either, offset)
        assert difference(drive, coast.T) < 1e-11


def test_drive_flank_is_as_without_the_coast_flank(both, pinion, steel):
    """Knowing more of the body changes nothing of it, but for the finer mesh along the coast flank."""
    alone = flank_compliance(pinion, steel, element="P2", flank_element_size=0.4, tooth_offsets=2)
    assert np.array_equal(alone.roll_angle, both.roll_angle)
    for offset in range(3):
        assert difference(split(both, offset)[0], alone.blocks[offset]) < 5e-3


def test_compliance_over_both_flanks_is_positive_definite(both):
    """Betti's theorem, and elastic energy is positive."""
    assert np.array_equal(both.blocks[0], both.blocks[0].T)
    assert np.linalg.eigvalsh(both.blocks[0]).min() > 0.0


@pytest.mark.parametrize("element", ELEMENTS)
def test_symmetric_mesh_fills_the_sector(element, pinion):
    """Exact identity: shoelace formula; as many nodes on either flank and cut; no cell folded."""
    chosen = ELEMENTS[element]
    sizes = replace(element_sizes(pinion, chosen, 0.4), both_flanks=True)
    mesh = sector_mesh(pinion, sizes, chosen.quadrilateral)
    corner = mesh.points[mesh.cells]
    ahead = np.roll(corner, -1, axis=1)
    area = 0.5 * (corner[..., 0] * ahead[..., 1] - corner[..., 1] * ahead[..., 0]).sum()
    boundary = sector_boundary(pinion, sizes)[0].points
    ahead = np.roll(boundary, -1, axis=0)
    assert area == pytest.approx(0.5 * abs((boundary[:, 0] * ahead[:, 1] - boundary[:, 1] * ahead[:, 0]).sum()), rel=1e-11)
    assert corner_areas(mesh.points, mesh.cells).min() > 0.0
    assert len(mesh.edges["flank"]) == len(mesh.edges["coast"])
    assert len(mesh.edges["upper cut"]) == len(mesh.edges["lower cut"])
