"""A rigid shaft on two bearings."""

from dataclasses import replace
from math import pi, sqrt

import numpy as np
import pytest

from fenics_gears.contact.kinematics import COORDINATES
from fenics_gears.dynamics.bearings import BearingPlaces, Bearings, Support
from fenics_gears.dynamics.clock import FOLLOWING
from fenics_gears.dynamics.frequencies import Vibration, natural_frequencies, vibrations
from fenics_gears.dynamics.guidance import time_step_warnings
from fenics_gears.dynamics.inertia import GearInertia, Inertia, LoadInertia
from fenics_gears.dynamics.tilting import gyroscopic_warnings, moved
from fenics_gears.geometry.gear_data import Helix, LumpedGear
from fenics_gears.model.drivetrain import drivetrain

# Places and stiffnesses that no mistake of sign, axis or gear leaves alone.
PLACES = {"pinion": (-40.0, 60.0), "wheel": (-30.0, 75.0)}
BEARINGS = Bearings(
    0.2e6, stiffness_y=0.3e6, axial_stiffness=0.07e6, pinion=Support(stiffness_x=0.1e6),
    wheel=Support(stiffness_y=0.5e6, axial_stiffness=0.09e6),
    places=BearingPlaces(**PLACES),
)  # fmt: skip


# Mid-widths from the middle of the common face.
MIDDLES = (2.5, -2.5)


@pytest.fixture(scope="module")
def helical(paper_pair):
    pair = replace(paper_pair, helix=Helix(np.deg2rad(10.0)), axial_offsets=(3.0, -2.0))
    assert pair.gear_middles == MIDDLES
    return pair


@pytest.fixture(scope="module")
def on_bearings(paper_scene):
    return replace(paper_scene, bearings=BEARINGS, damping=None)


def test_a_displacement_of_rigid_gears_is_that_of_their_points(helical):
    """Finite differences: rotation matrices move the points that touch."""
    pair, place, step = helical, (11.0, 4.0), 1e-5
    direction = np.array([0.6, -0.5, 0.3])
    row = moved(pair, COORDINATES, place, direction)
    point = np.array([place[0], -pair.pinion.base_radius, place[1]])
    centres = {
        "1": np.array([0.0, 0.0, MIDDLES[0]]),
        "2": np.array([pair.line_of_action_length, -pair.pinion.base_radius - pair.wheel.base_radius, MIDDLES[1]]),
    }
    axes = {"centre_x": 0, "centre_y": 1, "axial_": 2, "tilt_x": 0, "tilt_y": 1, "rotation_": 2}
    for name, found in zip(COORDINATES, row):
        if name == "twist_2":
            assert found == 0.0
            continue
        number, axis = name[-1], np.eye(3)[axes[name[:-1]]]
        if name.startswith(("centre", "axial")):
            motion = axis
        else:
            arm, angle = point - centres[number], step / (pair.pinion if number == "1" else pair.wheel).base_radius
            turned = [
                np.cos(a) * arm + np.sin(a) * np.cross(axis, arm) + (1.0 - np.cos(a)) * axis * (axis @ arm)
                for a in (angle, -angle)
            ]
            motion = (turned[0] - turned[1]) / (2.0 * step)
        assert found == pytest.approx((1.0 if number == "1" else -1.0) * motion @ direction, abs=1e-9)


@pytest.mark.parametrize("places", [(-50.0, 50.0), (-40.0, 60.0), (20.0, 90.0)])
def test_natural_frequencies_of_a_rigid_shaft_on_two_springs(on_bearings, paper_pair, places):
    """Closed form of mass m, J about a diameter, springs k/2 at a and b: (k - m w^2)(k (a^2 + b^2)/2 - J w^2) = (k
    (a + b)/2)^2."""
    stiffness, mass, moment = 0.2e6, 4e-3, 3.0
    inertia = Inertia(mass, moment, load=LoadInertia(1.0))
    scene = replace(on_bearings, bearings=Bearings(stiffness, places=BearingPlaces(places, places)), inertia=inertia)
    found = natural_frequencies(drivetrain(scene, paper_pair), 0.0)
    tilting = 0.5 * moment + mass * scene.gears.face_width**2 / 12.0
    a, b = places
    matrix = np.array(
        [[stiffness, 0.5 * stiffness * (a + b)], [0.5 * stiffness * (a + b), 0.5 * stiffness * (a**2 + b**2)]]
    )
    total, product = matrix[0, 0] / mass + matrix[1, 1] / tilting, np.linalg.det(matrix) / (mass * tilting)
    squares = [0.5 * (total + sign * sqrt(total**2 - 4.0 * product)) for sign in (-1.0, 1.0)]
    for square in squares:
        # Two gears in two planes.
        assert np.sum(np.isclose(found, sqrt(square) / (2.0 * pi), rtol=1e-9)) == 4


