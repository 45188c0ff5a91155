"""Measures of the tooth thickness."""

from math import cos, pi, radians, sin, tan

import numpy as np
import pytest
from scipy.optimize import minimize

from fenics_gears.geometry.gear import transverse_gear
from fenics_gears.geometry.gear_data import GearData
from fenics_gears.geometry.tooth_thickness import (
    ball_centre,
    ball_contact_radius,
    ball_diameter,
    base_tangent_length,
    dimension_over_balls,
    normal_thickness,
    shift_of_base_tangent_length,
    shift_of_dimension_over_balls,
    shift_of_normal_thickness,
    spanned_teeth,
    tangent_contact_radius,
)


def gear(module, teeth, shift, helix_angle=0.0, pressure_angle=20.0):
    return transverse_gear(
        GearData(teeth, shift, 0.0, 0.0, 0.0, 0.0), module, radians(pressure_angle), radians(helix_angle)
    )


@pytest.mark.parametrize(
    ("of", "teeth", "printed"),
    [(gear(3, 24, 0.4), 4, 32.8266), (gear(3, 24, 0.4, 25.0), 5, 42.0085), (gear(2, 20, 0.0), 3, 15.3209)],
)
def test_base_tangent_length_of_printed_examples(of, teeth, printed):
    """KHK Gear Technical Reference; m 2, z 20: machinecalcs.com (15.321 mm), to the printed digits."""
    assert spanned_teeth(of) == teeth
    assert base_tangent_length(of, teeth) == pytest.approx(printed, abs=6e-5)


def test_a_caliper_touches_where_the_example_says():
    """machinecalcs.com, contact diameter 40.59 mm."""
    assert 2.0 * tangent_contact_radius(gear(2, 20, 0.0), 15.3209) == pytest.approx(40.59, abs=5e-3)


@pytest.mark.parametrize(("of", "printed"), [(gear(10, 12, 0.3), 17.8918), (gear(5, 16, 0.2, 25.0), 8.5819)])
def test_normal_thickness_of_printed_examples(of, printed):
    """SDP/SI, Elements of Metric Gear Technology, section 10.1."""
    assert normal_thickness(of) == pytest.approx(printed, abs=6e-5)


@pytest.mark.parametrize("helix_angle", [0.0, 24.0])
@pytest.mark.parametrize("shift", [-0.2, 0.5])
def test_a_ball_touches_the_flanks(helix_angle, shift):
    """Brute force: the least distance from the ball's centre to the flank's surface, at the radius of contact."""
    of, diameter = gear(2.5, 23, shift, helix_angle), 4.5
    centre, lead = ball_centre(of, diameter), tan(of.helix_angle) / of.reference_radius
    # Half angle of the space at the base circle, from the middle of the space to the start of the involute.
    space = pi / of.teeth - of.tooth_half_angle_at_base

    def distance(place):
        roll, along = place
        polar = space + roll - np.arctan(roll) + lead * along
        radius = of.base_radius * np.sqrt(1.0 + roll**2)
        return np.hypot(np.hypot(radius * cos(polar) - centre, radius * sin(polar)), along)

    found = minimize(
        distance,
        (float(of.roll_angle(centre)), 0.0),
        method="Nelder-Mead",
        options={"xatol": 1e-11, "fatol": 1e-13, "maxiter": 2000},
    )
    assert found.fun == pytest.approx(0.5 * diameter, abs=1e-9)
    assert of.radius(found.x[0]) == pytest.approx(ball_contact_radius(of, diameter), abs=1e-5)


@pytest.mark.parametrize("teeth", [22, 23])
def test_two_balls_are_as_far_apart_as_their_spaces(teeth):
    """Brute force: the largest distance of two balls' centres, plus a ball."""
    of = gear(2.0, teeth, 0.3)
    angles = 2.0 * pi * np.arange(teeth) / teeth
    centres = ball_centre(of, 3.5) * np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    assert dimension_over_balls(of, 3.5) == pytest.approx(
        np.max(np.linalg.norm(centres - centres[0], axis=-1)) + 3.5, rel=1e-12
    )


@pytest.mark.parametrize("helix_angle", [0.0, 17.0])
@pytest.mark.parametrize("teeth", [17, 40])
@pytest.mark.parametrize("shift", [-0.3, 0.0, 0.6])
def test_each_measure_gives_back_the_profile_shift(teeth, helix_angle, shift):
    """Identity; what the program chooses touches near the shifted reference circle."""
    of, bare = gear(3.0, teeth, shift, helix_angle, 22.5), gear(3.0, teeth, 0.0, helix_angle, 22.5)
    count, ball = spanned_teeth(of), ball_diameter(of)
    assert shift_of_normal_thickness(bare, normal_thickness(of)) == pytest.approx(shift, abs=1e-12)
    assert shift_of_base_tangent_length(bare, base_tangent_length(of, count), count) == pytest.approx(shift, abs=1e-11)
    assert shift_of_dimension_over_balls(bare, dimension_over_balls(of, ball), ball) == pytest.approx(shift, abs=1e-11)
    middle = of.reference_radius + 3.0 * shift
    assert ball_contact_radius(of, ball) == pytest.approx(middle, abs=0.3)
    assert tangent_contact_radius(of, base_tangent_length(of, count)) == pytest.approx(middle, abs=1.5)
