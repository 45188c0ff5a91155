"""A rigid shaft on two bearings: statics, natural frequencies and inertia in closed form."""

from dataclasses import replace
from math import pi, sqrt

import numpy as np
import pytest

from fenics_gears.contact.operator import CENTRE_COORDINATES, COORDINATES
from fenics_gears.dynamics.frequencies import Vibration, natural_frequencies, vibrations
from fenics_gears.dynamics.gear_inertia import LumpedGear
from fenics_gears.dynamics.tilting import gyroscopic_warnings, mesh_over_face, moved
from fenics_gears.effects.bearings import BearingPlaces, Bearings, Support
from fenics_gears.effects.inertia import GearInertia, Inertia, LoadInertia
from fenics_gears.geometry.helix import Helix
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
    """The pair with a helix, its sections as they are, and gears that are not opposite each other."""
    pair = replace(paper_pair, helix=Helix(np.deg2rad(10.0)), axial_offsets=(3.0, -2.0))
    assert pair.gear_middles == MIDDLES
    return pair


@pytest.fixture(scope="module")
def on_bearings(paper_scene):
    """The paper's scene with bearings along its shafts, without damping."""
    return replace(paper_scene, bearings=BEARINGS, damping=None)


def displaced(shafts, forces):
    """Static displacement by name, in mm and rad, under forces (k,); the output shaft, whose load is free, is held."""
    held, wheel = shafts.stiffness.copy(), shafts.coordinates.index("rotation_2")
    held[wheel, wheel] += 1e6
    states = np.linalg.solve(held, forces)
    return {name: float(shafts.value(states, name)) for name in shafts.coordinates}


@pytest.mark.parametrize(("number", "gear", "middle"), [("1", "pinion", MIDDLES[0]), ("2", "wheel", MIDDLES[1])])
def test_bearings_carry_a_force_as_the_lever_rule_says(on_bearings, helical, number, gear, middle):
    """Exact: six balances of either gear under a force along a leaning normal at a point of the mesh.

    Two supports are statically determinate: each carries the force across the axis, and the moment of the axial force,
        by the distance from the other one.
    """
    pair, force, (xi, height) = helical, 5000.0, (11.0, 4.0)
    shafts = drivetrain(on_bearings, pair)
    normal = np.array([1.0, 0.0, -pair.slope]) / sqrt(1.0 + pair.slope**2)
    found = displaced(shafts, -force * moved(pair, shafts.coordinates, (xi, height), normal))
    sense = -1.0 if gear == "pinion" else 1.0
    on_gear = sense * force * normal
    x, y = (
        (xi, -pair.pinion.base_radius)
        if gear == "pinion"
        else (xi - pair.line_of_action_length, pair.wheel.base_radius)
    )
    moment = np.cross((x, y, height - middle), on_gear)
    first, second = PLACES[gear]
    reactions = np.array([[
        0.5 * BEARINGS.of(gear, "x") * (found[f"centre_x{number}"] + place * found[f"tilt_y{number}"]),
        0.5 * BEARINGS.of(gear, "y") * (found[f"centre_y{number}"] - place * found[f"tilt_x{number}"]),
    ] for place in (first, second)])  # fmt: skip
    # About the second bearing: along x by the moment about y, along y by that about x.
    along = (second * on_gear[0] - moment[1]) / (second - first)
    off = (second * on_gear[1] + moment[0]) / (second - first)
    assert reactions[0] == pytest.approx([along, off], rel=1e-10, abs=1e-8)
    assert reactions.sum(axis=0) == pytest.approx(on_gear[:2], rel=1e-10, abs=1e-8)
    assert BEARINGS.axial(gear) * found[f"axial_{number}"] == pytest.approx(on_gear[2], rel=1e-12)
    torsion = on_bearings.shafts.of("input") if gear == "pinion" else 1e6 * pair.wheel.base_radius**2
    assert torsion * found[f"rotation_{number}"] == pytest.approx(moment[2], rel=1e-12)


def test_a_displacement_of_rigid_gears_is_that_of_their_points(helical):
    """Finite differences: rotation matrices move the points that touch, and the difference of both gears' motions along
    a direction is the row."""
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
        if name == "shaft_twist":
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


def test_two_springs_are_a_mesh_spread_over_the_face(on_bearings, helical):
    """Quadrature: the stiffness of the two springs is that of many along the contact line, each at its own height;
    exact up to the square of the path."""
    pair, names = helical, drivetrain(on_bearings, helical).coordinates
    rows = mesh_over_face(pair, names).normals
    heights = (np.arange(2000) + 0.5) / 2000.0 * pair.face_width - 0.5 * pair.face_width
    normal = np.array([1.0, 0.0, -pair.slope]) / sqrt(1.0 + pair.slope**2)
    many = np.array(
        [moved(pair, names, (pair.pitch_point + pair.slope * height, height), normal) for height in heights]
    )
    assert rows.T @ rows / 2.0 == pytest.approx(many.T @ many / len(many), rel=1e-6, abs=1e-6)


def test_the_plane_part_of_the_mesh_is_the_planes(paper_scene, paper_pair):
    """Identity: without helix, the mean of both springs moves as the one spring of a plane scene, and tilts only where
    faces are not opposite."""
    from fenics_gears.dynamics.frequencies import MESH_DIRECTION

    mean = mesh_over_face(paper_pair, COORDINATES).normals.mean(axis=0)
    assert mean == pytest.approx([MESH_DIRECTION.get(name, 0.0) for name in COORDINATES], abs=1e-14)


