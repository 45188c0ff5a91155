"""A gear that is cut into its shaft, and the gaps that shafts open over the face."""

import re
from dataclasses import replace
from math import pi

import numpy as np
import pytest
from tests.beam_elements import alone, assembled
from tests.elastic_shaft_scenes import CUT, ELASTIC, FEW, PRESSED
from tests.hard_cases.invariants import finished_helical_run
from tests.helical import helical_scene, on_stand_in_bodies

from fenics_gears import model_of
from fenics_gears.dynamics.beam import shear_coefficient
from fenics_gears.dynamics.bearings import Bearing
from fenics_gears.dynamics.elastic_shaft import ElasticShaft, SeatedGear
from fenics_gears.dynamics.seat_of_mesh import SeatOfMesh
from fenics_gears.dynamics.shaft_at_work import face_compliance_of_shafts, middles_of_slices
from fenics_gears.dynamics.shaft_elements import carried
from fenics_gears.dynamics.shafts import ShaftSection
from fenics_gears.elasticity.slice_averages import slice_averages
from fenics_gears.simulation.elastic_route import mesh_cycle

STEEL = (206e3, 0.3)
WIDTH, DIAMETER, BORE = 40.0, 35.0, 10.0
SECTIONS = (ShaftSection(35.0, 28.0), ShaftSection(WIDTH, DIAMETER, bore=BORE), ShaftSection(45.0, 22.0))
SKEW = (
    (4e5, 1e5, 0.0, 0.0, 2e5),
    (1e5, 2e5, 0.0, 1e5, 0.0),
    (0.0, 0.0, 1e5, 0.0, 0.0),
    (0.0, 1e5, 0.0, 1e8, 3e7),
    (2e5, 0.0, 0.0, 3e7, 4e7),
)
HEIGHTS = np.linspace(-0.5, 0.5, 17) * WIDTH
BEARINGS = {
    "between": (Bearing(10.0, 3e5, 1e5), Bearing(100.0, 2e5, 0.0, 3e7)),
    "overhung": (Bearing(5.0, 3e5), Bearing(30.0, 4e5, 1e5)),
    # Not alike in all directions, which changes nothing of the seat where all are on one side.
    "overhung, not alike": (Bearing(5.0, 3e5), Bearing(30.0, stiffness_matrix=SKEW)),
    # Not alike either, where ends of the face have coordinates of their own.
    "between, not alike": (Bearing(10.0, stiffness_matrix=SKEW), Bearing(100.0, 2e5, 0.0, 3e7)),
    "three": (Bearing(10.0, 3e5, 1e5), Bearing(80.0, 1e5, 2e4), Bearing(115.0, 2e5)),
}


def shaft(bearings, torque_at=0.0):
    return ElasticShaft(
        "pinion", SECTIONS, STEEL, (SeatedGear("pinion", 55.0, WIDTH, integral=True),), torque_at, bearings
    )


def seat_compliance(shaft, heights, system=None):
    return (system or alone(shaft)).seat(shaft.seats[0]).whole(heights)


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_the_twist_under_an_even_torque_is_that_of_the_closed_form(sense):
    """Exact: t (b s - s^2 / 2) / G J, s from the face's end on the coupling's side."""
    found = seat_compliance(shaft(BEARINGS["between"], 60.0 - sense * 60.0), HEIGHTS)[:, 5, :, 5]
    polar = 206e3 / 2.6 * pi / 32.0 * (DIAMETER**4 - BORE**4)
    along = 0.5 * WIDTH + sense * HEIGHTS
    assert found == pytest.approx(np.minimum.outer(along, along) / polar, rel=1e-12, abs=1e-20)
    weights = np.full(17, WIDTH / 16.0)
    weights[[0, -1]] *= 0.5
    # The trapezium rule is exact: its kinks are at nodes.
    assert found @ weights == pytest.approx((WIDTH * along - 0.5 * along**2) / polar, rel=1e-12, abs=1e-20)


