"""The tooth outline against the rack that cuts it, and the cross-section that it bounds."""

from math import atan, cos, pi, radians, sin, tan

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.random_pairs import valid_pairs

from fenics_gears import GeometryError
from fenics_gears.geometry.involute import canonical_normal
from fenics_gears.geometry.outline import fillet_tangent, tooth_outline
from fenics_gears.geometry.section import cells_section, gear_section

CUTS = {
    "standard 20 teeth": dict(teeth=20),
    "paper's wheel": dict(teeth=24, profile_shift=0.125, dedendum=1.195, module=4.5),
    "few teeth, large shift": dict(teeth=8, profile_shift=0.7, addendum=0.6),
    "many teeth, negative shift": dict(teeth=120, profile_shift=-0.6),
    "sharp rack": dict(teeth=30, rack_tip=0.0),
    "rounding centre above the pitch line": dict(teeth=20, profile_shift=1.0, addendum=0.5),
    "25 deg, full radius": dict(teeth=17, pressure_angle=25.0, rack_tip=0.3178),
}
UNDERCUT = {
    "undercut: 14 teeth": dict(teeth=14),
    "undercut: 12 teeth, sharp rack": dict(teeth=12, rack_tip=0.0),
    "undercut: 8 teeth, full radius": dict(teeth=8, rack_tip=0.47),
    "undercut: 6 teeth, negative shift": dict(teeth=6, profile_shift=-0.4, addendum=1.2),
    "undercut by a hair": dict(teeth=17, dedendum=1.2503, rack_tip=0.38),
}
CUTS |= UNDERCUT
CUTS |= {
    "undercut helix of 20 deg": dict(teeth=10, helix_angle=20.0, module=3.0),
    "undercut helix of 35 deg, sharp rack": dict(teeth=6, rack_tip=0.0, helix_angle=35.0),
    "helix of 15 deg": dict(teeth=20, helix_angle=15.0, module=3.0),
    "helix of 30 deg, few teeth, shifted": dict(teeth=12, profile_shift=0.3, helix_angle=30.0, module=2.0),
    "helix of 40 deg, negative shift": dict(teeth=60, profile_shift=-0.4, helix_angle=40.0),
    "helix of 25 deg, sharp rack": dict(teeth=30, rack_tip=0.0, helix_angle=25.0),
    "helix of 25 deg, rounding centre above the pitch line": dict(
        teeth=20, profile_shift=1.0, addendum=0.5, helix_angle=25.0
    ),
}


@pytest.fixture(params=CUTS)
def gear(request, cut_gear):
    return cut_gear(**CUTS[request.param])


def distance_to_rack(gear, points, rotation):
    """Signed distance (n_points, n_rotations) to the rack's tooth, negative inside: straight flanks, pi m/2 thick at
    the datum line, rounded corners, in its normal section, in which distances along the pitch line are shorter by
    cos(helix angle)."""
    transverse, module, rounding = gear.pressure_angle, gear.module, gear.rack_tip_radius
    r = 0.5 * gear.teeth * module
    half_tooth = (0.5 * pi + 2.0 * gear.profile_shift * tan(transverse)) / gear.teeth + tan(transverse) - transverse
    pose = rotation - pi / gear.teeth + half_tooth
    x = np.cos(pose) * points[:, :1] - np.sin(pose) * points[:, 1:] - r * rotation
    depth = np.sin(pose) * points[:, :1] + np.cos(pose) * points[:, 1:] + r
    x, alpha = x * cos(gear.helix_angle), atan(tan(transverse) * cos(gear.helix_angle))
    half_at_pitch = cos(gear.helix_angle) * (0.25 * pi * module - gear.profile_shift * module * tan(transverse))
    half_small = half_at_pitch - rounding / cos(alpha)
    top = r - gear.root_radius - rounding
    corner = half_small - top * tan(alpha)
    beyond_flank = (np.abs(x) - half_small) * cos(alpha) + depth * sin(alpha)
    beyond_top = depth - top
    along_flank = (np.abs(x) - corner) * sin(alpha) - (depth - top) * cos(alpha)
    to_corner = np.hypot(np.abs(x) - corner, depth - top)
    outside = np.where(along_flank > 0.0, beyond_flank, np.where(np.abs(x) < corner, beyond_top, to_corner))
    inside = np.maximum(beyond_flank, beyond_top)
    return np.where(inside < 0.0, inside, outside) - rounding


