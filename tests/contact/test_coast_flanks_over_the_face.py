"""Coast flanks of helical gears: normals, positions, gaps and compliance, against the helicoids themselves and against
the drive flanks turned over."""

from dataclasses import replace

import numpy as np
import pytest
from tests.hard_cases.invariants import run_of
from tests.helical import helical_scene, on_stand_in_bodies

from fenics_gears.contact.face_mesh import face_mesh, opening_over_face
from fenics_gears.contact.face_pairing import FacePair, FacePairing
from fenics_gears.contact.mesh_cycle import Cycle, Gaps
from fenics_gears.contact.operator import COORDINATES, Passage, displacement_jacobian
from fenics_gears.contact.tooth_pair import (
    COAST,
    DRIVE,
    Flanks,
    Place,
    coast_place,
    flank_points,
    interpolations,
    tooth_pair,
)
from fenics_gears.contact.window import ContactGrid
from fenics_gears.model.model import model_of
from fenics_gears.results.load_factors import load_factors
from fenics_gears.simulation.elastic_route import gear_compliances
from fenics_gears.simulation.face_route import gear_bodies
from fenics_gears.system.progress import SilentProgress

BOTH = "[coast_flanks]\n"
MISALIGNED = '[misalignment]\nin_plane = "10 um"\nout_of_plane = "7 um"\n'


def coasting(hand="right", more=""):
    """The model of a pair with both flanks, and its contact on stand-in bodies."""
    model = model_of(helical_scene(BOTH + more, hand=hand, offset=2.0))
    sections, bodies = on_stand_in_bodies(model)
    flanks, own = Flanks(model.pair, sections), model.drivetrain.indices
    cycle = Cycle(face_mesh(flanks, bodies, model.face, ContactGrid(2.0, 13)), 16, own, False)
    opening = opening_over_face(cycle, model.face_opening, model.coast_face_opening)
    return model, cycle.with_gaps(Gaps(openings=(opening,)))


def coast_helicoid(pair, angle, height, position):
    """A point (3,) of the pinion's coast flank: a string unwound from the base circle the other way round than the
    drive flank's.

    `angle`: by which the string's direction is turned; the string through the line of action is `position` long at the
        height 0. A right-hand
    pinion's section turns counter-clockwise with the height, towards the foot of that string.
    """
    radius, double = pair.pinion.base_radius, 2.0 * pair.operating_pressure_angle
    turned = angle + double
    # Turned by twice the pressure angle the drive flanks' line is the coast flanks' one, and is walked backwards.
    across, along = np.array([-np.sin(turned), np.cos(turned)]), -np.array([np.cos(turned), np.sin(turned)])
    section = -radius * across * np.array([1.0, 1.0])
    return np.array([*section, height]) + np.array([*((position + radius * angle - pair.slope * height) * along), 0.0])


@pytest.mark.parametrize("hand", ["right", "left"])
def test_normals_are_the_helicoids(hand):
    """Brute force: position and normal from the flank's surface by differences, and the kinematics of rigid bodies,
    against the operator's rows."""
    model, cycle = coasting(hand)
    pair, step = model.pair, 1e-5
    operator = cycle.position(5).operator
    rows = displacement_jacobian(
        operator.pairs, operator.base_radii, operator.normal_lever_arms, False, face=operator.face
    )
    centre, node, seen = (
        np.array([pair.line_of_action_length, -pair.pinion.base_radius - pair.wheel.base_radius, 0.0]),
        0,
        0,
    )
    for nodes in operator.pairs:
        for arm in nodes.pinion_lever_arm:
            # A few suffice.
            if nodes.place.flank == COAST and node % 5 == 0:
                height = nodes.place.height
                places = [(step, height), (-step, height), (0.0, height + step), (0.0, height - step)]
                points = [coast_helicoid(pair, angle, z, arm + pair.slope * height) for angle, z in places]
                touched = coast_helicoid(pair, 0.0, height, arm + pair.slope * height)
                normal = np.cross(points[0] - points[1], points[2] - points[3])
                normal /= np.linalg.norm(normal)
                normal *= np.sign(normal @ rotated(np.array([-1.0, 0.0, 0.0]), 2.0 * pair.operating_pressure_angle))
                expected = []
                for sense, middle, radius in zip((1.0, -1.0), (0.0, 1.0), operator.base_radii):
                    arms = touched - middle * centre - np.array([0.0, 0.0, operator.face.middles[int(middle)]])
                    moment = np.cross(arms, normal)
                    expected.append(
                        sense
                        * np.array([*normal[:2], moment[2] / radius, normal[2], moment[0] / radius, moment[1] / radius])
                    )
                of_pinion, of_wheel = rows[node, [0, 1, 2, 7, 8, 9]], rows[node, [3, 4, 5, 10, 11, 12]]
                assert of_pinion == pytest.approx(expected[0], abs=1e-7) and of_wheel == pytest.approx(
                    expected[1], abs=1e-7
                )
                seen += 1
            node += 1
    assert seen > 10


