"""A gear meshed as a whole and condensed by its teeth."""

import numpy as np
import pytest
from tests.coarse_sector import COARSE, PINION, STEEL, coarse_condensed_sector, coarse_sector_mesh, relative
from tests.whole_gear import whole_gear_compliance, whole_gear_mesh

from fenics_gears import ComputationError
from fenics_gears.elasticity.cache import Cache
from fenics_gears.elasticity.mesh_data import BodyMesh
from fenics_gears.elasticity.ring import ring_compliance, rotation
from fenics_gears.elasticity.whole_body.condensed import whole_body_compliance
from fenics_gears.elasticity.whole_body.outline import whole_body
from meshes.root_crack import RootCrack, cracked_gear_mesh


def standing_anywhere(mesh: BodyMesh) -> BodyMesh:
    """The same gear, turned by no whole number of pitches, its edges not named."""
    return BodyMesh(mesh.points @ rotation(0.123).T, mesh.cells, {})


@pytest.mark.parametrize("name", ["P2", "Q1 incompatible"])
def test_a_whole_gear_of_equal_teeth_is_a_ring_of_sectors(name):
    """Exact identity: the same mesh, whose flanks had to be found."""
    body = whole_body(standing_anywhere(whole_gear_mesh(coarse_sector_mesh(name), PINION.teeth)), PINION, "gear")
    found = whole_body_compliance(body.mesh, PINION, STEEL, element=name, tooth_offsets=2)
    ring = ring_compliance(coarse_condensed_sector(name), PINION.teeth, 2) / STEEL.youngs_modulus
    for tooth in (0, 7, 15):
        for offset in range(-2, 3):
            expected = ring[offset] if offset >= 0 else ring[-offset].T
            assert relative(found.between(tooth + offset, tooth) - expected, expected) < 1e-9
    with pytest.raises(ComputationError, match="teeth 3 and 0 are further apart than the 2 pitches"):
        found.between(3, 16)


def test_a_cracked_gear_equals_brute_force():
    """Exact identity: the whole gear condensed at once."""
    body = whole_body(cracked_gear_mesh(PINION, COARSE, {8: RootCrack(3.0)}), PINION, "gear")
    found = whole_body_compliance(body.mesh, PINION, STEEL, element="P1", tooth_offsets=2)
    for loaded in (7, 8):
        brute = whole_gear_compliance(body.mesh, PINION, STEEL, element="P1", loaded_tooth=loaded, tooth_offsets=2)
        for offset in range(3):
            assert relative(found.between(loaded + offset, loaded) - brute.blocks[offset], brute.blocks[offset]) < 1e-9
    # The crack makes its tooth softer, and by reciprocity every block is another's transpose.
    assert np.trace(found.between(8, 8)) > 1.2 * np.trace(found.between(0, 0))
    assert np.array_equal(found.between(7, 8), found.between(8, 7).T)


@pytest.mark.nightly
def test_the_cache_knows_a_body_by_its_mesh(tmp_path):
    """The same in another material; a point moved by a hair is another body."""
    mesh = whole_body(whole_gear_mesh(coarse_sector_mesh("P1"), PINION.teeth), PINION, "gear").mesh
    options = {"element": "P1", "tooth_offsets": 1, "cache": Cache(tmp_path)}
    first = whole_body_compliance(mesh, PINION, STEEL, **options)
    again = whole_body_compliance(mesh, PINION, STEEL, **options)
    assert again.timings["from_cache"] and not first.timings["from_cache"]
    assert np.array_equal(first.between(3, 2), again.between(3, 2)) and np.array_equal(
        first.rolls_of(2), again.rolls_of(2)
    )
    points = mesh.points.copy()
    points[np.argmin(np.abs(np.linalg.norm(points, axis=1) - 25.0))] += 1e-6
    assert not whole_body_compliance(BodyMesh(points, mesh.cells, mesh.edges), PINION, STEEL, **options).timings[
        "from_cache"
    ]
