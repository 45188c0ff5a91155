"""Rounded tip edges."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.random_pairs import valid_pairs

from fenics_gears import GeometryError
from fenics_gears.geometry.involute import canonical_normal, canonical_point
from fenics_gears.geometry.tip_edge import tip_edge


@given(valid_pairs(), st.floats(0.001, 0.04))
def test_the_arc_is_tangent_to_flank_and_tip_circle(pair, share):
    """Definition: points and normals of involute and tip circle, inside that circle."""
    for gear in (pair.pinion, pair.wheel):
        edge = tip_edge(gear, share * min(gear.tip_thickness, gear.module))
        start, end = edge.points(np.array([0.0, 1.0]))
        assert start == pytest.approx(canonical_point(gear.base_radius, edge.flank_roll), abs=1e-9 * gear.module)
        assert edge.flank_normal == pytest.approx(canonical_normal(edge.flank_roll), abs=1e-12)
        assert np.linalg.norm(end) == pytest.approx(gear.tip_radius, rel=1e-12)
        assert edge.tip_normal == pytest.approx(end / gear.tip_radius, abs=1e-9)
        assert np.linalg.norm(edge.points(np.linspace(0.0, 1.0, 50)), axis=-1).max() <= gear.tip_radius * (1.0 + 1e-12)


def test_without_radius_the_edge_is_where_flank_and_tip_circle_meet(paper_pair):
    """Limit."""
    gear = paper_pair.pinion
    sharp, rounded = tip_edge(gear, 0.0), tip_edge(gear, 1e-6)
    assert sharp.flank_roll == gear.tip_roll_angle
    assert sharp.centre == pytest.approx(canonical_point(gear.base_radius, gear.tip_roll_angle), rel=1e-14)
    assert rounded.centre == pytest.approx(sharp.centre, abs=3e-6)


@pytest.mark.parametrize("radius", [-0.1, 1.5, np.nan])
def test_a_radius_that_does_not_fit_is_refused(radius, paper_pair):
    """Half the tooth's thickness at the tip at most, 1.33 mm."""
    with pytest.raises(GeometryError, match="corner_contact.edge_radius"):
        tip_edge(paper_pair.pinion, radius)
