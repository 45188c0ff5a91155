"""Natural frequencies of shafts with their own mass."""

from dataclasses import replace
from math import pi, sqrt
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.linalg import block_diag, eigh
from tests.beam_elements import FIVE, alone
from tests.dynamics.test_elastic_shaft import ON_THREE, STEPS, STIFF, E, G, area, second, shaft, shear
from tests.elastic_shaft_scenes import CUT, INERTIA, VIBRATING
from tests.helical import helical_scene

from fenics_gears import model_of
from fenics_gears.dynamics.bearings import Bearing
from fenics_gears.dynamics.elastic_shaft import LONGEST_ELEMENT
from fenics_gears.dynamics.frequencies import vibrations
from fenics_gears.dynamics.shafts import ShaftSection
from fenics_gears.dynamics.speed_ramp import inertia_forces
from fenics_gears.model.drivetrain import mesh_stiffness

DENSITY = 7.85e-9
ALL = 1e6  # Hz: more modes than anybody needs.


def vibrating(shaft, density, up_to):
    return alone(replace(shaft, density=density, up_to=up_to))


def frequencies(found, of_gear=(0.0,) * 6):
    """Hz, of a shaft with masses of its gear, free to turn."""
    torsion = found.torsional_stiffness(found.shafts[0]) * np.array([[1.0, -1.0], [-1.0, 1.0]])
    stiffness = block_diag(found.stiffness[:FIVE, :FIVE], torsion, found.stiffness[FIVE:, FIVE:])
    mass = found.mass + np.diag([*of_gear, *np.zeros(len(found.mass) - 6)])
    return np.sqrt(np.maximum(eigh(stiffness, mass, eigvals_only=True), 0.0)) / (2.0 * pi)


def error_of_elements(mode):
    """(k h)^2/24 of linear elements with consistent mass."""
    return (mode * pi * LONGEST_ELEMENT) ** 2 / 24.0


def simply_supported(mode):
    """Timoshenko: E I k^4 - rho A w^2 (1 + k^2 I/A (1 + E / kappa G)) + rho^2 I / (kappa G) w^4 = 0, k = n pi / L;
    1/s."""
    length, diameter = 200.0, 25.0
    k, stiff = mode * pi / length, shear(diameter) * G
    whole = DENSITY * area(diameter) * (1.0 + k**2 * second(diameter) / area(diameter) * (1.0 + E / stiff))
    a, c = DENSITY**2 * second(diameter) / stiff, E * second(diameter) * k**4
    return sqrt((whole - sqrt(whole**2 - 4.0 * a * c)) / (2.0 * a))


def test_a_simply_supported_shaft_vibrates_as_in_closed_form():
    """Exact, but for the elements' own error: the first three of bending, of both planes."""
    found = shaft(
        [ShaftSection(200.0, 25.0)], 70.0, [Bearing(0.0, STIFF, 1e-3), Bearing(200.0, STIFF)], torque_at=200.0
    )
    own = frequencies(vibrating(found, DENSITY, ALL))
    for mode in (1, 2, 3):
        above = own / (simply_supported(mode) / (2.0 * pi)) - 1.0
        assert np.sort(above[above > -1e-7])[:2] == pytest.approx([0.0, 0.0], abs=error_of_elements(mode))


def test_ends_that_differ_by_round_off_are_one_place():
    """Identity: a bearing and a coupling off an end by round-off are there."""
    thirds, off = [ShaftSection(33.3, 25.0)] * 3, 1e-13
    found = [
        vibrating(shaft(thirds, 20.0, [Bearing(66.6 + by, 3e5, 1e5), Bearing(99.9 - by, 3e5)], 99.9 - by), DENSITY, 3e4)
        for by in (0.0, off, -off)
    ]
    exact, *others = (frequencies(each)[1:12] for each in found)
    assert np.array(others) == pytest.approx(np.array([exact, exact]), rel=1e-9)


def test_a_free_twist_2s_as_in_closed_form():
    """Exact: n/2L sqrt(G/rho), but for the elements' own error."""
    found = shaft([ShaftSection(150.0, 30.0, bore=12.0)], 40.0, [Bearing(0.0, 1e5, 1e5), Bearing(90.0, 1e5)], 120.0)
    own = frequencies(vibrating(found, DENSITY, ALL))
    for mode in (1, 2, 3):
        above = own / (0.5 * mode / 150.0 * sqrt(G / DENSITY)) - 1.0
        assert np.abs(above).min() <= 1.01 * error_of_elements(mode)