def rotated(vector, angle):
    """A vector turned about z."""
    return np.array(
        [
            vector[0] * np.cos(angle) - vector[1] * np.sin(angle),
            vector[0] * np.sin(angle) + vector[1] * np.cos(angle),
            vector[2],
        ]
    )


@pytest.mark.parametrize("hand", ["right", "left"])
def test_positions_and_gaps_in_slices(hand):
    """Exact: a section that is turned ahead touches the coast flanks' line nearer to its foot; the backlash is alike at
    all heights, along the leaning normal."""
    model, cycle = coasting(hand)
    pair, places = model.pair, {}
    for nodes in cycle.position(3).operator.pairs:
        position = pair.pinion.base_radius * nodes.place.contact_rolls[0]
        sign = 1.0 if nodes.place.flank == DRIVE else -1.0
        places.setdefault((nodes.place.flank, nodes.place.index), []).append(
            position - sign * pair.slope * nodes.place.height
        )
        if nodes.place.flank == COAST and 0.0 in np.round(nodes.offsets, 12):
            assert nodes.gap[np.abs(nodes.offsets).argmin()] == pytest.approx(pair.backlash, rel=2e-2)
    for found in places.values():
        np.testing.assert_allclose(found, found[0], rtol=1e-12)
    assert len({flank for flank, _ in places}) == 2


@pytest.mark.parametrize("hand", ["right", "left"])
def test_misalignment_opens_the_coast_flanks_as_a_tilt_does(hand):
    """Kinematics: a misaligned axis is the wheel tilted by the same angles, whose rows the test above has checked."""
    (_, even), (model, cycle) = coasting(hand), coasting(hand, MISALIGNED)
    pair = model.pair
    tilts = np.zeros(13)
    # Axes that move by z along x are tilted about y, by z along y about -x.
    tilts[[11, 12]] = pair.wheel.base_radius / pair.face_width * np.array([-0.007, 0.010])
    # The misalignment is about the pitch point in the middle of the common face, tilts about the wheel's mid-width: the
    # wheel is displaced in its plane, and along its axis.
    tilts[[3, 4]] = even.face.middles[1] / pair.face_width * np.array([0.010, 0.007])
    tilts[COORDINATES.index("axial_2")] = (
        0.007 * pair.wheel.base_radius - 0.010 * (pair.line_of_action_length - pair.pitch_point)
    ) / pair.face_width
    one, other = (each.position(5).operator for each in (even, cycle))
    rows = displacement_jacobian(one.pairs, one.base_radii, one.normal_lever_arms, False, face=one.face)
    seen = {DRIVE: 0, COAST: 0}
    for number, nodes in enumerate(one.pairs):
        own = np.flatnonzero(one.node_pair == number)
        nearest = own[np.abs(nodes.offsets).argmin()]
        if abs(nodes.offsets).min() < 1e-9:
            # The lever arm of the point half the gap away is what is left.
            assert other.gap[nearest] - one.gap[nearest] == pytest.approx(
                -rows[nearest] @ tilts, abs=2e-5 * 0.010 * 24.0
            )
            seen[nodes.place.flank] += 1
    assert min(seen.values()) > 2


@pytest.mark.parametrize("hand", [pytest.param("right", marks=pytest.mark.nightly), "left"])
def test_driven_backwards(hand):
    """Statics: the axial force turns round with the torque, F_a = F_t tan(beta), and so does its sign with the hand."""
    forces = {}
    for torque in (200e3, -200e3):
        model = model_of(
            helical_scene(
                BOTH, hand=hand, torque=torque, accuracy="slices = 4\ncontact_nodes = 9\nsteps_per_mesh_cycle = 6"
            )
        )
        result = run_of(model, on_stand_in_bodies(model)).result
        tangential = torque / model.pair.wheel.reference_radius
        sign = 1.0 if hand == "right" else -1.0
        expected = sign * tangential * np.tan(np.deg2rad(15.0))
        np.testing.assert_allclose(result["reaction_z"].sel(gear="pinion"), expected, rtol=1e-11)
        np.testing.assert_allclose(result["reaction_z"].sel(gear="wheel"), -expected, rtol=1e-11)
        forces[torque] = result["coast_normal_force" if torque < 0.0 else "normal_force"].values
    assert min(values.min() for values in forces.values()) > 0.0