@pytest.mark.parametrize("places", [(-50.0, 50.0), (-40.0, 60.0), (20.0, 90.0)])
def test_natural_frequencies_of_a_rigid_shaft_on_two_springs(on_bearings, paper_pair, places):
    """Closed form: translation and tilt in a plane through the axis, coupled by bearings at unequal distances.

    Mass m, J about a diameter, springs k/2 at a and b: w^2 is a root of (k - m w^2)(k (a^2 + b^2)/2 - J w^2) = (k (a +
    b)/2)^2 [any text on rotors].
    """
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


def test_symmetric_places_keep_todays_translation(on_bearings, paper_pair):
    """Identity: bearings at equal distances do not couple tilts, and the plane's rows are those without places."""
    symmetric = replace(BEARINGS, places=BearingPlaces((-50.0, 50.0), (-10.0, 10.0)))
    with_places, without = (
        drivetrain(replace(on_bearings, bearings=each), paper_pair)
        for each in (symmetric, replace(BEARINGS, places=None))
    )
    assert without.coordinates == CENTRE_COORDINATES and with_places.coordinates == COORDINATES
    assert np.array_equal(with_places.stiffness[:7, :7], without.stiffness) and not with_places.stiffness[:7, 7:].any()
    assert np.array_equal(with_places.mass[:7, :7], without.mass) and not with_places.mass[:7, 7:].any()
    assert np.array_equal(with_places.load[:7], without.load) and not with_places.load[7:].any()


def test_what_has_no_place_or_no_axial_stiffness_is_held(on_bearings, paper_pair):
    """House rule 9: only what the section frees is a coordinate."""
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
    """Brute force: point masses of a prism of any section with five-fold symmetry, about an axis through its middle."""
    rng = np.random.default_rng(3)
    points = rng.normal(size=(200, 2))
    turns = 2.0 * pi * np.arange(5) / 5.0
    points = np.concatenate([points @ np.array([[np.cos(a), -np.sin(a)], [np.sin(a), np.cos(a)]]) for a in turns])
    width, heights = 7.0, (np.arange(1000) + 0.5) / 1000.0 * 7.0 - 3.5
    each = 1.0 / (len(points) * len(heights))
    about_x = each * sum(np.sum(points[:, 1] ** 2 + height**2) for height in heights)
    polar = np.sum(points**2) / len(points)
    assert LumpedGear(1.0, polar, width).tilting_inertia == pytest.approx(about_x, rel=1e-6)


def test_a_tilting_inertia_of_its_own_stands_before_the_discs(on_bearings, paper_pair):
    """Authority: the section's own words; a gear's own value, then that of both, then a disc's."""
    radii = [gear.base_radius for gear in (paper_pair.pinion, paper_pair.wheel)]

    def tilting(**given):
        shafts = drivetrain(
            replace(on_bearings, inertia=Inertia(4e-3, 3.0, load=LoadInertia(1.0), **given)), paper_pair
        )
        return [
            shafts.mass[place, place] * radius**2
            for place, radius in zip((shafts.coordinates.index("tilt_x1"), shafts.coordinates.index("tilt_y2")), radii)
        ]

    disc = 1.5 + 4e-3 * paper_pair.face_width**2 / 12.0
    assert tilting() == pytest.approx([disc, disc], rel=1e-12)
    assert tilting(tilting_moment_of_inertia=7.0, wheel=GearInertia(tilting_moment_of_inertia=5.0)) == pytest.approx(
        [7.0, 5.0], rel=1e-12
    )
    assert tilting(pinion=GearInertia(density=7.85e-9, tilting_moment_of_inertia=2.0)) == pytest.approx(
        [2.0, disc], rel=1e-12
    )


def test_a_mode_is_told_by_what_moves(on_bearings, paper_pair):
    """Authority: the limit of a gear on its own; bearings of the pinion so near to each other that its slowest modes
    are tilts, a soft axial support of the wheel."""
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
    """Closed form: J_t th_x'' + J w th_y' + k th_x = 0 and its twin have f +- J w/(4 pi J_t) where that is small; a
    flat disc's J is 2 J_t, so that the shift is the speed of rotation. The warning gives that bound, from 5 % on.
    """
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


def test_damping_by_ratios_and_by_rayleigh_reaches_the_tilts(on_bearings, paper_scene, paper_pair):
    """Definition: each mode has the ratio that is asked for; alpha K + beta M holds for the rows of tilts, too."""
    from fenics_gears.effects.damping import Damping

    by_ratio = drivetrain(replace(on_bearings, damping=Damping(ratios=(0.03, 0.05))), paper_pair)
    assert len(by_ratio.coordinates) == 13
    found = vibrations(by_ratio, 14.0e3 * on_bearings.gears.face_width)
    rayleigh = drivetrain(replace(on_bearings, damping=paper_scene.damping), paper_pair)
    assert rayleigh.damping == pytest.approx(0.4e-3 * rayleigh.stiffness + 0.5e-3 * rayleigh.mass, rel=1e-12)
    from fenics_gears.model.drivetrain import mesh_stiffness

    found = vibrations(by_ratio, mesh_stiffness(on_bearings))
    assert [each.damping_ratio for each in found] == pytest.approx([0.03] + [0.05] * (len(found) - 1), rel=1e-9)
