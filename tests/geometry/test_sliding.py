"""Sliding along the path of contact."""

import numpy as np
import pytest

from fenics_gears.geometry.sliding import (
    CONTACT_POINTS,
    contact_points,
    sliding_per_rotation,
    sliding_speed,
    specific_sliding,
)


def test_specific_sliding_is_the_difference_of_the_arcs_that_roll_and_slide(paper_pair):
    """Arcs s = rb v^2/2: contact passes ds1 and ds2, and slides over ds1 - ds2 (central differences)."""
    positions = np.linspace(paper_pair.path_start, paper_pair.path_end, 9)
    advance = 1e-4

    def arcs(position):
        pinion, wheel = paper_pair.pinion, paper_pair.wheel
        return (
            0.5 * pinion.base_radius * paper_pair.pinion_roll_angle(position) ** 2,
            0.5 * wheel.base_radius * paper_pair.wheel_roll_angle(position) ** 2,
        )

    (after_1, after_2), (before_1, before_2) = arcs(positions + advance), arcs(positions - advance)
    # The wheel's contact point runs down its flank, towards its base circle.
    passed_1, passed_2 = after_1 - before_1, before_2 - after_2
    of_pinion, of_wheel = specific_sliding(paper_pair, positions)
    assert of_pinion == pytest.approx((passed_1 - passed_2) / passed_1, abs=1e-9)
    assert of_wheel == pytest.approx((passed_2 - passed_1) / passed_2, abs=1e-9)
    turned = 2.0 * advance / paper_pair.pinion.base_radius
    assert sliding_per_rotation(paper_pair, positions) == pytest.approx((passed_1 - passed_2) / turned, abs=1e-9)


def test_sliding_speed_is_the_distance_from_the_pitch_point_times_both_speeds(paper_pair):
    """ISO 21771: v_g = g (omega1 + omega2)."""
    positions = contact_points(paper_pair)
    first = 2.0 * np.pi * 200.0 / paper_pair.pinion.teeth
    distance = positions - paper_pair.pitch_point
    expected = distance * first * (1.0 + paper_pair.rotation_ratio)
    assert sliding_speed(paper_pair, positions, 200.0) == pytest.approx(expected, rel=1e-12, abs=1e-9)
    assert sliding_speed(paper_pair, positions[CONTACT_POINTS.index("C")], 200.0) == pytest.approx(0.0, abs=1e-9)