@pytest.mark.parametrize("name", BEARINGS)
def test_rigid_seat_and_remainder_make_up_the_whole_compliance(name):
    """Brute force: elements of a textbook, inverted; the seat's stiffness is R^T C^-1 R, the remainder never
    negative."""
    found = shaft(BEARINGS[name])

    def shear(outer, bore):
        return float(shear_coefficient(0.3, np.array(bore / outer)))

    places, stiffness = assembled(found, shear, found.seats[0].at + HEIGHTS)
    own = np.concatenate(
        [5 * np.abs(np.array(places) - found.seats[0].at - z).argmin() + np.arange(5) for z in HEIGHTS]
    )
    whole = np.linalg.inv(stiffness)[np.ix_(own, own)]
    rigid = np.concatenate([carried(z)[:5, :5] for z in HEIGHTS])
    seat = seat_compliance(found, HEIGHTS)[:, :5, :, :5].reshape(len(own), -1)
    wanted = whole - rigid @ np.linalg.solve(alone(found).gear_stiffness, rigid.T)
    size = np.sqrt(np.outer(np.diag(whole), np.diag(whole)))
    assert np.abs((seat - wanted) / size).max() <= 1e-9
    assert rigid.T @ np.linalg.solve(whole, rigid) == pytest.approx(alone(found).gear_stiffness, rel=1e-6, abs=1e-3)
    assert np.linalg.eigvalsh(seat / size)[0] >= -1e-12


def in_mesh(found, turned, heights):
    """What a seat does in the frame of a mesh, with what the coordinates of its face do."""
    seat = SeatOfMesh(alone(found), found.seats[0], "pinion", turned)
    whole = seat.compliance(heights)
    if seat.of_face:
        follows = seat.follows(heights)
        moved = np.linalg.solve(seat.stiffness_of_face, np.moveaxis(follows, 2, 0).reshape(6, -1))
        whole = whole + (follows.reshape(-1, 6) @ moved).reshape(whole.shape)
    return whole


@pytest.mark.parametrize("name", BEARINGS)
def test_a_seat_in_another_frame_is_that_of_the_shaft_described_in_it(name):
    """Identity: a shaft seen from its other end has its sections and bearings the other way round, y and z the other
    way; on bearings that are alike in all directions its mirror image is itself."""
    found = shaft(BEARINGS[name])
    about_x = np.diag([1.0, -1.0, -1.0] * 2)
    five = about_x[:5, :5]
    bearings = [
        replace(
            each,
            at=found.length - each.at,
            stiffness_matrix=each.stiffness_matrix and (five @ np.array(each.stiffness_matrix) @ five).tolist(),
        )
        for each in found.bearings
    ]
    seat = replace(found.seats[0], at=found.length - found.seats[0].at)
    other = replace(
        found, sections=SECTIONS[::-1], seats=(seat,), torque_at=found.length, bearings=tuple(bearings[::-1])
    )
    wanted = seat_compliance(other, HEIGHTS)
    assert in_mesh(found, about_x, HEIGHTS) == pytest.approx(wanted, rel=1e-8, abs=1e-9 * np.abs(wanted).max())
    if "not alike" not in name:
        mirrored = np.diag([1.0, -1.0, 1.0, -1.0, 1.0, -1.0])
        itself = seat_compliance(found, HEIGHTS)
        assert in_mesh(found, mirrored, HEIGHTS) == pytest.approx(itself, rel=1e-8, abs=1e-9 * np.abs(itself).max())


def test_an_overhung_seat_gives_way_alike_whatever_the_bearings():
    """Identity: what carries on one side alone moves a rigid seat and no more, also where it is stiffer one way."""
    one, other = (seat_compliance(shaft(BEARINGS[f"overhung{more}"]), HEIGHTS) for more in ("", ", not alike"))
    assert one == pytest.approx(other, rel=1e-12, abs=1e-12 * np.abs(one).max())


