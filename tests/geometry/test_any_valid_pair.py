"""What holds for every pair that the checks let pass."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.random_pairs import valid_pairs

from fenics_gears import involute_function
from fenics_gears.geometry.outline import fillet_speed, tooth_outline

PAIRS = st.one_of(valid_pairs(), valid_pairs(helix_angles=(1.0, 40.0)))


@given(PAIRS)
def test_points_of_the_path_of_contact_are_in_order(pair):
    """Definition: T1, start, single contact, end, T2; roll angles within either flank."""
    rounding = 1e-6
    assert -rounding <= pair.path_start < pair.path_end <= pair.line_of_action_length + rounding
    assert pair.lpstc <= pair.hpstc + 1e-8 * pair.base_pitch
    assert pair.fewest_pairs <= pair.contact_ratio + 1e-8 < pair.fewest_pairs + 1.0 + 1e-7
    along = [pair.path_start, pair.lpstc, pair.hpstc, pair.path_end]
    ends = pair.pinion_roll_angle(pair.path_end), pair.wheel_roll_angle(pair.path_start)
    named = (
        [pair.sap_roll_angles[0], pair.lpstc_roll_angles[0], pair.hpstc_roll_angles[0], ends[0]],
        [ends[1], pair.hpstc_roll_angles[1], pair.lpstc_roll_angles[1], pair.sap_roll_angles[1]],
    )
    assert named[0] == pytest.approx(pair.pinion_roll_angle(np.array(along)), rel=1e-11, abs=1e-12)
    assert named[1] == pytest.approx(pair.wheel_roll_angle(np.array(along)), rel=1e-11, abs=1e-12)
    for gear, mate, (start, low, high, end) in (
        (pair.pinion, pair.wheel, named[0]),
        (pair.wheel, pair.pinion, named[1][::-1]),
    ):
        assert gear.form_roll_angle - rounding / gear.base_radius <= start <= low <= high + 1e-7 <= end + 2e-7
        # Contact goes to the tip, unless the mate is cut away there.
        assert end <= gear.tip_roll_angle + 1e-12
        assert mate.undercut or end == pytest.approx(gear.tip_roll_angle, abs=1e-12)


@given(PAIRS)
def test_swapped_gears_are_the_same_pair(pair):
    """Exact symmetry."""
    swapped = replace(pair, pinion=pair.wheel, wheel=pair.pinion)
    length = pair.line_of_action_length
    assert swapped.path_start == pytest.approx(length - pair.path_end, abs=1e-12 * length)
    assert swapped.pitch_point == pytest.approx(pair.pitch_point_to_wheel_tangent, rel=1e-11)
    assert swapped.contact_ratio == pytest.approx(pair.contact_ratio, rel=1e-11)
    assert swapped.backlash == pytest.approx(pair.backlash, abs=1e-12 * length)
    assert swapped.hpstc_roll_angles[0] == pytest.approx(pair.hpstc_roll_angles[1], abs=1e-11)
    assert swapped.tip_clearances[0] == pair.tip_clearances[1]


@given(PAIRS, st.floats(0.1, 10.0))
def test_angles_and_ratios_do_not_know_the_module(pair, scale):
    """Similarity."""

    def scaled(gear):
        lengths = ("module", "tip_radius", "root_radius", "bore_radius", "rack_tip_radius")
        return replace(gear, **{field: scale * getattr(gear, field) for field in lengths})

    larger = replace(
        pair, pinion=scaled(pair.pinion), wheel=scaled(pair.wheel), centre_distance=scale * pair.centre_distance
    )
    assert larger.contact_ratio == pytest.approx(pair.contact_ratio, rel=1e-9)
    # The radius, which is what the rack determines: near the base circle the roll angle is as the root of its distance
    # from it, which halves the digits.
    assert larger.pinion.form_radius == pytest.approx(scale * pair.pinion.form_radius, rel=1e-11)
    assert larger.backlash == pytest.approx(scale * pair.backlash, abs=1e-11 * larger.centre_distance)
    assert tooth_outline(larger.wheel).fillet == pytest.approx(
        scale * tooth_outline(pair.wheel).fillet, abs=1e-12 * larger.centre_distance
    )


@given(PAIRS)
def test_outline_of_every_valid_gear_is_a_simple_curve(pair):
    """A tooth: radius grows and thickness falls from root to tip unless undercut, the fillet never turns back, the
    root circle has a length."""
    for gear in (pair.pinion, pair.wheel):
        outline = tooth_outline(gear)
        assert np.all(fillet_speed(gear, np.linspace(0.0, gear.fillet_end, 101)[1:]) > 0.0)
        rolls = np.linspace(gear.form_roll_angle, gear.tip_roll_angle, 30)[1:]
        points = np.concatenate([outline.fillet, outline.involute(rolls)])
        angle = np.arctan2(*points.T[::-1]) - outline.centreline_angle
        angle = (angle + np.pi) % (2.0 * np.pi) - np.pi
        assert np.all(np.diff(np.hypot(*points.T)) > -1e-12 * gear.tip_radius)
        thinner = np.diff(angle) < 1e-12
        assert np.all(thinner[len(outline.fillet) - 1 if gear.undercut else 0 :])
        assert angle[0] <= 0.5 * gear.angular_pitch + 1e-6 / gear.root_radius
        assert 2.0 * gear.tip_radius * angle[-1] == pytest.approx(gear.tip_thickness, abs=1e-11 * gear.tip_radius)


@given(PAIRS)
def test_thickness_and_backlash_fill_the_pitch_circle(pair):
    """Exact identity."""
    all_teeth = pair.pinion.teeth + pair.wheel.teeth
    rolled = [pair.centre_distance * gear.teeth / all_teeth for gear in (pair.pinion, pair.wheel)]
    circumferential = pair.backlash / np.cos(pair.operating_pressure_angle)
    swept = involute_function(np.tan(pair.operating_pressure_angle))
    teeth = [2.0 * r * (gear.tooth_half_angle_at_base - swept) for r, gear in zip(rolled, (pair.pinion, pair.wheel))]
    assert sum(teeth) + circumferential == pytest.approx(rolled[0] * pair.pinion.angular_pitch, rel=1e-11)
