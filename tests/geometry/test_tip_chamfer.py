"""Gears with a chamfer or a rounded edge between flank and tip circle."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.geometry.test_impossible_gears import changed
from tests.random_pairs import valid_pairs

from fenics_gears import GeometryError, gear_pair
from fenics_gears.geometry.involute import canonical_normal, canonical_point
from fenics_gears.geometry.outline import tip_corner
from fenics_gears.geometry.pair_checks import fillet_clearance
from fenics_gears.geometry.tip_edge import tip_edge

CHAMFER = 0.4


@pytest.fixture
def chamfered(paper_data):
    return gear_pair(changed(paper_data, {"pinion.tip_chamfer": CHAMFER, "wheel.tip_chamfer": CHAMFER}))


def test_contact_ends_at_the_tip_form_circle(paper_data, chamfered):
    """ISO 21771: d_Fa = d_a - 2 h_K ends the usable flank; tip clearances are those of the tips."""
    turned_down = gear_pair(
        changed(paper_data, {"pinion.tip_diameter": 82.64 - 2 * CHAMFER, "wheel.tip_diameter": 118.64 - 2 * CHAMFER})
    )
    for name in ("path_start", "path_end", "contact_ratio", "hpstc", "lpstc"):
        assert getattr(chamfered, name) == pytest.approx(getattr(turned_down, name), rel=1e-12)
    assert chamfered.tip_clearances == gear_pair(paper_data).tip_clearances


def test_the_chamfer_is_as_long_on_the_tip_circle_as_on_the_flank(chamfered):
    """Definition, by fine polygons."""
    for gear in (chamfered.pinion, chamfered.wheel):
        sharp = replace(gear, tip_chamfer=0.0)
        flank = canonical_point(gear.base_radius, np.linspace(gear.tip_roll_angle, sharp.tip_roll_angle, 2001))
        start, end = (np.arctan2(point[1], point[0]) for point in (flank[-1], tip_corner(gear)))
        on_flank = np.linalg.norm(np.diff(flank, axis=0), axis=1).sum()
        assert gear.tip_radius * (start - end) == pytest.approx(on_flank, rel=1e-6)
        assert np.linalg.norm(tip_corner(gear)) == pytest.approx(gear.tip_radius, rel=1e-14)
        assert np.linalg.norm(flank[0]) == pytest.approx(gear.tip_radius - CHAMFER, rel=1e-14)


@pytest.mark.parametrize("radius", [0.0, 0.05, 0.3])
def test_the_edge_of_corner_contact_is_between_flank_and_chamfer(radius, chamfered):
    """Definition: tangent to both."""
    gear = chamfered.pinion
    edge, foot, end = tip_edge(gear, radius), canonical_point(gear.base_radius, gear.tip_roll_angle), tip_corner(gear)
    first, last = edge.points(np.array([0.0, 1.0]))
    assert first == pytest.approx(canonical_point(gear.base_radius, edge.flank_roll), abs=1e-9)
    assert edge.flank_normal == pytest.approx(canonical_normal(edge.flank_roll), abs=1e-12)
    assert edge.tip_normal @ (end - foot) == pytest.approx(0.0, abs=1e-12)
    assert edge.tip_normal @ (last - foot) == pytest.approx(0.0, abs=1e-9)
    assert edge.tip_normal @ foot > 0.0


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"wheel.tip_chamfer": 9.0}, ["wheel: gears.wheel.tip_chamfer = 9 mm", "involute must be left"]),
        ({"wheel.tip_chamfer": 2e-306}, ["wheel: gears.wheel.tip_chamfer = 2e-306 mm", "0 mm, or at least 4.5e-06 mm"]),
        ({"pinion.tip_chamfer": 1.5}, ["pinion: pointed tip", "gears.pinion.tip_chamfer = 1.5 mm", "off either side"]),
    ],
)
def test_a_chamfer_that_does_not_fit_is_refused(paper_data, changes, said):
    """House rule: which gear, the value, the limit, the field."""
    with pytest.raises(GeometryError) as refused:
        gear_pair(changed(paper_data, changes))
    for part in said:
        assert part in str(refused.value)


def test_a_chamfer_takes_the_tip_corner_out_of_a_fillet(paper_data, chamfered):
    """Limit and order."""
    pair = gear_pair(paper_data)
    hair = replace(pair.wheel, tip_chamfer=1e-9)
    sharp, almost, open_ = (
        fillet_clearance(pair.pinion, wheel, pair.centre_distance) for wheel in (pair.wheel, hair, chamfered.wheel)
    )
    assert almost == pytest.approx(sharp, abs=1e-7)
    assert open_ > sharp + 0.1 * CHAMFER


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