@pytest.mark.parametrize(("helix", "shafts"), [(0.0, CUT), (15.0, CUT), (15.0, PRESSED)])
def test_flanks_give_way_as_their_rows_say(helix, shafts):
    """Identity: contact nodes give way by J D J^T more, J the rows by which gears move them, with what the coordinates
    of faces do."""
    accuracy = "slices = 6\ncontact_nodes = 9\nsteps_per_mesh_cycle = 4"
    models = [
        model_of(helical_scene(each + "[friction]\ncoefficient = 0.1\n", helix=helix, accuracy=accuracy))
        for each in (re.sub("seat = .*\n", "", shafts), shafts)
    ]
    rigid, cut = (mesh_cycle(each, on_stand_in_bodies(each)) for each in models)
    model = models[1]
    heights = on_stand_in_bodies(model)[0].solid.heights
    for step in range(2, 4):
        operator, added = cut.position(step).operator, 0.0
        of_slice = np.concatenate([[pair.place.slice] * len(pair.offsets) for pair in operator.pairs])
        z = np.tile(model.face.positions[of_slice], 2)
        for gear, system, number in zip(model.drivetrain.elastic, model.drivetrain.systems, "12"):
            names = [f"{name}{number}" for name in ("centre_x", "centre_y", "axial_", "tilt_x", "tilt_y", "rotation_")]
            columns = [model.drivetrain.coordinates.index(name) for name in names]
            rows = operator.jacobian[:, columns] * model.drivetrain.radii[columns]
            rows[:, 3] += z * rows[:, 1]
            rows[:, 4] -= z * rows[:, 0]
            weights = slice_averages(heights, 2, model.face.positions, model.face.widths)
            own = system.seat(gear.seats[0])
            seat = np.einsum("sh,hikj,tk->sitj", weights, own.under(heights).compliance, weights)
            if gear.of_face(gear.seats[0]):
                # Of the coordinates the mean over each slice, by more points than are taken.
                points, share = np.polynomial.legendre.leggauss(5)
                at = model.face.positions[:, None] + 0.5 * model.face.widths[:, None] * points
                follows = np.einsum("p,spij->sij", 0.5 * share, own.follows(at.ravel()).reshape(*at.shape, 6, 6))
                seat += np.einsum("sia,ab,tjb->sitj", follows, np.linalg.inv(own.stiffness_apart), follows)
            places = np.tile(of_slice, 2)
            added = added + np.einsum("mi,minj,nj->mn", rows, seat[places][:, :, places], rows)
        found = operator.compliance - rigid.position(step).operator.compliance
        apart = [place for place, name in enumerate(model.drivetrain.coordinates) if name.startswith("face_")]
        found += operator.jacobian[:, apart] @ model.drivetrain.bending_faces[1] @ operator.jacobian[:, apart].T
        # Rows are of the point of contact, to which nodes beside it have other arms.
        offsets = np.concatenate([pair.offsets for pair in operator.pairs])
        middle = np.tile(np.abs(offsets) < 1e-9, 2)
        found, added = (each[np.ix_(middle, middle)] for each in (found, added))
        # What is left is the interpolation between flank nodes, and the turn of a helix within a slice.
        assert len(found) and np.abs(found - added).max() <= 3e-6 * np.abs(added).max()
    assert {each.name for each in model.drivetrain.elastic} == {"pinion", "wheel"}


def finished(more):
    return finished_helical_run(more, helix=0.0, offset=2.0, accuracy=FEW.replace("5", "10"))


def test_the_straight_part_is_the_inclination_of_the_axes():
    """Identity: an even line load opens a straight gap; a helix slope that closes it makes the line load even."""
    bent = finished(ELASTIC)
    model = bent.model
    z, pair = middles_of_slices(model.pair), model.pair
    compliance = face_compliance_of_shafts(model.drivetrain.systems, pair, z)
    gap = compliance.mean(axis=1) * model.scene.load.wheel_torque / pair.wheel.base_radius
    slope, middle = np.polyfit(z, gap, 1)
    assert gap == pytest.approx(middle + slope * z, abs=1e-12)
    amount = -1e3 * slope * pair.face_widths[0]
    straight = finished(ELASTIC + f'[lead_modifications.pinion]\nhelix_slope = "{float(amount)!r} um"\n').result
    assert straight.attrs["mean_axis_inclination_in_plane"] == pytest.approx(
        1e3 * slope * model.pair.face_width, rel=1e-3
    )
    # Bodies load the face unevenly by themselves.
    even = finished('[misalignment]\nin_plane = "0 um"\n').result
    assert straight.attrs["face_load_factor"] == pytest.approx(even.attrs["face_load_factor"], rel=5e-3)
    assert bent.result.attrs["face_load_factor"] > 1.02 * even.attrs["face_load_factor"]
