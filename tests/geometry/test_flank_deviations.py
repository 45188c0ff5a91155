"""Flank tolerances, and deviations of teeth."""

import numpy as np
import pytest

from fenics_gears import flank_tolerance, helix_tolerance
from fenics_gears.geometry.flank_deviations import flank_deviations
from fenics_gears.geometry.flank_errors import FlankErrors, GearErrors

EVERY_CLASS = range(1, 12)


def test_tolerances_are_those_of_the_standard():
    """ISO 1328-1:2013, module 3 mm, 40 teeth, class 6: 8.94 um, 28.80 um before rounding, 12 um rounded."""
    found = flank_tolerance(120.0, 3.0, 6)
    assert found.single_pitch == pytest.approx(8.94e-3, abs=5e-6)
    assert found.cumulative_pitch == pytest.approx(28.80e-3, abs=5e-6)
    assert round(1e3 * found.profile) == 12


def test_helix_tolerances_are_those_of_the_standard():
    """ISO 1328-1:2013, formulas (10) to (12), as two published programs have them: d = 400 mm, b = 100 mm."""
    found = helix_tolerance(400.0, 100.0, 5)
    assert (found.slope, found.form) == pytest.approx((8.5e-3, 9.9e-3), rel=1e-12)
    assert found.total == pytest.approx(np.hypot(8.5e-3, 9.9e-3), rel=1e-12)
    assert helix_tolerance(400.0, 100.0, 7).slope == pytest.approx(17e-3, rel=1e-12)


def test_helix_deviations_are_drawn_over_a_face_only(paper_pair):
    """Definition: within tolerance, by numbers of their own; none in the plane."""
    errors = FlankErrors(tolerance_class=6, seed=4, wheel=GearErrors(helix_slope=(0.001,) * 24))
    plane, face = flank_deviations(errors, paper_pair), flank_deviations(errors, paper_pair, (1.0, -1.0))
    limits = helix_tolerance(2.0 * paper_pair.pinion.reference_radius, paper_pair.face_width, 6)
    for flat, wide in zip(plane, face):
        assert flat.helix is None
        assert (
            np.array_equal(flat.index, wide.index)
            and np.array_equal(flat.slope, wide.slope)
            and np.array_equal(flat.form, wide.form)
        )
    assert 0.5 * limits.slope < np.abs(face[0].helix.slope).max() <= limits.slope
    assert 0.5 * limits.form < np.abs(face[0].helix.form).max() <= limits.form
    assert np.array_equal(face[1].helix.slope, np.full(24, 0.001)) and face[1].helix.middle == -1.0


@pytest.mark.parametrize("tolerance_class", EVERY_CLASS)
def test_drawn_deviations_are_just_within_their_class(paper_pair, tolerance_class):
    """Definition: none exceeds its tolerance; the single or the cumulative pitch deviation reaches it."""
    for seed in range(20):
        drawn = flank_deviations(FlankErrors(tolerance_class=tolerance_class, seed=seed), paper_pair)
        for found, gear in zip(drawn, (paper_pair.pinion, paper_pair.wheel)):
            limits = flank_tolerance(2.0 * gear.reference_radius, gear.module, tolerance_class)
            shares = (
                np.abs(found.single_pitch).max() / limits.single_pitch,
                np.ptp(found.index) / limits.cumulative_pitch,
            )
            assert max(shares) == pytest.approx(1.0, rel=1e-12)
            assert np.abs(found.slope).max() <= limits.profile_slope and np.abs(found.form).max() <= limits.profile_form
            assert 0.3 * limits.profile_slope < np.std(found.slope) < 0.9 * limits.profile_slope


def test_pitches_close_over_a_turn(paper_pair):
    """Identity."""
    for found in flank_deviations(FlankErrors(tolerance_class=8, seed=5), paper_pair):
        assert abs(found.single_pitch.sum()) <= 1e-15
        assert found.index[-1] == 0.0
        assert found.index == pytest.approx(np.cumsum(found.single_pitch), abs=1e-15)


def test_given_pitches_are_kept_and_what_rounding_leaves_of_their_sum_is_shared_out(paper_pair):
    """Definition: every pitch gives up its share."""
    given = np.round(1e-3 * np.sin(np.arange(16)), 4)
    assert abs(given.sum()) > 1e-4
    pinion, wheel = flank_deviations(FlankErrors(pinion=GearErrors(pitch=tuple(given))), paper_pair)
    assert pinion.single_pitch == pytest.approx(given - given.mean(), abs=1e-15)
    for nothing in (pinion.slope, pinion.form, wheel.index, wheel.slope, wheel.form):
        assert not nothing.any()