def least_distance(gear, points):
    """Smallest distance (n_points,) over all positions of the rack."""
    width = 2.5 * pi / gear.teeth + 0.6
    centre = np.zeros((len(points), 1))
    for _ in range(7):
        rotation = centre + width * np.linspace(-1.0, 1.0, 601)
        distance = distance_to_rack(gear, points, rotation)
        least = np.argmin(distance, axis=1)[:, None]
        centre = np.take_along_axis(rotation, least, axis=1)
        width *= 0.02
    return np.min(distance, axis=1)


def test_the_outline_is_what_the_rack_leaves(gear):
    """Brute force: nothing is cut away, and each point is touched."""
    outline = tooth_outline(gear, fillet_points=25)
    first = np.arctan2(outline.fillet[0, 1], outline.fillet[0, 0])
    arc = np.linspace(first, outline.space_angle, 5)
    root = gear.root_radius * np.stack([np.cos(arc), np.sin(arc)], axis=1)
    flank = outline.involute(np.linspace(gear.form_roll_angle, gear.tip_roll_angle, 25))
    points = np.concatenate([root, outline.fillet, flank])
    assert least_distance(gear, points) == pytest.approx(0.0, abs=2e-10 * gear.module)


def test_fillet_ends_on_root_circle_and_involute_exactly(gear):
    """Exact identities: end points, tangents."""
    outline = tooth_outline(gear)
    start, end = outline.fillet[0], outline.fillet[-1]
    assert np.hypot(*start) == pytest.approx(gear.root_radius, rel=1e-14)
    # Where the fillet crosses the involute, close to the cusp of the involute, a rounding error counts more.
    rounding = 1e-10 if gear.undercut else 1e-14
    assert end == pytest.approx(outline.involute(gear.form_roll_angle), abs=rounding * gear.tip_radius)
    assert np.hypot(*end) == pytest.approx(gear.form_radius, rel=1e-14)
    tangents = fillet_tangent(gear, np.array([0.0, gear.fillet_end]))
    tangents /= np.hypot(*tangents.T)[:, None]
    assert tangents[0] @ start == pytest.approx(0.0, abs=1e-13 * gear.root_radius)
    turned = tangents[1] @ canonical_normal(gear.form_roll_angle)
    # A fillet that crosses the involute comes out of the tooth there: the flank has an edge.
    assert turned > 0.0 if gear.undercut else turned == pytest.approx(0.0, abs=1e-14)
    assert tangents[1] @ end > 0.0


def test_fillet_rises_towards_the_flank_in_even_steps(gear):
    """What a mesh needs: radius and, but for a neck by undercut, polar angle monotone, points equally apart."""
    fillet = tooth_outline(gear, fillet_points=60).fillet
    steps = np.hypot(*np.diff(fillet, axis=0).T)
    assert np.all(np.diff(np.hypot(*fillet.T)) > 0.0)
    thinner = np.diff(np.arctan2(fillet[:, 1], fillet[:, 0])) < 0.0
    assert gear.undercut or np.all(thinner)
    # At most one neck: thinner from the root on, thicker after.
    assert np.all(np.diff(thinner.astype(int)) <= 0)
    assert steps == pytest.approx(steps.mean(), rel=2e-3)


@pytest.mark.parametrize("helix_angle", [0.0, 25.0])
def test_fillets_of_neighbouring_teeth_meet_at_full_radius(cut_gear, helix_angle):
    """Closed form of a circle between tip line and flanks (0.472 modules in ISO 53); above it there is no outline."""
    dedendum, alpha = 1.25, radians(20.0)
    largest = (0.25 * pi - dedendum * tan(alpha)) * cos(alpha) / (1.0 - sin(alpha))
    assert largest == pytest.approx(0.472, abs=5e-4)
    outline = tooth_outline(cut_gear(30, rack_tip=largest * (1.0 - 1e-12), helix_angle=helix_angle))
    assert np.arctan2(*outline.fillet[0, ::-1]) == pytest.approx(outline.space_angle, abs=1e-10)
    with pytest.raises(GeometryError, match="overlap"):
        tooth_outline(cut_gear(30, rack_tip=largest + 1e-6, helix_angle=helix_angle))


