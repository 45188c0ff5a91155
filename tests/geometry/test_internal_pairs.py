"""Internal gears: numbers with a sign (ISO 21771) against curves drawn by hand."""

from dataclasses import replace
from math import cos, degrees, pi, sin, sqrt, tan

import numpy as np
import pytest
from scipy.optimize import brentq, minimize_scalar
from tests.internal import ANGLE, MODULE, PLANET, planet_in_ring, ring

from fenics_gears import Gear, GeometryError
from fenics_gears.contact.tooth_pair import drive_place, facing_points_at
from fenics_gears.geometry.gear_checks import check_gear
from fenics_gears.geometry.outline import fillet_point, fillet_tangent, tooth_outline
from fenics_gears.geometry.pair import GearPair
from fenics_gears.geometry.pair_checks import check_pair, fillet_clearance
from fenics_gears.geometry.ring_checks import goes_in_radially
from fenics_gears.geometry.section import gear_section
from fenics_gears.geometry.sliding import specific_sliding
from fenics_gears.geometry.tooth_thickness import dimension_over_balls
from fenics_gears.model.resolution import relative_radius


def involute(centre, radius, begin, way, height):
    """x at a height y of the involute (string unwound by `way`) of a circle, begun at the angle `begin`."""

    def point(unwound):
        angle = begin + way * unwound
        return centre + radius * np.array(
            [np.cos(angle) + way * unwound * np.sin(angle), np.sin(angle) - way * unwound * np.cos(angle)]
        )

    return point(brentq(lambda unwound: point(unwound)[1] - height, 0.02, 1.2, xtol=1e-15, rtol=1e-15))[0]


@pytest.mark.parametrize("distance", [78.0, 77.4])
@pytest.mark.parametrize("part", [0.1, 0.5, 0.9])
def test_gaps_are_those_of_two_involutes_drawn_one_in_the_other(distance, part):
    """Brute force: strings unwound from both base circles, whose ends meet on the line of action, 1e-10 mm."""
    pair = planet_in_ring(distance)
    xi = pair.path_start + part * (pair.path_end - pair.path_start)
    offsets = np.linspace(-0.15, 0.15, 9)
    gaps = facing_points_at(pair, (None, None), drive_place(pair, 0, xi), offsets)[2]
    small = 44.0 * cos(ANGLE)
    large = 122.0 * cos(ANGLE)
    # The line of action is y = -small; the ring's base circle touches it |L| to the left of the pinion's.
    between = sqrt(distance**2 - (large - small) ** 2)
    centres = np.array([[0.0, 0.0], [-between, large - small]])
    begins = -0.5 * pi + np.array([xi / small, (xi + between) / large])
    height = -small + offsets
    pinion, other = (
        np.array([involute(centre, radius, begin, -1.0, y) for y in height])
        for centre, radius, begin in zip(centres, (small, large), begins)
    )
    np.testing.assert_allclose(gaps, other - pinion, rtol=0.0, atol=1e-10)
    assert gaps[4] == pytest.approx(0.0, abs=1e-12) and gaps[0] > 0.0 and gaps[-1] > 0.0


def test_path_and_contact_ratio_are_those_of_the_textbook():
    """ISO 21771 for an internal pair, with positive numbers: g_a = sqrt(ra1^2 - rb1^2) - sqrt(ra2^2 - rb2^2) + a sin(
    alpha_w); both ends from T1; sliding by the ratio of the teeth; Hertz's curvature is 1/rho1 - 1/rho2."""
    pair = planet_in_ring()
    first, second = 44.0 * cos(ANGLE), 122.0 * cos(ANGLE)
    along = sqrt(119.0**2 - second**2), sqrt(48.0**2 - first**2)
    assert pair.path_start == pytest.approx(along[0] - 78.0 * sin(ANGLE), rel=1e-12)
    assert pair.path_end == pytest.approx(along[1], rel=1e-12)
    length = along[1] - along[0] + 78.0 * sin(ANGLE)
    assert pair.contact_ratio == pytest.approx(length / (pi * MODULE * cos(ANGLE)), rel=1e-12)
    assert pair.backlash == pytest.approx(0.0, abs=1e-12) and pair.tip_clearances == pytest.approx((1.0, 2.0))
    xi = 10.0
    assert specific_sliding(pair, xi)[0] == pytest.approx(1.0 - 22.0 / 61.0 * (xi + 78.0 * sin(ANGLE)) / xi, rel=1e-12)
    assert 1.0 / relative_radius(pair, xi) == pytest.approx(1.0 / xi - 1.0 / (xi + 78.0 * sin(ANGLE)), rel=1e-12)


