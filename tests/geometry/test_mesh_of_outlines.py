"""Two whole tooth outlines in mesh."""

from dataclasses import replace

import numpy as np
import pytest

from fenics_gears import involute_function
from fenics_gears.geometry.outline import fillet_point, tooth_outline
from fenics_gears.geometry.pair_checks import fillet_clearance


def tooth_points(gear):
    outline = tooth_outline(gear)
    fillet = fillet_point(gear, np.linspace(0.0, gear.fillet_end, 3001))
    flank = outline.involute(np.linspace(gear.form_roll_angle, gear.tip_roll_angle, 3001)[1:])
    return np.concatenate([fillet, flank])


def half_angle(gear, radius):
    """Of the tooth (rad) at radii between root and tip."""
    outline = tooth_outline(gear)
    fillet = fillet_point(gear, np.linspace(0.0, gear.fillet_end, 3001))
    fillet_angle = np.arctan2(fillet[:, 1], fillet[:, 0]) - outline.centreline_angle
    on_fillet = np.interp(radius, np.hypot(*fillet.T), fillet_angle)
    flank = gear.tooth_half_angle_at_base - involute_function(gear.roll_angle(np.maximum(radius, gear.form_radius)))
    return np.where(radius < gear.form_radius, on_fillet, flank)


def turned(vectors, angle):
    cosine, sine = np.cos(angle), np.sin(angle)
    return vectors @ np.array([[cosine, sine], [-sine, cosine]])


def gaps(pair, position):
    """Least angular gaps (rad) of the wheel's points from drive and coast flanks of the pinion."""
    pinion, wheel = pair.pinion, pair.wheel
    drive = tooth_points(wheel)
    centre = [pair.line_of_action_length, -(pinion.base_radius + wheel.base_radius)]
    body = np.concatenate([drive, tooth_outline(wheel).coast(drive)])
    found = []
    for tooth in range(-2, 3):
        angle = pair.wheel_roll_angle(position) + np.pi + tooth * wheel.angular_pitch
        points = turned(turned(body, angle) + centre, -pair.pinion_roll_angle(position))
        radius = np.hypot(*points.T)
        polar = np.arctan2(points[:, 1], points[:, 0]) - tooth_outline(pinion).centreline_angle
        polar = (polar + 0.5 * pinion.angular_pitch) % pinion.angular_pitch - 0.5 * pinion.angular_pitch
        near = (radius <= pinion.tip_radius) & (radius >= pinion.root_radius)
        assert np.all(radius >= pinion.root_radius)
        gap = np.abs(polar) - half_angle(pinion, np.minimum(radius, pinion.tip_radius))
        found.append([np.min(gap[near & side], initial=np.inf) for side in (polar > 0.0, polar < 0.0)])
    return np.min(found, axis=0)


@pytest.mark.parametrize("phase", [0.0, 0.2, 0.47, 0.6, 0.9])
def test_drive_flanks_touch_and_coast_flanks_are_apart_by_the_backlash(paper_pair, phase):
    """Brute force over the outlines in space; sampling errs by less than 1e-6 mm."""
    pair = paper_pair
    drive, coast = gaps(pair, pair.path_start + phase * pair.base_pitch)
    assert drive * pair.pinion.base_radius == pytest.approx(0.0, abs=1e-6)
    assert coast * pair.pinion.base_radius == pytest.approx(pair.backlash, abs=1e-6)


def test_tip_corner_that_cuts_into_a_fillet_off_the_line_of_action(paper_pair):
    """Brute force: clearance is in order, yet a shallow root with a large fillet is hit; the paper's is free."""
    pinion = replace(paper_pair.pinion, root_radius=31.8, rack_tip_radius=0.45 * 4.5)
    shallow = replace(paper_pair, pinion=pinion)
    assert shallow.tip_clearances[1] > 0.0 and shallow.sap_roll_angles[0] > pinion.form_roll_angle
    assert fillet_clearance(pinion, shallow.wheel, 91.5) < -0.01
    assert fillet_clearance(paper_pair.pinion, paper_pair.wheel, 91.5) > 0.01
    positions = np.linspace(shallow.path_start, shallow.path_end, 40)
    least = [min(gaps(pair, position)[0] for position in positions) for pair in (shallow, paper_pair)]
    assert least[0] < -1e-4 and least[1] > -1e-7
