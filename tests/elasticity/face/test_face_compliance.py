"""The flank compliance over a face."""

from dataclasses import replace
from math import radians, tan

import numpy as np
import pytest
from tests.coarse_sector import PINION, STEEL
from tests.elasticity.face.swept import GEAR, TWISTED, mesh
from tests.elasticity.test_coast_flank import difference

from fenics_gears import SceneError
from fenics_gears.elasticity.cache import Cache
from fenics_gears.elasticity.compliance import Reach
from fenics_gears.elasticity.condensation import by_radius
from fenics_gears.elasticity.face import coarse_cuts, condensed
from fenics_gears.elasticity.face.compliance import face_compliance
from fenics_gears.elasticity.face.condensed import SweptSector, condensed_swept_sector
from fenics_gears.elasticity.face.cost import expected_size
from fenics_gears.elasticity.face.discretisation import FaceDiscretisation
from fenics_gears.elasticity.face.layers import Sweep, SweptWeb, layers_of_face
from fenics_gears.elasticity.face.swept_stiffness import ELEMENT
from fenics_gears.elasticity.spanned import spanned
from fenics_gears.geometry.gear_data import Web

BOTH = Reach(1, (-1, 1))
# Wider than its mate, so that layers are of two thicknesses.
TWISTED_PINION = FaceDiscretisation(
    2.7, 3, 15.0, tan(radians(15.0)) / PINION.reference_radius, overhang=4.0, overhang_layers=1
)


@pytest.fixture(scope="module")
def both():
    return face_compliance(PINION, STEEL, TWISTED_PINION, BOTH)


@pytest.fixture(scope="module")
def sector() -> SweptSector:
    return swept_sector(mesh(both_flanks=True))


def swept_sector(section_mesh, gear=GEAR) -> SweptSector:
    """With all nodes of its cuts."""
    with pytest.MonkeyPatch.context() as exact:
        exact.setattr(coarse_cuts, "THICKEST", 0.0)
        return condensed_swept_sector(section_mesh, TWISTED, 0.3, gear.teeth, both=True)


def flank_nodes(section_mesh, side):
    return by_radius(section_mesh.edge_nodes(side, ELEMENT.order))


def test_the_shapes_of_a_flank_are_all_that_its_cuts_move():
    """The matrix itself, of full rank."""
    numbers = np.random.default_rng(1)
    low, full = numbers.normal(size=(60, 15)) @ numbers.normal(size=(15, 40)), numbers.normal(size=(60, 40))
    for matrix, most in ((low, 25), (low.T, 25), (full, 60)):
        columns, rows = spanned(matrix)
        assert columns.shape[1] <= most
        assert difference(columns.T @ columns, np.eye(columns.shape[1])) < 1e-12
        assert difference(columns @ rows, matrix) < 1e-11


def of_few_and_of_all_nodes(gear, face, monkeypatch):
    """Bodies whose cuts have few nodes, and all, which differ by 1e-4 at most."""
    few = face_compliance(gear, STEEL, face, Reach(1))
    monkeypatch.setattr(coarse_cuts, "THICKEST", 0.0)
    whole = face_compliance(gear, STEEL, face, Reach(1))
    assert few.timings["condensed_unknowns"] < whole.timings["condensed_unknowns"]
    assert 0.0 < abs(few.blocks - whole.blocks).max() < 1e-4 * abs(whole.blocks).max()
    return few, whole


def test_few_nodes_of_a_cut_deep_below_the_root_stand_for_all(monkeypatch):
    """Brute force: the same ring with all nodes of the cuts. Under a load on a whole flank, along its normals, they
    differ by a tenth of what the error of transmission is promised to, 0.3 %."""
    gear = replace(PINION, teeth=24, tip_radius=59.0, root_radius=49.0, bore_radius=25.0)
    face = FaceDiscretisation(2.7, 4, 24.0, 0.006)
    few, whole = of_few_and_of_all_nodes(gear, face, monkeypatch)
    load = np.tile(whole.near.normals[0], (len(whole.heights), 1)).ravel()
    assert load @ few.blocks[0] @ load == pytest.approx(load @ whole.blocks[0] @ load, rel=3e-4)


def test_a_narrow_sector_holds_all_that_a_wide_one_has(monkeypatch):
    """Brute force: the same sector with all its layers condensed. Under an even load on its flanks, cuts held, they
    differ by 1e-5 at most."""
    section = mesh(both_flanks=True)
    sweep = Sweep(layers_of_face(14, 35.0), 0.02)
    found = condensed_swept_sector(section, sweep, 0.3, GEAR.teeth, both=True)
    monkeypatch.setattr(coarse_cuts, "ENOUGH", 14)
    whole = condensed_swept_sector(section, sweep, 0.3, GEAR.teeth, both=True)
    assert found.timings["unknowns"] == whole.timings["unknowns"]
    assert (found.lower == whole.lower).all()
    assert difference(found.stiffness, found.stiffness.T) < 1e-14
    assert 0.0 < difference(found.stiffness, whole.stiffness) < 1e-6
    flanks = len(whole.stiffness) - 2 * whole.lower.size
    even = np.ones(flanks)
    moved, expected = (np.linalg.solve(each.stiffness[:flanks, :flanks], even) for each in (found, whole))
    assert difference(moved, expected) < 1e-5


