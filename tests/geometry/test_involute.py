"""The involute on the line of action, and its inverse."""

from math import radians

import numpy as np
import pytest

from fenics_gears.contact.flank_at_height import roll_angle_at_height
from fenics_gears.geometry.involute import (
    arc_length,
    canonical_normal,
    canonical_point,
    flank_point,
    inverse_involute,
    involute_function,
    roll_angle_at_arc_length,
)

ROLLS = np.linspace(0.01, 1.2, 40)


@pytest.mark.parametrize(
    ("pressure_angle", "table"), [(14.5, 0.005545), (20.0, 0.014904), (25.0, 0.029975), (26.0, 0.033947)]
)
def test_involute_function_is_the_table_s(pressure_angle, table):
    """Tables in gear handbooks (inv 20 deg = 0.014904)."""
    assert involute_function(np.tan(radians(pressure_angle))) == pytest.approx(table, abs=6e-7)
    assert np.degrees(np.arctan(inverse_involute(table))) == pytest.approx(pressure_angle, abs=1e-3)


def test_inverse_involute_undoes_the_involute_function():
    """Exact identity; v^2 limits the digits near the base circle."""
    rolls = np.concatenate([[1e-3], ROLLS, [5.0]])
    found = np.array([inverse_involute(involute_function(roll)) for roll in rolls])
    assert np.all(np.abs(found - rolls) <= 1e-15 * (2.0 + 10.0 / rolls**2))
    assert inverse_involute(0.0) == 0.0


def test_every_normal_is_tangent_to_the_base_circle():
    """Definition: back along the normal by rb v, at a right angle."""
    feet = canonical_point(40.0, ROLLS) - (40.0 * ROLLS)[:, None] * canonical_normal(ROLLS)
    assert np.hypot(*feet.T) == pytest.approx(40.0, rel=1e-14)
    assert np.sum(feet * canonical_normal(ROLLS), axis=1) == pytest.approx(0.0, abs=1e-13)


def test_the_normal_is_perpendicular_to_the_curve_and_points_out_of_the_tooth(paper_pair):
    """Central differences; material lies at -x."""
    step = 1e-5
    chord = canonical_point(40.0, ROLLS + step) - canonical_point(40.0, ROLLS - step)
    assert np.sum(chord * canonical_normal(ROLLS), axis=1) == pytest.approx(0.0, abs=1e-12)
    pinion = paper_pair.pinion
    centreline = -0.5 * np.pi - pinion.tooth_half_angle_at_base
    flank = canonical_point(pinion.base_radius, 0.4)
    middle = np.hypot(*flank) * np.array([np.cos(centreline), np.sin(centreline)])
    assert (middle - flank) @ canonical_normal(0.4) < 0.0


@pytest.mark.parametrize("contact_roll", [0.0, 0.02, 0.5, 1.1])
def test_roll_angle_at_height_undoes_flank_point(contact_roll):
    """Exact identity; h changes with v^2 near the base circle."""
    rolls = np.concatenate([[0.0, 1e-3], np.linspace(0.01, contact_roll + 1.4, 300)])
    heights = flank_point(40.0, rolls, contact_roll)[1]
    found = roll_angle_at_height(40.0, contact_roll, heights)
    assert flank_point(40.0, found, contact_roll)[1] == pytest.approx(heights, rel=1e-14)
    assert found**2 == pytest.approx(rolls**2, abs=2e-14)


def test_heights_without_a_flank_point_give_nan():
    """From rb cos(vc) at v = 0 to rb (vc + pi/2)."""
    lowest, highest = 40.0 * np.cos(0.5), 40.0 * (0.5 + 0.5 * np.pi)
    found = roll_angle_at_height(40.0, 0.5, [lowest - 1e-9, lowest + 1e-9, 40.0, highest - 1e-3, highest + 1e-9])
    assert np.isnan(found).tolist() == [True, False, False, False, True]


def test_arc_length_is_the_length_of_the_curve():
    """Sum of chords (Richardson: 4th order)."""

    def chords(count):
        points = canonical_point(40.0, np.linspace(0.0, 0.9, count + 1))
        return np.hypot(*np.diff(points, axis=0).T).sum()

    assert (4.0 * chords(800) - chords(400)) / 3.0 == pytest.approx(arc_length(40.0, 0.9), rel=1e-9)
    assert roll_angle_at_arc_length(40.0, arc_length(40.0, ROLLS)) == pytest.approx(ROLLS, rel=1e-14)


def gap(pair, position, offset):
    roll_1, roll_2 = pair.pinion_roll_angle(position), pair.wheel_roll_angle(position)
    rb_1, rb_2 = pair.pinion.base_radius, pair.wheel.base_radius
    flank_1 = roll_angle_at_height(rb_1, roll_1, rb_1 - offset)
    flank_2 = roll_angle_at_height(rb_2, roll_2, rb_2 + offset)
    return pair.line_of_action_length - flank_point(rb_1, flank_1, roll_1)[0] - flank_point(rb_2, flank_2, roll_2)[0]


def test_two_flanks_touch_on_the_line_of_action_with_their_relative_curvature(paper_pair):
    """Gap = y^2/2 (1/xi + 1/(L - xi)) + O(y^3)."""
    for position in np.linspace(paper_pair.path_start, paper_pair.path_end, 7):
        curvature = 1.0 / position + 1.0 / (paper_pair.line_of_action_length - position)
        assert gap(paper_pair, position, 0.0) == pytest.approx(0.0, abs=1e-13)
        offsets = np.array([-0.2, -0.02, -0.002, 0.002, 0.02, 0.2])
        remainder = gap(paper_pair, position, offsets) - 0.5 * curvature * offsets**2
        assert np.all(np.abs(remainder) < 2.0 * curvature**2 * np.abs(offsets) ** 3)