def test_what_has_no_place_or_no_axial_stiffness_is_held(on_bearings, paper_pair):
    """House rule 9."""
    one = Bearings(0.2e6, places=BearingPlaces(pinion=(-40.0, 60.0)))
    assert drivetrain(replace(on_bearings, bearings=one), paper_pair).coordinates[7:] == ("tilt_x1", "tilt_y1")
    other = replace(one, wheel=Support(axial_stiffness=0.1e6), places=BearingPlaces((-40.0, 60.0), (-40.0, 60.0)))
    assert drivetrain(replace(on_bearings, bearings=other), paper_pair).coordinates[7:] == (
        "tilt_x1",
        "tilt_y1",
        "axial_2",
        "tilt_x2",
        "tilt_y2",
    )


def test_the_inertia_about_a_diameter_is_a_discs_and_a_prisms():
    """Brute force: point masses of a prism with five-fold symmetry."""
    rng = np.random.default_rng(3)
    points = rng.normal(size=(200, 2))
    turns = 2.0 * pi * np.arange(5) / 5.0
    points = np.concatenate([points @ np.array([[np.cos(a), -np.sin(a)], [np.sin(a), np.cos(a)]]) for a in turns])
    width, heights = 7.0, (np.arange(1000) + 0.5) / 1000.0 * 7.0 - 3.5
    each = 1.0 / (len(points) * len(heights))
    about_x = each * sum(np.sum(points[:, 1] ** 2 + height**2) for height in heights)
    polar = np.sum(points**2) / len(points)
    assert LumpedGear(1.0, polar, width).tilting_inertia == pytest.approx(about_x, rel=1e-6)


def test_a_mode_is_told_by_what_moves(on_bearings, paper_pair):
    """Limits: a gear on its own; bearings next to each other; a soft axial support."""
    soft = Bearings(
        1e6, places=BearingPlaces((-1.0, 1.0), (-200.0, 200.0)), axial_stiffness=1e8, wheel=Support(axial_stiffness=1.0)
    )
    scene = replace(
        on_bearings, bearings=soft, inertia=Inertia(4e-3, 3.0, load=LoadInertia(1.0), wheel=GearInertia(4e-3, 3.0))
    )
    found = vibrations(drivetrain(scene, paper_pair), 1e3)
    assert [each.motion for each in found if each.motion][:3] == [
        "wheel moves along its axis",
        "pinion tilts",
        "pinion tilts",
    ]
    assert {each.motion for each in found} == {
        "",
        "wheel moves along its axis",
        "pinion tilts",
        "wheel tilts",
        "pinion moves along its axis",
    }
    assert not found[0].excited and all(
        not each.motion
        for each in vibrations(drivetrain(replace(scene, bearings=replace(soft, places=None)), paper_pair), 1e3)
    )


def test_gyroscopic_moments_are_told_where_they_shift_a_tilting_frequency(on_bearings, paper_pair):
    """Closed form: f +- J w/(4 pi J_t) where that is small; a flat disc's J is 2 J_t. Told from 5 % on."""
    stiffness, moment, turns = 1e9, 2.0, 60.0
    state = np.zeros((4, 4))
    state[:2, 2:] = np.eye(2)
    state[2:, :2] = -stiffness / moment * np.eye(2)
    state[2:, 2:] = 2.0 * moment * 2.0 * pi * turns / moment * np.array([[0.0, -1.0], [1.0, 0.0]])
    frequencies = np.unique(np.round(np.abs(np.linalg.eigvals(state).imag) / (2.0 * pi), 6))
    still = sqrt(stiffness / moment) / (2.0 * pi)
    assert frequencies - still == pytest.approx([-turns, turns], rel=0.05)
    modes = [
        Vibration(0.5 * still, 0.01, True),
        Vibration(still, 0.01, True, "wheel tilts"),
        Vibration(2.0 * still, 0.01, True, "pinion tilts"),
    ]
    assert gyroscopic_warnings(modes, {"pinion": 0.06 * still, "wheel": 0.04 * still}) == []
    (said,) = gyroscopic_warnings(modes, {"pinion": 0.09 * still, "wheel": 0.06 * still})
    assert "at which the wheel tilts, by up to 6%" in said and f"at {60 * 0.06 * still:.4g} rpm" in said


def test_a_frequency_of_several_vibrations_is_told_once():
    """Count: three modes of like bearings have one frequency."""
    modes = [Vibration(frequency, 1e-3, True) for frequency in (1592.0, 1592.0, 1592.0, 1800.0)]
    (said,) = time_step_warnings(modes, 400.0, 20, FOLLOWING)
    assert "about 3 vibrations at 1592 Hz (5.03 steps per period), 1800 Hz (4.44 steps per period);" in said
    assert said.count("1592 Hz") == 1


def test_a_vibration_that_tilts_a_gear_is_told_as_one():
    """The words of `gears check`; what moves stands beside the frequency."""
    modes = [Vibration(1592.0, 1e-3, True), Vibration(1800.0, 1e-3, True, "pinion tilts")]
    (said,) = time_step_warnings(modes, 400.0, 20, FOLLOWING)
    assert "about 1592 Hz (5.03 steps per period), 1800 Hz (4.44 steps per period; pinion tilts);" in said