def test_a_profile_shifted_pair_has_the_published_centre_distance():
    """KHK, Gear Technical Reference, profile shifted internal gear: m 3, 20 deg, 16 and 24 teeth, x1 = 0, x2 = 0.5
    (there with the other sign): alpha_w 31.0937 deg, a = 13.1683 mm, pitch diameters 52.673 and 79.010 mm."""
    pinion, wheel = (Gear(teeth, 3.0, ANGLE, shift, 1.0, 1.0, 1.0, 0.0) for teeth, shift in ((16, 0.0), (-24, -0.5)))
    pair = GearPair(pinion, wheel, -1.0, 1.0)
    pair = replace(pair, centre_distance=pair.centre_distance_without_backlash)
    assert pair.centre_distance == pytest.approx(-13.1683, abs=5e-5)
    assert degrees(pair.operating_pressure_angle) == pytest.approx(31.0937, abs=1e-4)
    pitch = [2.0 * abs(radius) / cos(pair.operating_pressure_angle) for radius in pair.base_radii]
    assert pitch == pytest.approx([52.673, 79.010], abs=5e-4)


def test_the_fillet_is_the_envelope_of_the_cutters_rounding():
    """Brute force: the rounding's centre is carried around the ring by both gears' motion; no point of the fillet is
    nearer to its path than the rounding's radius, and all are as near. It ends on the involute, in its direction."""
    gear = ring()
    fillet = gear.ring_fillet
    half_cutter = (0.5 * pi / 23) + tan(ANGLE) - ANGLE
    axes = 0.5 * MODULE * (61 - 23)
    assert fillet.centre_distance == pytest.approx(axes) and fillet.half_angle == pytest.approx(half_cutter)
    assert fillet.tip == pytest.approx(127.0 - axes)
    middle = 1j * np.exp(1j * (-gear.tooth_half_angle_at_base - pi / 61))

    def centre(turned):
        on_cutter = (fillet.tip - fillet.rounding) * np.exp(1j * (fillet.corner_angle + turned))
        return middle * (axes + on_cutter) * np.exp(-1j * turned * 23 / 61)

    for parameter in np.linspace(0.0, gear.fillet_end, 7):
        point = complex(*fillet_point(gear, parameter))
        nearest = minimize_scalar(lambda turned: abs(centre(turned) - point), (-0.4, 0.0, 0.4), tol=1e-12)
        assert nearest.fun == pytest.approx(fillet.rounding, abs=1e-9)
    end = fillet_point(gear, gear.fillet_end)
    roll = gear.form_roll_angle
    expected = gear.base_radius * np.array([roll * np.cos(roll) - np.sin(roll), -(np.cos(roll) + roll * np.sin(roll))])
    assert end == pytest.approx(expected, abs=1e-9)
    tangent = fillet_tangent(gear, gear.fillet_end)
    assert tangent @ np.array([np.cos(roll), -np.sin(roll)]) == pytest.approx(0.0, abs=1e-9 * np.linalg.norm(tangent))


@pytest.mark.parametrize("cutter", [23, None])
def test_area_and_inertia_are_those_of_the_outline(cutter):
    """Brute force: the ring's section as a fine polygon, 1e-6 of itself."""
    gear = ring(cutter)
    outline = tooth_outline(gear, 400)
    involute_points = outline.involute(np.linspace(gear.form_roll_angle, gear.tip_roll_angle, 400))[1:]
    half = np.vstack([outline.fillet, involute_points])
    tooth = np.vstack([half, outline.coast(half)[::-1]])
    turns = np.exp(-1j * gear.angular_pitch * np.arange(61))
    inner = (turns[:, None] * (tooth[:, 0] + 1j * tooth[:, 1])).ravel()
    area = abs(0.5 * np.sum(inner.real * np.roll(inner.imag, -1) - np.roll(inner.real, -1) * inner.imag))
    tip_angle = abs(gear.tip_thickness / gear.tip_radius)
    root_angle = abs(np.angle(complex(*outline.fillet[0]) * turns[1] / complex(*outline.coast(outline.fillet[:1])[0])))
    segments = sum(
        61 * 0.5 * radius**2 * (angle - sin(angle)) for radius, angle in ((119.0, tip_angle), (127.0, root_angle))
    )
    assert gear_section(gear).area == pytest.approx(pi * 140.0**2 - area - segments, rel=1e-5)


def test_the_dimension_between_balls_touches_both_flanks():
    """Geometry: a circle of that diameter is as far from the flank's involute as its radius, on 61 and on 60 teeth."""
    for teeth in (60, 61):
        gear = ring(teeth=teeth, outer=160.0, tip=0.5 * teeth * MODULE - MODULE)
        between = -dimension_over_balls(gear, 7.0)
        opposite = 1.0 if teeth % 2 == 0 else cos(0.5 * pi / teeth)
        centre = 0.5 * (between + 7.0) / opposite
        middle = -gear.tooth_half_angle_at_base - pi / teeth
        ball = centre * np.array([-sin(middle), cos(middle)])
        rolls = np.linspace(0.05, 0.6, 20001)
        flank = gear.base_radius * np.column_stack(
            [rolls * np.cos(rolls) - np.sin(rolls), -(np.cos(rolls) + rolls * np.sin(rolls))]
        )
        assert np.linalg.norm(flank - ball, axis=1).min() == pytest.approx(3.5, abs=1e-6)


