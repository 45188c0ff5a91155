"""The flank compliance over a face: against brute force, symmetries, and the limits of thin and thick gears."""

from dataclasses import replace
from math import radians, tan

import numpy as np
import pytest
from scipy import sparse
from scipy.sparse.linalg import spsolve
from tests.coarse_sector import PINION, STEEL
from tests.elasticity.face.swept import GEAR, TWISTED, mesh, section
from tests.whole_gear import whole_gear_mesh

from fenics_gears.elasticity.cache import Cache
from fenics_gears.elasticity.compliance import Reach
from fenics_gears.elasticity.condensation import by_radius, dofs_of
from fenics_gears.elasticity.face.compliance import face_compliance
from fenics_gears.elasticity.face.condensed import condense_swept, condensed_swept_sector, swept_nodes
from fenics_gears.elasticity.face.cost import expected_memory, expected_size
from fenics_gears.elasticity.face.discretisation import FaceDiscretisation
from fenics_gears.elasticity.face.half_turn import half_turn_basis, half_turn_response
from fenics_gears.elasticity.face.swept_stiffness import ELEMENT, swept_stiffness
from fenics_gears.elasticity.ring import fourier_response, ring_compliance, rotation, sector_cuts
from fenics_gears.errors import ComputationError, SceneError

BOTH = Reach(1, (-1, 1))
TWISTED_PINION = FaceDiscretisation(2.7, 3, 15.0, tan(radians(15.0)) / PINION.reference_radius)


def difference(first, second):
    """In the Frobenius norm, relative."""
    return np.linalg.norm(first - second) / np.linalg.norm(second)


@pytest.fixture(scope="module")
def both():
    return face_compliance(PINION, STEEL, TWISTED_PINION, BOTH)


def test_condensed_is_uncondensed():
    """Brute force, hard case 6 in three dimensions: a twisted sector with free cuts, its sparse stiffness solved by SuperLU for every flank force."""
    sector, hub = condensed_swept_sector(mesh(), TWISTED, 0.3), mesh().edge_nodes("hub", ELEMENT.order)
    cuts = np.concatenate([sector.dofs("lower"), sector.dofs("upper")])
    flank_only = sector.between("flank", "flank") - sector.stiffness[np.ix_(sector.dofs("flank"), cuts)] @ np.linalg.solve(
        sector.stiffness[np.ix_(cuts, cuts)], sector.stiffness[np.ix_(cuts, sector.dofs("flank"))]
    )
    nodes, heights = section().nodes.points, len(TWISTED.heights)
    free = np.delete(np.arange(3 * heights * len(nodes)), dofs_of(swept_nodes(nodes, hub, heights), 3))
    flank = np.searchsorted(free, dofs_of(swept_nodes(nodes, by_radius(mesh().edge_nodes("flank", ELEMENT.order)), heights), 3))
    loads = sparse.csc_matrix((np.ones(len(flank)), (flank, np.arange(len(flank)))), shape=(len(free), len(flank)))
    uncondensed = spsolve(swept_stiffness(section(), TWISTED)[free][:, free].tocsc(), loads).toarray()[flank]
    assert difference(np.linalg.inv(flank_only), uncondensed) < 1e-9


