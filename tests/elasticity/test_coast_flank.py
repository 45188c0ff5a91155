"""The coast flank in a gear's compliance: the drive flank's mirror image, and the drive flank's own as without it."""

import numpy as np
import pytest

from fenics_gears.elasticity.gear_compliance import flank_compliance


@pytest.fixture(scope="module")
def both(pinion, steel):
    return flank_compliance(pinion, steel, element="P2", flank_element_size=0.4, tooth_offsets=2, coast_flank=True)


def split(both, offset):
    block, size = both.blocks[offset], 2 * both.nodes
    return block[:size, :size], block[:size, size:], block[size:, :size], block[size:, size:]


def difference(first, second):
    """In the Frobenius norm, relative."""
    return np.linalg.norm(first - second) / np.linalg.norm(second)


def test_coast_flank_is_the_drive_flanks_mirror_image(both):
    """Symmetry of the tooth, up to the mesh inside of it, which gmsh does not mirror."""
    drive, to_drive, to_coast, coast = split(both, 0)
    assert difference(drive, coast) < 5e-3
    assert difference(to_drive, to_coast) < 1e-4


def test_mirroring_turns_ahead_into_behind(both):
    """Symmetry: seen in the mirror, the tooth ahead is the tooth behind."""
    drive, _, _, coast = split(both, 1)
    assert difference(drive, coast.T) < 1e-4


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