def sharp(number: int, ring_teeth: int, shift: float = 0.0) -> GearPair:
    """A pair of few teeth apart, of full height."""
    pinion = Gear(number, 1.0, ANGLE, shift, 0.5 * number + 1 + shift, 0.5 * number - 1.25 + shift, 2.0, 0.2)
    wheel = Gear(
        -ring_teeth, 1.0, ANGLE, -shift, -0.5 * ring_teeth + 0.7 - shift, -0.5 * ring_teeth - 1.25 - shift,
        -0.5 * ring_teeth - 5.0, 0.1,
    )  # fmt: skip
    return GearPair(pinion, wheel, 0.5 * (number - ring_teeth), 10.0)


@pytest.mark.parametrize("apart", [2, 4, 6, 9, 14])
def test_tips_that_collide_outside_of_the_path_of_contact_are_found(apart):
    """Brute force: outlines of pinion and ring turned together through a pitch; a corner of the pinion's tip lies
    inside a tooth of the ring exactly where the check says so (textbooks: full teeth need a difference of 8 to 10)."""
    pair = sharp(60, 60 + apart)
    clearance = fillet_clearance(pair.wheel, pair.pinion, pair.centre_distance)
    pinion, wheel = pair.pinion, pair.wheel
    deepest = 0.0
    at_pitch = pair.pitch_point
    for xi in at_pitch + np.linspace(-20.0, 60.0, 16001):
        roll = np.array([xi / pinion.base_radius, (xi - pair.line_of_action_length) / abs(wheel.base_radius)])
        # The corner, turned with the pinion from where its drive flank touches; then in the frame of the ring's tooth.
        tip = pinion.tip_roll_angle
        corner = pinion.base_radius * np.array([tip * np.cos(tip) - np.sin(tip), -(np.cos(tip) + tip * np.sin(tip))])
        x, y = (
            np.cos(roll[0]) * corner[0] - np.sin(roll[0]) * corner[1],
            np.sin(roll[0]) * corner[0] + np.cos(roll[0]) * corner[1],
        )
        x -= pair.line_of_action_length
        y += pinion.base_radius + wheel.base_radius
        distance = np.hypot(x, y)
        if not abs(wheel.tip_radius) < distance < abs(wheel.form_radius):
            continue
        angle = np.arctan2(x, -y) - roll[1]
        flank = sqrt((distance / wheel.base_radius) ** 2 - 1.0)
        deepest = min(deepest, distance * (-(flank - np.arctan(flank)) - angle))
    inside = deepest < -1e-4
    assert (clearance < -1e-4) == inside
    if inside:
        with pytest.raises(GeometryError, match="tip corner cuts"):
            check_pair(pair)


def test_radial_assembly_needs_more_teeth_than_running():
    """Textbook (DIN 3993): full 20 degree teeth can be put in radially from about 13 to 17 teeth of difference."""
    assert not goes_in_radially(sharp(60, 70))
    assert goes_in_radially(sharp(60, 80))


@pytest.mark.parametrize(
    "changed, words",
    [
        ({"tip": 128.0}, "no teeth"),
        ({"tip": 114.0}, "no flank at the tip"),
        ({"outer": 127.1}, "no rim"),
        ({"cutter": 70}, "cannot cut 61 internal teeth"),
        ({"cutter": 8}, "undercut at the tip"),
        ({"cutter": 54}, "0.4251 mm off the tips .* lower gears.wheel.cutter.teeth to 52"),
        ({"cutter": 60}, "off the tips"),
    ],
)
def test_rings_that_cannot_be_are_refused(changed, words):
    """A user's expectation: what is wrong, with its value, before anything is computed."""
    with pytest.raises(GeometryError, match=words):
        check_gear(ring(**{"tip": 118.0, **changed}), "wheel")


@pytest.mark.parametrize("teeth", [23, 44, 52, 56, 58])
def test_a_cutter_cuts_off_corners_as_a_sharp_pinion_would(teeth):
    """Another route: the corner's way through a pinion of the cutter's sizes, which meets it at the ring's pitch. On
    the path of contact the corner touches the cutter's involute and comes no nearer, 1e-5 mm."""
    cut = ring(teeth, tip=118.0)
    fillet = replace(cut.ring_fillet, rounding=0.0)
    half_space = 0.5 * abs(cut.angular_pitch) - 0.5 * cut.tip_thickness / 118.0
    pinion = replace(PLANET, teeth=teeth, tip_radius=fillet.tip, root_radius=0.5 * MODULE * (teeth - 2.6))
    expected = min(fillet_clearance(pinion, cut, -fillet.centre_distance), 0.0)
    assert fillet.corner_clearance(118.0, half_space) == pytest.approx(expected, rel=0.02, abs=1e-5)


def test_pairs_that_cannot_run_are_refused():
    """Interference with the pinion's fillet; too far apart; shifts whose operating pressure angle is below zero."""
    with pytest.raises(GeometryError, match="they fit at no centre distance, but with smaller"):
        check_pair(GearPair(replace(PLANET, profile_shift=0.9), ring(), -78.0, 50.0))
    with pytest.raises(GeometryError, match="pinion: interference"):
        check_pair(planet_in_ring(tip=118.0))
    with pytest.raises(GeometryError, match="common tangent"):
        check_pair(planet_in_ring(distance=70.0))