def test_mass_is_that_of_a_rigid_body():
    """Exact: a hollow cylinder that moves as a whole."""
    length, at = 80.0, 30.0
    found = vibrating(shaft([ShaftSection(length, 30.0, bore=10.0)], at, ON_THREE[:1], 70.0, 20.0), DENSITY, 1e3)
    stiff = alone(replace(found.shafts[0], material=(1e30, 0.3)))
    section, bending = DENSITY * area(30.0, 10.0), DENSITY * second(30.0, 10.0)
    assert found.shafts[0].mass_of_all == pytest.approx(section * length, rel=1e-12)
    off = 0.5 * length - at
    assert stiff.mass[0, [0, 4]] == pytest.approx(section * length * np.array([1.0, off]), rel=1e-12)
    tilting = bending * length + section * length * (length**2 / 12.0 + off**2)
    assert stiff.mass[3, 3] == pytest.approx(tilting, rel=1e-12)
    turning = np.zeros(len(found.mass))
    turning[5:7] = 1.0
    assert turning @ found.mass @ turning == pytest.approx(2.0 * bending * length, rel=1e-12)


def test_modes_move_bearings_as_they_move_the_line():
    """Identity: the deflection line at the bearings; stiffness as a sum of what is in shaft and bearings."""
    found = vibrating(shaft(STEPS, 55.0, ON_THREE, seat=18.0), DENSITY, 3e4)
    lines = found.deflection(found.shafts[0], [each.at for each in ON_THREE])
    assert lines.shape[2] == len(found.coordinates) > FIVE + 5
    assert lines.reshape(found.at_bearings.shape) == pytest.approx(found.at_bearings, rel=1e-9, abs=1e-12)
    parts = found.stiffness - found.bearing_stiffness
    size = np.sqrt(np.diag(found.stiffness))
    # What is in the shaft is positive too.
    assert np.linalg.eigvalsh(parts / np.outer(size, size))[0] > -1e-9
    assert np.diag(found.mass)[7:] == pytest.approx(found.shafts[0].mass_of_all, rel=1e-9)


def test_a_gear_that_is_cut_into_its_shaft_is_not_counted_twice():
    """Exact: the shaft under the face is what its gear, down to the bore, has not."""
    more = CUT.replace("torque_at", 'material = { density = "7.85 g/cm^3" }\ntorque_at') + INERTIA
    model = model_of(helical_scene(more, accuracy=""))
    system, own, bore = model.drivetrain.systems[0], model.drivetrain.elastic[0], 2.0 * model.pair.pinion.bore_radius
    wanted = area(28.0, 8.0) * 40.0 + area(35.0) * (90.0 - own.seats[0].width) + area(bore) * own.seats[0].width
    assert own.mass_of_all == pytest.approx(DENSITY * wanted, rel=1e-12)
    assert system.mass[:2, :2] == pytest.approx(system.mass[0, 0] * np.eye(2))


def test_an_accelerated_input_shaft_is_twisted_by_its_own_inertia():
    """Exact: it lags by J L / G Ip + rho L^2 / 2 G in an even acceleration."""
    scene = helical_scene(VIBRATING, accuracy="")
    model = model_of(scene)
    own, there = model.drivetrain, model.drivetrain.coordinates.index("rotation_1")
    clock = SimpleNamespace(acceleration_at=lambda step: 1.0)
    load = inertia_forces(clock, 2.0 * pi / scene.gears.pinion.teeth * own.nominal_momentum)(0)
    found = load[there] / own.stiffness[there, there] / own.radii[there]
    speed, beam = 2.0 * pi / scene.gears.pinion.teeth, own.elastic[0]
    # Parts of the shaft between coupling and seat, from the coupling on, and all that is beyond.
    places = [0.0, 40.0, beam.seats[0].ends[0]]
    polar = [2.0 * second(28.0, 8.0), 2.0 * second(35.0)]
    beyond, twist = 2e-3 * 1e3 + 2.0 * second(35.0) * beam.density * (130.0 - beam.seats[0].ends[0]), 0.0
    for left, right, part in reversed(list(zip(places, places[1:], polar))):
        length = right - left
        twist += beyond * length / (G * part) + beam.density * length**2 / (2.0 * G)
        beyond += beam.density * part * length
    assert found == pytest.approx(-twist * speed, rel=1e-9)


def test_the_modes_that_are_left_out_do_not_matter():
    """Limit: all modes of the shafts; frequencies that the program shows are right to 0.4 %."""
    # At a high speed modes are counted up to 200 kHz.
    models = [model_of(helical_scene(VIBRATING, accuracy="", frequency=hertz)) for hertz in (800.0, 10e3)]
    stiffness = mesh_stiffness(models[0].scene)
    found, wanted = (np.array([each.frequency for each in vibrations(of.drivetrain, stiffness)]) for of in models)
    assert len(wanted) > len(found) + 20 > 30
    assert found == pytest.approx(wanted[: len(found)], rel=4e-3)
    assert np.all(found >= wanted[: len(found)] * (1.0 - 1e-9))