def test_ring_of_sectors_is_the_whole_gear():
    """Brute force: the section copied around the gear, swept and condensed as one body; every tooth's frame is turned by its pitches."""
    whole, offsets = whole_gear_mesh(mesh(), GEAR.teeth), 2
    hub = whole.edge_nodes("hub", ELEMENT.order)
    flanks = {f"flank {tooth}": [by_radius(whole.edge_nodes(f"flank {tooth}", ELEMENT.order))] for tooth in range(offsets + 1)}
    body = condense_swept(whole, TWISTED, 0.3, flanks, held=hub)
    compliance, size = np.linalg.inv(body.stiffness), len(body.dofs("flank 0"))
    blocks = ring_compliance(condensed_swept_sector(mesh(), TWISTED, 0.3), GEAR.teeth, offsets)
    for offset, block in enumerate(blocks):
        frame = np.kron(np.eye(size // 3), rotation(offset * GEAR.angular_pitch, 3))
        assert difference(block, frame.T @ compliance[offset * size : (offset + 1) * size, :size]) < 1e-10


def test_hands_mirror_each_other():
    """Exact symmetry: z -> -z turns a right-hand gear into a left-hand one; positions along z are even about mid-width."""
    right, left = (
        face_compliance(PINION, STEEL, replace(TWISTED_PINION, twist=sign * TWISTED_PINION.twist), Reach(1)) for sign in (1.0, -1.0)
    )
    nodes, heights = len(right.roll_angle), len(right.heights)
    flip = np.kron(np.eye(heights)[::-1], np.kron(np.eye(nodes), np.diag([1.0, 1.0, -1.0])))
    assert np.array_equal(right.heights, -right.heights[::-1])
    for one, other in zip(right.blocks, left.blocks):
        assert difference(flip @ one @ flip.T, other) < 1e-10


def test_either_flank_is_the_other_turned_over(both):
    """Exact symmetry of a helical gear: half a turn about its centreline at mid-width. Mirrored frames then differ by z -> -z, and ahead is behind."""
    nodes, heights = len(both.roll_angle), len(both.heights)
    flip, half = np.kron(np.eye(heights)[::-1], np.kron(np.eye(nodes), np.diag([1.0, 1.0, -1.0]))), 3 * nodes * heights
    flip = np.kron([[0.0, 1.0], [1.0, 0.0]], flip)
    assert both.flanks == 2 and both.blocks.shape == (2, 2 * half, 2 * half)
    for block in both.blocks:
        assert difference(flip @ block @ flip.T, block.T) < 1e-10


def test_compliance_is_symmetric_and_positive_definite(both):
    """Betti's theorem, and elastic energy is positive."""
    for block in (both.blocks[0], both.plane.blocks[0]):
        assert np.array_equal(block, block.T)
        assert np.linalg.eigvalsh(block)[0] > 0.0


def test_plane_part_is_the_coast_flank_in_the_mirror(both):
    """Exact symmetry of the plane section about the tooth's centreline: in its mirrored frame the coast flank is a drive flank."""
    for offset in (0, 1):
        drive, coast = (both.plane.between(offset, 0, (side, side)) for side in (0, 1))
        assert difference(coast, drive.T) < 1e-12


def even_load(compliance, component):
    """Compliance (n, n) of the flank's nodes to loads of 1 N/mm, even along the face, mean over the face."""
    heights, nodes = len(compliance.heights), len(compliance.roll_angle)
    share = np.zeros(heights)
    for layer, thickness in enumerate(np.diff(compliance.heights[::2])):
        share[2 * layer : 2 * layer + 3] += thickness * np.array([1.0, 4.0, 1.0]) / 6.0
    block = compliance.blocks[0].reshape(heights, nodes, 3, heights, nodes, 3)[:, :, component, :, :, component]
    return np.einsum("h,hakb,k->ab", share, block, share) / share.sum()


@pytest.mark.parametrize(("width", "layers", "limit"), [(0.05, 1, "plane stress"), (270.0, 6, "plane strain")])
def test_limits_of_a_spur_gear(width, layers, limit):
    """Theory of elasticity: a thin gear is in plane stress, the plane strain of Poisson's ratio nu/(1 + nu) and modulus E (1 + 2 nu)/(1 + nu)^2."""
    body = face_compliance(PINION, STEEL, FaceDiscretisation(2.7, layers, width), Reach(0))
    poisson, factor = STEEL.poissons_ratio, 1.0
    expected = body.plane.blocks[0]
    if limit == "plane stress":
        factor = (1.0 + poisson) ** 2 / (1.0 + 2.0 * poisson)
        thin = replace(STEEL, poissons_ratio=poisson / (1.0 + poisson))
        expected = factor * face_compliance(PINION, thin, FaceDiscretisation(2.7, 1, 1.0), Reach(0)).plane.blocks[0]
    # Loads at the flank's middle and tip, across it.
    at = slice(4, None, 4)
    found, wanted = even_load(body, 0)[at, at], expected[::2, ::2][at, at]
    print(limit, found / wanted)
    assert difference(found, wanted) < 5e-3


def test_similar_gears_share_an_entry(both, tmp_path):
    """Exact scaling: of similar gears displacement per force goes with 1/(E m); lengths go with the module."""
    twice = replace(PINION, **{name: 2.0 * getattr(PINION, name) for name in ("module", "tip_radius", "root_radius", "bore_radius", "rack_tip_radius")})
    larger = replace(TWISTED_PINION, section_size=2.0 * 2.7, face_width=30.0, twist=0.5 * TWISTED_PINION.twist)
    cache = Cache(tmp_path)
    first = face_compliance(PINION, STEEL, TWISTED_PINION, BOTH, cache)
    second = face_compliance(twice, replace(STEEL, youngs_modulus=2.0 * STEEL.youngs_modulus), larger, BOTH, cache)
    assert not first.timings["from_cache"] and second.timings["from_cache"]
    assert np.array_equal(first.blocks, both.blocks)
    np.testing.assert_allclose(4.0 * second.blocks, first.blocks, rtol=1e-13)
    np.testing.assert_allclose(second.heights, 2.0 * first.heights, rtol=1e-13)
    np.testing.assert_allclose(2.0 * second.plane.blocks, first.plane.blocks, rtol=1e-13)


@pytest.mark.parametrize(
    ("change", "message"), [({"section_size": 0.0}, "section_size is 0.0 mm"), ({"layers": 0}, "layers is 0"), ({"twist": 0.2}, "take 8 or more")]
)
def test_impossible_bodies_are_refused(change, message):
    """What is wrong, and what is allowed."""
    with pytest.raises(SceneError, match=message):
        face_compliance(PINION, STEEL, replace(TWISTED_PINION, **change), Reach(0))


def test_half_a_turn_gives_the_fourier_transform():
    """Brute force: the ring's harmonics as complex matrices, of a sector with both flanks alike, and held alike."""
    sector = condensed_swept_sector(mesh(both_flanks=True), TWISTED, 0.3, ("flank", "coast"))
    cuts, turn = sector_cuts(sector, GEAR.teeth)
    link = turn.T @ sector.stiffness[np.ix_(cuts, cuts)] @ turn
    found = half_turn_response(link, GEAR.teeth, 2, half_turn_basis(sector.points["lower"], len(TWISTED.heights)))
    expected = fourier_response(link, GEAR.teeth, 2)
    for offset in (-1, 0, 1, 2):
        assert difference(found(offset), expected(offset)) < 1e-11


def test_sector_without_the_symmetry_is_refused():
    """Half a turn does not map a sector on itself whose coast flank is meshed otherwise than its drive flank."""
    sector = condensed_swept_sector(mesh(), TWISTED, 0.3)
    basis = half_turn_basis(sector.points["lower"], len(TWISTED.heights))
    with pytest.raises(ComputationError, match="half a turn"):
        ring_compliance(sector, GEAR.teeth, 1, lambda *ring: half_turn_response(*ring, basis))


@pytest.mark.parametrize("reach", [Reach(0), BOTH])
def test_expected_size(reach):
    """The mesh itself: condensed unknowns exactly, all within 15 %."""
    gear, face = replace(PINION, teeth=24, tip_radius=59.0, root_radius=49.0), FaceDiscretisation(1.35, 1, 3.0)
    found = face_compliance(gear, STEEL, face, reach).timings
    unknowns, condensed = expected_size(gear, face, reach.across is not None)
    assert condensed == found["condensed_unknowns"]
    assert unknowns == pytest.approx(found["unknowns"], rel=0.15)
    assert expected_memory(2 * unknowns, condensed) > expected_memory(unknowns, condensed) > 0.0
