"""A planetary set in the frame of its carrier: mass, Coriolis and centrifugal terms."""

from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from tests.planets import in_time

from fenics_gears.dynamics.drivetrain import Drivetrain, TurningFrame
from fenics_gears.dynamics.frequencies import natural_frequencies
from fenics_gears.dynamics.planetary_modes import set_modes
from fenics_gears.dynamics.set_in_time import RowsOfSet, SetInTime, set_drivetrain
from fenics_gears.dynamics.time_integration import Scheme, State
from fenics_gears.geometry.planetary import CARRIER
from fenics_gears.model.planetary_frequencies import lumped_set
from fenics_gears.model.row_model import RowModel
from fenics_gears.model.train import train_model_of
from fenics_gears.model.train_parts import parts_of, set_in_time

PARTS = [("ring", "sun", "carrier"), ("carrier", "sun", "ring"), ("sun", "carrier", "ring")]
HELD = {"sun_springs": ', support_stiffness = "2e5 N/mm"', "ring_springs": ', support_stiffness = "1e5 N/mm"'}
BESIDE = {"fixed ring": ', torsional_stiffness = "2e9 N mm/rad"'}


@pytest.mark.parametrize("parts", PARTS)
@pytest.mark.parametrize("planets", ["planets = 4", 'planet_angles = ["0 deg", "90 deg", "190 deg"]'])
def test_it_has_the_natural_frequencies_of_lumped_members(parts, planets):
    """Lin and Parker's matrices, which are put together member by member in other coordinates: to round-off, as the
    carrier hardly turns."""
    springs = HELD | ({"ring_springs": HELD["ring_springs"] + BESIDE["fixed ring"]} if parts[0] == "ring" else {})
    load = '[inertia.load]\nmoment_of_inertia = "0.2 kg m^2"'
    (row,) = train_model_of(in_time(0.001, parts=parts, planets=planets, inertia=load, **springs)).rows
    lumped = lumped_set(row)
    wanted = [each.frequency for each in set_modes(lumped)]
    springs_of_meshes = np.tile(lumped.mesh_stiffness, len(row.meshes) // 2)
    assert natural_frequencies(row.drivetrain, springs_of_meshes).tolist() == pytest.approx(wanted, rel=1e-9)


def kinetic_energy(
    rows: RowsOfSet, place: np.ndarray, velocity: np.ndarray, turning: Mapping[str, float] | None = None
) -> float:
    """Of all centres, without small quantities left out: a planet's is turned by the carrier, those of sun and ring
    stand in the frame. `turning`, rad/s: nominal speeds of gears about their centres, in space, and of the carrier."""
    speed = rows.own.speed
    found = 0.0
    for gear, lumped in enumerate(rows.parts.masses):
        shaft = rows.graph.shafts[gear]
        axes = rows.parts.axes[rows.graph.sides[gear][0][0]]
        beside, moving = (axes.T @ rows.centre(gear)[:2] @ each for each in (place, velocity))
        angle = rate = 0.0
        if shaft not in (0, rows.graph.last):
            beside = beside + rows.own.places[shaft - 1]
            angle, rate = (float(rows.of(CARRIER) @ each) for each in (place, velocity))
        turned = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        quarter = np.array([[0.0, -1.0], [1.0, 0.0]])
        in_space = turned @ (moving + (speed + rate) * quarter @ beside)
        rotation, _ = rows.moved(gear)
        found += 0.5 * lumped.mass * in_space @ in_space
        # The ring is counted clockwise.
        rotation = -rotation if shaft == rows.graph.last else rotation
        name = {0: "sun", rows.graph.last: "ring"}.get(shaft, "planet")
        found += 0.5 * lumped.moment_of_inertia * (float(rotation @ velocity) + (turning or {}).get(name, 0.0)) ** 2
    carried = float(rows.of(CARRIER) @ velocity)
    return found + 0.5 * rows.own.carrier * (carried + (turning or {}).get(CARRIER, 0.0)) ** 2


def test_its_nominal_momentum_is_the_slope_of_the_kinetic_energy():
    """Brute force: what a ramp accelerates, by the energy of all masses in space at Willis' speeds, differentiated
    numerically; the sun floats, the carrier drives the load."""
    (row,) = train_model_of(in_time(4000.0, more='floating = ["sun"]')).rows
    carrier = row.shafts.carrier
    rows = RowsOfSet(parts_of(row.meshes, row.shafts), row_of_set(row))
    sun, planet, ring = 20, 16, 52
    assert carrier.set.speeds == {"sun": 1, "ring": 0, "carrier": Fraction(sun, sun + ring)}
    speed = 4000.0 * np.pi / 30.0
    turning = {"sun": speed, "ring": 0.0, "carrier": speed * sun / (sun + ring)}
    turning["planet"] = turning["carrier"] - sun / planet * (speed - turning["carrier"])
    nothing = np.zeros(len(rows.names))
    slope = [
        kinetic_energy(rows, nothing, each, turning) - kinetic_energy(rows, nothing, -each, turning)
        for each in np.eye(len(rows.names))
    ]
    found = row.drivetrain.nominal_momentum * (speed - turning["carrier"])
    assert found == pytest.approx(0.5 * np.array(slope), rel=1e-8, abs=1e-8 * np.abs(slope).max())


def row_of_set(row: RowModel) -> SetInTime:
    """The carrier and the members of a row's set."""
    return set_in_time(row.shafts.carrier, row.shafts.load, abs(row.models[0].pair.centre_distance), 1e-5)


def test_its_terms_are_those_of_the_kinetic_energy():
    """Brute force: Lagrange's equations of the whole kinetic energy, which is differentiated numerically. A floating
    sun, a ring on a spring, and a carrier that turns at 4,000 rpm."""
    scene = in_time(4000.0 * 3.6, more='floating = ["sun"]', ring_springs=HELD["ring_springs"], planets="planets = 3")
    (row,) = train_model_of(scene).rows
    parts = parts_of(row.meshes, row.shafts)
    own = row_of_set(row)
    assert own.speed == pytest.approx(4000.0 * np.pi / 30.0)
    rows = RowsOfSet(parts, own)
    size = len(rows.names)
    # Lengths in mm, velocities in mm/s: the energy is a polynomial but for rotations, which are small.
    small = np.concatenate([np.full(size, 1e-2), np.full(size, 10.0)])

    def energy(both: np.ndarray) -> float:
        return kinetic_energy(rows, both[:size], both[size:])

    second = np.zeros((2 * size, 2 * size))
    for one in range(2 * size):
        for other in range(2 * size):
            e, f = np.zeros((2, 2 * size))
            e[one] = small[one]
            f[other] = small[other]
            both = energy(e + f) - energy(e - f) - energy(f - e) + energy(-e - f)
            second[one, other] = 0.25 * both / (small[one] * small[other])
    off = second[:size, :size]
    mixed = second[size:, :size]
    slope = np.array([energy(each * small) - energy(-each * small) for each in np.eye(2 * size)[:size]])
    drivetrain = row.drivetrain
    plain = replace(own, speed=0.0)
    still = set_drivetrain(parts, plain, None, ())
    frame = drivetrain.frame
    assert frame is not None
    for found, wanted in (
        (drivetrain.mass, second[size:, size:]),
        (frame.gyroscopic, mixed - mixed.T),
        (still.stiffness - drivetrain.stiffness, off),
        (drivetrain.load - still.load, slope / (2.0 * small[:size])),
    ):
        assert found == pytest.approx(wanted, rel=1e-6, abs=1e-6 * np.abs(wanted).max())


def test_a_mass_on_springs_whirls_at_its_two_frequencies():
    """Exact: a mass on equal springs has, in a frame that turns with Omega, the frequencies omega + Omega and
    omega - Omega. It keeps its energy to round-off, and the error is of the second order."""
    mass = 2e-3
    spring = 4e4
    speed = 600.0
    ratio = np.sqrt(spring / mass)
    quarter = np.array([[0.0, -1.0], [1.0, 0.0]])
    drivetrain = Drivetrain(
        ("x", "y"), np.ones(2), (spring - mass * speed**2) * np.eye(2), np.zeros(2), mass * np.eye(2), None,
        frame=TurningFrame(2.0 * speed * mass * quarter, np.zeros((2, 2)), np.zeros(2), 1.0),
    )  # fmt: skip
    errors = []
    for count in (500, 1000, 2000):
        step = 0.02 / count
        # Along a line in space; the frame turns the velocity half a step before and half a step behind each place.
        scheme = Scheme(drivetrain, step)
        before = (np.eye(2) + speed * step * quarter) @ np.array([0.0, -speed])
        state = State(np.array([1.0, 0.0]), before, np.zeros(2))
        state = state._replace(acceleration=-drivetrain.stiffness @ state.position / mass)
        energies = []
        for _ in range(count):
            place = np.linalg.solve(scheme.stiffness, scheme.load(state, np.zeros(2)))
            state = scheme.advance(state, place)
            kinetic = 0.5 * mass * state.velocity @ state.velocity
            energies.append(kinetic + 0.5 * state.position @ drivetrain.stiffness @ state.position)
        assert np.ptp(energies) < 1e-11 * energies[0]
        exact = np.cos(ratio * 0.02) * np.array([np.cos(speed * 0.02), -np.sin(speed * 0.02)])
        errors.append(float(np.abs(state.position - exact).max()))
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.15)
    assert errors[1] / errors[2] == pytest.approx(4.0, rel=0.1)
