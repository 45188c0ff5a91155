"""The coast flank in a gear's compliance."""

import numpy as np
import pytest

from fenics_gears import ComputationError
from fenics_gears.elasticity.compliance import Reach
from fenics_gears.elasticity.condensation import by_radius
from fenics_gears.elasticity.element_sizes import Discretisation
from fenics_gears.elasticity.elements import ELEMENTS
from fenics_gears.elasticity.gear_compliance import flank_compliance
from fenics_gears.elasticity.ring import condensed_sector, ring_compliance
from fenics_gears.elasticity.sector_mesh import sector_mesh
from fenics_gears.geometry.outline import centreline_mirror

BOTH = Reach(2, (-2, 2))


@pytest.fixture(scope="module")
def both(pinion, steel):
    return flank_compliance(pinion, steel, Discretisation("P2", 0.4), BOTH)


def difference(first, second):
    return np.linalg.norm(first - second) / np.linalg.norm(second)


@pytest.mark.parametrize("name", ELEMENTS)
def test_it_is_a_drive_flank_in_the_mirror(name, pinion, steel):
    """Brute force: the ring joined with both flanks in its own frame, then mirrored by dense products."""
    element, coarse = ELEMENTS[name], Discretisation(name, 0.9, 3.0)
    either = flank_compliance(pinion, steel, coarse, BOTH)
    similar, sizes = pinion.of_module_one, coarse.sizes(pinion, both_flanks=True).in_modules_of(pinion)
    mesh = sector_mesh(similar, sizes, element.quadrilateral)
    flanks = np.vstack([by_radius(mesh.edge_nodes(side, element.order)) for side in ("flank", "coast")])
    blocks = (
        ring_compliance(condensed_sector(mesh, element, steel.poissons_ratio, flank=flanks), pinion.teeth, 2)
        / steel.youngs_modulus
    )
    frame = np.eye(2 * len(flanks))
    coast = np.arange(len(flanks), 2 * len(flanks))
    frame[np.ix_(coast, coast)] = np.kron(np.eye(len(flanks) // 2), centreline_mirror(similar))
    for offset in (0, 1, 2, -1):
        expected = frame @ (blocks[offset] if offset >= 0 else blocks[-offset].T) @ frame.T
        assert difference(either.block(offset), expected) < 1e-12


def test_flank_pairs_that_are_not_asked_for_are_not_known(pinion, steel, both):
    """Exact identity: the same numbers in a smaller range."""
    fewer = flank_compliance(pinion, steel, Discretisation("P2", 0.4), Reach(1, (-2, 1)))
    assert np.array_equal(fewer.between(1, 0), both.between(1, 0))
    assert np.array_equal(fewer.between(0, 2, (0, 1)), both.between(0, 2, (0, 1)))
    assert np.array_equal(fewer.between(2, 0, (1, 0)), both.between(2, 0, (1, 0)))
    with pytest.raises(ComputationError, match="known are -2 to 1"):
        fewer.between(2, 0, (0, 1))
    with pytest.raises(ComputationError, match="known are -1 to 1"):
        fewer.between(2, 0, (1, 1))