def test_load_factors_where_the_wheel_drives():
    """Exact symmetry: half a turn about the line of centres puts drive flanks on coast flanks and z on -z. Load factors
    are the same, but for the phases of the steps."""
    factors, double = [], 2.0 * model_of(helical_scene(BOTH)).pair.operating_pressure_angle
    for torque, (in_plane, out_of_plane) in (
        (200e3, (20.0, 0.0)),
        (-200e3, (20.0 * np.cos(double), 20.0 * np.sin(double))),
    ):
        more = f'[misalignment]\nin_plane = "{float(in_plane)!r} um"\nout_of_plane = "{float(out_of_plane)!r} um"\n'
        scene = helical_scene(
            BOTH + more, torque=torque, cycles=2, accuracy="slices = 4\ncontact_nodes = 9\nsteps_per_mesh_cycle = 40"
        )
        model = model_of(scene)
        factors.append(load_factors(run_of(model, on_stand_in_bodies(model)).result, model.pair))
    assert factors[0].keys() == factors[1].keys() and len(factors[0]) == 6
    for name, value in factors[0].items():
        # An edge passes a slice within a few steps: 1.1 % apart with 40 steps, 0.7 % with 160.
        assert factors[1][name] == pytest.approx(value, rel=2e-2 if name == "edge_line_load_factor" else 5e-3), name
    assert factors[0]["face_load_factor"] > 1.2


@pytest.fixture(scope="module")
def real(suite_cache):
    """Sections and coarse bodies with both flanks."""
    accuracy = (
        'slices = 4\nlayers = 2\nbody_element_size = "1.5 mm"\nflank_element_size = "0.5 mm"\nelement ='
        ' "P1"\ncontact_nodes = 9\nsteps_per_mesh_cycle = 16'
    )
    model = model_of(helical_scene(BOTH, teeth=(18, 20), accuracy=accuracy))
    sections, bodies = (of(model, SilentProgress(), suite_cache) for of in (gear_compliances, gear_bodies))
    return model, Flanks(model.pair, sections), bodies


def test_coast_flanks_are_the_drive_flanks_turned_over(real):
    """Exact symmetry: half a turn about the line of centres puts a helical pair on its coast flanks, z on -z, and keeps
    its hand."""
    model, flanks, bodies = real
    grid, pairing = ContactGrid(2.0, 9), FacePairing(flanks, bodies, model.face)
    pair, slices = model.pair, model.face.slices

    def nodes(index, flank, slice_, position):
        """Contact nodes of either flank at the same position on its own line of action."""
        rolls = position / pair.pinion.base_radius, (pair.line_of_action_length - position) / pair.wheel.base_radius
        drive = tooth_pair(replace(flanks, removal=(None, None)), grid, place(index, flank, slice_, rolls))
        seen = interpolations(
            pairing.sections, grid, drive.place, drive.offsets, flank_points(pair, drive.place, drive.offsets)[0]
        )
        return FacePair(**vars(drive), coarse=seen)

    def place(index, flank, slice_, rolls):
        height = float(model.face.positions[slice_])
        if flank == DRIVE:
            return Place(index, flank, rolls, slice=slice_, height=height)
        return replace(coast_place(pair, index, pair.pitch_point), contact_rolls=rolls, slice=slice_, height=height)

    def compliance(flank):
        # Teeth ahead are behind of those turned over; slices stand in the order in which they are turned over.
        groups = [(index, number) for index in (0, 1) for number in range(slices)]
        found = [
            nodes(index if flank == DRIVE else -index, flank, number if flank == DRIVE else slices - 1 - number,
                  pair.pitch_point - 1.0 + index * pair.base_pitch * 0.4 + 0.2 * number)
            for index, number in groups
        ]  # fmt: skip
        return pairing.response(Passage(found, found)).compliance

    drive, coast = compliance(DRIVE), compliance(COAST)
    assert np.abs(drive).max() > 0.0
    assert np.linalg.norm(coast - drive) <= 1e-9 * np.linalg.norm(drive)