@pytest.mark.nightly
@pytest.mark.parametrize("web", [None, Web(45.0, 98.0, 0.2), Web(45.0, 98.0, 0.05, offset=0.4)])
def test_few_motions_of_a_cut_stand_for_all(web, monkeypatch):
    """Brute force: the same ring with all dofs of the cuts."""
    gear = replace(PINION, teeth=48, tip_radius=113.3, root_radius=103.25, bore_radius=30.0, web=web)
    face = FaceDiscretisation(4.5, 8, 36.0, 0.003)
    if web is not None:
        sides = (face.face_width * (web.offset + side * web.share) for side in (-0.5, 0.5))
        face = replace(face, web=SweptWeb(web.hub_radius, web.rim_radius, *sides))
    few = face_compliance(gear, STEEL, face, Reach(1)).blocks
    monkeypatch.setattr(condensed, "between_few_motions", lambda parts, profile, teeth: parts)
    whole = face_compliance(gear, STEEL, face, Reach(1)).blocks
    assert 0.0 < abs(few - whole).max() < 2e-6 * abs(whole).max()


def test_hands_mirror_each_other():
    """Exact symmetry: z -> -z turns hands."""
    right, left = (
        face_compliance(PINION, STEEL, replace(TWISTED_PINION, twist=sign * TWISTED_PINION.twist), Reach(1))
        for sign in (1.0, -1.0)
    )
    nodes, heights = len(right.roll_angle), len(right.heights)
    flip = np.kron(np.eye(heights)[::-1], np.kron(np.eye(nodes), np.diag([1.0, 1.0, -1.0])))
    assert np.array_equal(right.heights, -right.heights[::-1])
    for one, other in zip(right.blocks, left.blocks):
        assert difference(flip @ one @ flip.T, other) < 1e-10


def even_load(compliance, component):
    """Compliance (n, n) to loads of 1 N/mm, even along the face, mean over the face."""
    heights, nodes = len(compliance.heights), len(compliance.roll_angle)
    share = np.zeros(heights)
    for layer, thickness in enumerate(np.diff(compliance.heights[::2])):
        share[2 * layer : 2 * layer + 3] += thickness * np.array([1.0, 4.0, 1.0]) / 6.0
    block = compliance.blocks[0].reshape(heights, nodes, 3, heights, nodes, 3)[:, :, component, :, :, component]
    return np.einsum("h,hakb,k->ab", share, block, share) / share.sum()


@pytest.mark.parametrize(
    ("width", "layers", "limit"),
    [(0.05, 1, "plane stress"), pytest.param(270.0, 6, "plane strain", marks=pytest.mark.nightly)],
)
def test_limits_of_a_spur_gear(width, layers, limit):
    """Theory of elasticity: a thin gear is in plane stress, the plane strain of nu/(1 + nu) and E (1 + 2 nu)/(1 +
    nu)^2."""
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
    """Exact scaling: displacement per force goes with 1/(E m); lengths with the module."""
    twice = replace(
        PINION,
        **{
            name: 2.0 * getattr(PINION, name)
            for name in ("module", "tip_radius", "root_radius", "bore_radius", "rack_tip_radius")
        },
    )
    larger = replace(
        TWISTED_PINION, section_size=2.0 * 2.7, face_width=30.0, twist=0.5 * TWISTED_PINION.twist, overhang=8.0
    )
    cache = Cache(tmp_path)
    first = face_compliance(PINION, STEEL, TWISTED_PINION, BOTH, cache)
    second = face_compliance(twice, replace(STEEL, youngs_modulus=2.0 * STEEL.youngs_modulus), larger, BOTH, cache)
    assert not first.timings["from_cache"] and second.timings["from_cache"]
    assert np.array_equal(first.blocks, both.blocks)
    np.testing.assert_allclose(4.0 * second.blocks, first.blocks, rtol=1e-13)
    np.testing.assert_allclose(second.heights, 2.0 * first.heights, rtol=1e-13)
    np.testing.assert_allclose(2.0 * second.plane.blocks, first.plane.blocks, rtol=1e-13)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"section_size": 0.0}, "section_size is 0.0 mm"),
        ({"layers": 0}, "layers is 0"),
        ({"twist": 0.2}, "take 9 or more"),
    ],
)
def test_impossible_bodies_are_refused(change, message):
    """What is wrong, and what is allowed."""
    with pytest.raises(SceneError, match=message):
        face_compliance(PINION, STEEL, replace(TWISTED_PINION, **change), Reach(0))


@pytest.mark.parametrize(("layers", "reach"), [(1, Reach(0)), (1, BOTH), (4, Reach(0))])
def test_expected_size(layers, reach):
    """The mesh itself: condensed unknowns exactly, all within 18 %."""
    gear, face = replace(PINION, teeth=24, tip_radius=59.0, root_radius=49.0), FaceDiscretisation(1.35, layers, 3.0)
    found = face_compliance(gear, STEEL, face, reach).timings
    size = expected_size(gear, face, reach.across is not None)
    assert size.condensed == found["condensed_unknowns"]
    assert size.unknowns == pytest.approx(found["unknowns"], rel=0.18)
