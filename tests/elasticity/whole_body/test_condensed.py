"""A gear meshed as a whole and condensed by its teeth: equal to a ring of sectors where it is one, to brute force where
it is not."""

import numpy as np
import pytest
from tests.coarse_sector import COARSE, PINION, STEEL, coarse_condensed_sector, coarse_sector_mesh, relative
from tests.whole_gear import whole_gear_compliance, whole_gear_mesh

from fenics_gears.elasticity.cache import Cache
from fenics_gears.elasticity.compliance import Reach
from fenics_gears.elasticity.element_sizes import Discretisation, element_sizes
from fenics_gears.elasticity.elements import ELEMENTS
from fenics_gears.elasticity.gear_compliance import flank_compliance
from fenics_gears.elasticity.mesh_data import BodyMesh
from fenics_gears.elasticity.ring import ring_compliance, rotation
from fenics_gears.elasticity.whole_body import parts
from fenics_gears.elasticity.whole_body.condensed import whole_body_compliance
from fenics_gears.elasticity.whole_body.outline import whole_body
from fenics_gears.errors import ComputationError
from meshes.root_crack import RootCrack, cracked_gear_mesh


def standing_anywhere(mesh: BodyMesh) -> BodyMesh:
    """The same gear, turned by no whole number of pitches, its edges not named."""
    return BodyMesh(mesh.points @ rotation(0.123).T, mesh.cells, {})


@pytest.mark.parametrize("name", ["P2", "Q1 incompatible"])
def test_a_whole_gear_of_equal_teeth_is_a_ring_of_sectors(name):
    """Exact identity: the same mesh, once as a ring, once as a whole whose flanks had to be found."""
    body = whole_body(standing_anywhere(whole_gear_mesh(coarse_sector_mesh(name), PINION.teeth)), PINION, "gear")
    found = whole_body_compliance(body.mesh, PINION, STEEL, element=name, tooth_offsets=2)
    ring = ring_compliance(coarse_condensed_sector(name), PINION.teeth, 2) / STEEL.youngs_modulus
    for tooth in (0, 7, 15):
        for offset in range(-2, 3):
            expected = ring[offset] if offset >= 0 else ring[-offset].T
            assert relative(found.between(tooth + offset, tooth) - expected, expected) < 1e-9
    with pytest.raises(ComputationError, match="teeth 3 and 0 are further apart than the 2 pitches"):
        found.between(3, 16)


def test_another_mesh_agrees_within_its_discretisation():
    """Authority: the ring of sectors on a mesh of its own; two P2 meshes with 0.3 mm and 0.2 mm on the flank differ by
    their errors.

    The tooth bends alike; under a single node a mesh gives way as much as its elements are small, so that a pressure
    over the flank's
    middle is compared. Pinned below what a P2 mesh of this size is known to err by (0.05 %, `gear_compliance`)."""
    sizes = element_sizes(PINION, ELEMENTS["P2"], 0.3)
    body = whole_body(standing_anywhere(cracked_gear_mesh(PINION, sizes, {})), PINION, "gear")
    one = whole_body_compliance(body.mesh, PINION, STEEL, tooth_offsets=1)
    other = flank_compliance(PINION, STEEL, Discretisation("P2", 0.2, 0.9), Reach(1))
    for ahead in (0, 1):
        here, there = (
            under_pressure(one.rolls_of(0), one.between(ahead, 0)),
            under_pressure(other.roll_angle, other.block(ahead)),
        )
        assert here == pytest.approx(there, rel=1e-3)


def under_pressure(rolls: np.ndarray, block: np.ndarray) -> float:
    """Work of a smooth normal line load over a flank's middle on the displacement of the same part of this or the next
    flank."""
    arc = 0.5 * PINION.base_radius * rolls**2
    shape = np.exp(-(((rolls - 0.55) / 0.1) ** 2))
    weight = shape * np.gradient(arc)
    normal = np.column_stack([np.cos(rolls), -np.sin(rolls)])
    loads = (weight[:, None] * normal).ravel()
    return float(loads @ block @ loads / weight.sum() ** 2)


