"""Area and polar second moment of a gear's cross-section."""

from math import cos, pi, sin

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.random_pairs import valid_pairs

from fenics_gears.geometry.outline import tooth_outline
from fenics_gears.geometry.section import cells_section, gear_section


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
