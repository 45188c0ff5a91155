"""What a flank gives way less where a gear stands out beyond its mate."""

from dataclasses import replace
from math import log, pi

import numpy as np
import pytest
from tests.stand_in import stand_in_compliance

from fenics_gears import Material
from fenics_gears.elasticity.compliance import BothFlanksCompliance
from fenics_gears.elasticity.overhang import NEAR_DEPTH, near_field, with_overhang
from fenics_gears.elasticity.whole_body.compliance import WholeBodyCompliance
from fenics_gears.geometry.involute import arc_length

STEEL, SHARE = Material(206e3, 0.3), 0.7


@pytest.fixture
def body(paper_pair):
    return stand_in_compliance(paper_pair.pinion, elements=120)


def test_pressure_on_a_half_plane(paper_pair, body):
    """Johnson, Contact Mechanics, 1985, eq. 2.30 integrated: p over a length a to either side moves the point
    between by 2 (1 - nu^2) p/(pi E) times the sum of a (1 + ln(d/a)), against a point at the distance d; along and
    across alike."""
    near = near_field(paper_pair.pinion, STEEL, body.roll_angle).reshape(body.nodes, 2, body.nodes, 2)
    arc, depth = arc_length(paper_pair.pinion.base_radius, body.roll_angle), NEAR_DEPTH * paper_pair.pinion.module
    middle = len(arc) // 2
    edges, first, last = 0.5 * (arc[1:] + arc[:-1]), middle - 8, middle + 8
    moved = near[:, 0, :, 0] @ np.concatenate(
        [np.zeros(first), np.diff(edges[first - 1 : last + 1]), np.zeros(len(arc) - last - 1)]
    )
    ends = arc[middle] - edges[first - 1], edges[last] - arc[middle]
    exact = 2.0 * (1.0 - 0.3**2) / (pi * 206e3) * sum(each * (1.0 + log(depth / each)) for each in ends)
    assert max(ends) < depth and moved[middle] == pytest.approx(exact, rel=2e-3)
    assert not moved[np.abs(arc - arc[middle]) > 2.0 * depth].any()
    assert np.array_equal(near[:, 0, :, 0], near[:, 1, :, 1]) and not near[:, 0, :, 1].any()


def test_near_field_is_positive_definite(paper_pair, body):
    """Polya's criterion; so the energy of any load stays positive."""
    near = near_field(paper_pair.pinion, STEEL, body.roll_angle)
    assert np.array_equal(near, near.T) and np.linalg.eigvalsh(near)[0] > 0.0


@pytest.mark.parametrize("module", [0.2, 8.0, 60.0])
def test_near_field_of_any_size(paper_pair, body, module):
    """Similarity: in a half-plane of twice the size a line load moves a point at twice the distance as far."""
    near = near_field(paper_pair.pinion, STEEL, body.roll_angle)
    gear, factor = paper_pair.pinion, module / paper_pair.pinion.module
    lengths = ("module", "tip_radius", "root_radius", "bore_radius", "rack_tip_radius")
    sized = replace(gear, **{name: factor * getattr(gear, name) for name in lengths})
    larger = near_field(sized, STEEL, body.roll_angle)
    assert larger == pytest.approx(near, rel=1e-9, abs=1e-12 * near.max())


def test_every_kind_of_body_alike(paper_pair, body):
    """Identity: a ring, one with both flanks and one with each tooth its own; without overhang as it was."""
    gear, nodes = paper_pair.pinion, 2 * body.nodes
    assert with_overhang(body, gear, STEEL, 1.0) is body
    both = BothFlanksCompliance(body.roll_angle, 2, body.blocks, flanks=2, across=body.blocks, first_across=0)
    own = WholeBodyCompliance((body.roll_angle,) * 9, 2, (tuple(body.blocks),) * 9, {3: np.ones((1, nodes))})
    ring, both, own = (with_overhang(each, gear, STEEL, SHARE) for each in (body, both, own))
    near = near_field(gear, STEEL, body.roll_angle)
    for ahead in (-1, 0, 1):
        plain = SHARE * body.between(ahead, 0) + (0.0 if ahead else (1.0 - SHARE) * near)
        for found in (
            ring.between(ahead, 0),
            both.between(ahead, 0),
            both.between(-ahead, 0, (1, 1)),
            own.between(ahead + 4, 4),
        ):
            np.testing.assert_allclose(found, plain, rtol=1e-13)
    np.testing.assert_allclose(both.between(1, 0, (0, 1)), SHARE * body.blocks[1], rtol=1e-13)
    assert np.all(own.openings[3] == SHARE)