def test_a_cracked_gear_equals_brute_force():
    """Exact identity: the whole gear's stiffness condensed at once, for the cracked tooth and its neighbours loaded."""
    body = whole_body(cracked_gear_mesh(PINION, COARSE, {8: RootCrack(3.0)}), PINION, "gear")
    found = whole_body_compliance(body.mesh, PINION, STEEL, element="P1", tooth_offsets=2)
    for loaded in (7, 8):
        brute = whole_gear_compliance(body.mesh, PINION, STEEL, element="P1", loaded_tooth=loaded, tooth_offsets=2)
        for offset in range(3):
            assert relative(found.between(loaded + offset, loaded) - brute.blocks[offset], brute.blocks[offset]) < 1e-9
    # The crack makes its tooth softer, and by reciprocity every block is another's transpose.
    assert np.trace(found.between(8, 8)) > 1.2 * np.trace(found.between(0, 0))
    assert np.array_equal(found.between(7, 8), found.between(8, 7).T)


def test_parts_may_meet_anywhere_but_between_the_twins_of_a_crack(monkeypatch):
    """Exact identity: parts that are turned by some of a pitch, so that their interface would cross the crack, give the
    same compliance."""
    mesh = whole_body(cracked_gear_mesh(PINION, COARSE, {8: RootCrack(4.0)}), PINION, "gear").mesh
    expected = whole_body_compliance(mesh, PINION, STEEL, element="P1", tooth_offsets=1)
    centreline = parts.centreline_angle
    monkeypatch.setattr(parts, "centreline_angle", lambda gear: centreline(gear) - 0.2 * gear.angular_pitch)
    faces = parts.crack_faces(mesh)
    with monkeypatch.context() as context:
        context.setattr(parts, "crack_faces", lambda mesh: [])
        crossed = [len(np.unique(parts.part_of_cells(mesh, PINION)[face])) for face in faces]
    assert max(crossed) == 2
    found = whole_body_compliance(mesh, PINION, STEEL, element="P1", tooth_offsets=1)
    for responding, loaded in ((8, 8), (9, 8), (7, 8), (0, 0)):
        reference = expected.between(responding, loaded)
        assert relative(found.between(responding, loaded) - reference, reference) < 1e-9
    assert set(found.openings) == {7, 8, 9}
    for tooth, rows in found.openings.items():
        assert relative(rows - expected.openings[tooth], expected.openings[tooth]) < 1e-9


def test_parts_share_nothing_but_their_interface():
    """Every cell is in one part; a part's kept nodes are disjoint, and flanks are whole."""
    body = whole_body(cracked_gear_mesh(PINION, COARSE, {8: RootCrack(3.0)}), PINION, "gear")
    divided = parts.divided_body(body.mesh, PINION, ELEMENTS["P2"])
    assert sum(len(part.mesh.cells) for part in divided.parts) == len(body.mesh.cells)
    for part in divided.parts:
        assert not set(part.flank) & set(part.interface) and not set(part.interface) & set(part.hub)
    assert {len(part.flank) for part in divided.parts} == {2 * len(body.mesh.edges["flank 0"]) + 1}
    assert [len(face) > 10 for face in parts.crack_faces(body.mesh)] == [True, True]
    assert [len(part.faces) > 0 for part in divided.parts] == [tooth == 8 for tooth in range(16)]
    cracks = divided.cracks
    assert np.array_equal(divided.nodes.points[cracks.one], divided.nodes.points[cracks.other]) and not set(
        cracks.one
    ) & set(cracks.other)


def test_the_cache_knows_a_body_by_its_mesh(tmp_path):
    """What is kept is what was computed, in another material too; a point moved by a hair is another body."""
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