@pytest.mark.parametrize(("pressure_angle", "fewest"), [(14.5, 31.903), (20.0, 17.097), (25.0, 11.198)])
def test_undercut_begins_at_the_textbook_s_number_of_teeth(cut_gear, pressure_angle, fewest):
    """z_min = 2/sin^2(alpha) (Litvin & Fuentes, ch. 6): 32, 17 and 12 teeth."""
    assert 2.0 / sin(radians(pressure_angle)) ** 2 == pytest.approx(fewest, abs=1e-3)
    for teeth in range(10, 40):
        gear = cut_gear(teeth, dedendum=1.0, rack_tip=0.0, pressure_angle=pressure_angle)
        assert gear.undercut == (teeth < fewest)
        assert gear.form_radius > gear.base_radius


def polygon(gear, points=4001):
    """Half a tooth's outline (n, 2), mm, from the middle of the tip to that of the space."""
    outline = tooth_outline(gear, points)
    fillet, involute = outline.fillet, outline.involute(np.linspace(gear.form_roll_angle, gear.tip_roll_angle, points))
    tip, root = (np.arctan2(*point[::-1]) for point in (involute[-1], fillet[0]))

    def arc(radius, first, last):
        at = np.linspace(first, first + (last - first + pi) % (2 * pi) - pi, points)
        return radius * np.column_stack([np.cos(at), np.sin(at)])

    return np.vstack([
        arc(gear.tip_radius, outline.centreline_angle, tip), involute[::-1], fillet[::-1],
        arc(gear.root_radius, root, outline.space_angle)
    ])  # fmt: skip


def brute_force(gear):
    """Triangles from the centre to the outline's polygon, less the bore."""
    half = polygon(gear)
    corners = np.vstack([np.zeros((1, 2)), half])
    cells = np.column_stack([np.zeros(len(half) - 1, int), np.arange(1, len(half)), np.arange(2, len(half) + 1)])
    found, bore = cells_section(corners, cells), gear.bore_radius
    return 2 * gear.teeth * found.area - pi * bore**2, 2 * gear.teeth * found.polar_moment - 0.5 * pi * bore**4


@settings(max_examples=15)
@given(st.one_of(valid_pairs(), valid_pairs(helix_angles=(1.0, 40.0))))
def test_any_gear_is_its_outline_s_polygon(pair):
    """Brute force: a polygon of sixteen thousand sides on half a tooth, within 1e-7."""
    for gear in (pair.pinion, pair.wheel):
        found, expected = gear_section(gear), brute_force(gear)
        assert (found.area, found.polar_moment) == pytest.approx(expected, rel=1e-7)


def test_cells_of_a_regular_polygon():
    """Exact: n/2 R^2 sin(2 pi/n), A R^2 (2 + cos(2 pi/n))/6; a disc in the limit."""
    for corners, radius in ((5, 3.0), (100_000, 20.0)):
        at = 2.0 * pi * np.arange(corners) / corners
        points = np.vstack([[0.0, 0.0], radius * np.column_stack([np.cos(at), np.sin(at)])])
        cells = np.column_stack(
            [np.zeros(corners, int), 1 + np.arange(corners), 1 + (1 + np.arange(corners)) % corners]
        )
        found, step = cells_section(points, cells), 2.0 * pi / corners
        area = 0.5 * corners * radius**2 * sin(step)
        assert found.area == pytest.approx(area, rel=1e-12)
        assert found.polar_moment == pytest.approx(area * radius**2 * (2.0 + cos(step)) / 6.0, rel=1e-12)
    assert (found.area, found.polar_moment) == pytest.approx((pi * radius**2, 0.5 * pi * radius**4), rel=1e-8)
