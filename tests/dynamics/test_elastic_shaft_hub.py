"""A hub that gives way with its shaft."""

from math import pi

import numpy as np
import pytest
from scipy.linalg import block_diag
from scipy.sparse import csc_matrix, diags
from scipy.sparse.linalg import splu
from tests.beam_elements import alone

from fenics_gears.dynamics.bearings import Bearing
from fenics_gears.dynamics.elastic_shaft import ElasticShaft, SeatedGear
from fenics_gears.dynamics.elastic_shaft_hub import Hub
from fenics_gears.dynamics.shaft_elements import carried
from fenics_gears.dynamics.shafts import ShaftSection
from fenics_gears.elasticity.body_of_revolution import BodyOfRevolution, Ring, flexibility, flexibility_outside

STEEL = (206e3, 0.3)
BORED, BORE, HUB, RIM, OUTER, HALF = 4.0, 14.0, 20.0, 30.0, 36.0, 10.0
HEIGHTS = np.linspace(-0.9, 0.9, 5) * HALF
# Of the shaft: its ends, on either side of the face, and under it.
PLACES = np.array([0.0, 30.0, 53.0, 58.5, 66.0, 90.0, 140.0])
# Ends of the shaft and middle of the gear; a web that is off mid-width.
LENGTH, AT, SPRING, TILTING, SIZE = 140.0, 60.0, 3e5, 1e8, 2.0
GEAR = (Ring(BORE, HUB, -HALF, HALF, *STEEL), Ring(HUB, RIM, 1.0, 6.0, *STEEL), Ring(RIM, OUTER, -HALF, HALF, *STEEL))


def test_a_tube_bends_twists_and_stretches_as_closed_forms_have_it():
    """Exact: L / E I and L^2 / 2 E I under an end moment, L / E A, L / G J."""
    length, (modulus, ratio) = 50.0, STEEL
    tube = BodyOfRevolution([Ring(BORED, BORE, 0.0, length, *STEEL)], 2.0)
    bent, stretched = (
        flexibility(tube.stiffness(order), *(tube.of_section(end, BORE, order) for end in (0.0, length)))
        for order in (1, 0)
    )
    area, second = pi * (BORE**2 - BORED**2), pi / 4.0 * (BORE**4 - BORED**4)
    assert bent[:, 1] * modulus * second == pytest.approx([0.5 * length**2, length], rel=1e-6)
    assert np.diag(stretched) * modulus * np.array([area, second / (1.0 + ratio)]) == pytest.approx(length, rel=1e-6)


def test_body_on_its_bore_rigid_seat_and_hub_make_up_one_solid():
    """Brute force: the same elements over the whole shaft, whose ends are held in the mean: also the shaft's own line
    and the loads of its bearings, which hold tilts. Beams beside the face are what differs, by Timoshenko's shear. The
    remainder is never negative."""
    whole = BodyOfRevolution([Ring(BORED, BORE, -AT, LENGTH - AT, *STEEL), *GEAR], SIZE)
    held = Bearing(0.0, SPRING, SPRING, TILTING), Bearing(LENGTH, SPRING, 0.0, TILTING)
    sections = (ShaftSection(LENGTH, 2.0 * BORE, bore=2.0 * BORED),)
    hub = Hub(GEAR, Ring(BORED, BORE, -HALF, HALF, *STEEL))
    shaft = ElasticShaft("wheel", sections, STEEL, (SeatedGear("wheel", AT, 2.0 * HALF, hub=hub),), 0.0, held)
    system = alone(shaft)
    rigid = block_diag(np.linalg.inv(system.stiffness), 1.0 / system.torsional_stiffness(shaft))
    carry = np.array([carried(z) for z in HEIGHTS])
    # Motions of the gear's middle, of the face's ends apart, and the twist.
    follows = system.seat(shaft.seats[0]).follows(HEIGHTS)
    carry = np.concatenate([carry[..., :5], follows, carry[..., 5:]], axis=2)
    seat = system.seat(shaft.seats[0]).under(HEIGHTS).compliance
    line = system.bent_by_seat(shaft.seats[0], HEIGHTS, PLACES)
    found = seat + np.einsum("sia,ab,tjb->sitj", carry, rigid, carry)
    gear = np.einsum("ab,tjb->atj", rigid, carry)[:-1]
    line = line + np.einsum("pma,atj->pmtj", system.deflection(shaft, PLACES), gear)
    bearings = np.einsum("ba,atj->btj", system.bearing_loads, gear).reshape(2, 5, len(HEIGHTS), 6)
    for order, motions in ((1, [0, 4]), (0, [2, 5])):
        stiffness, rim = whole.stiffness(order), whole.of_circles(OUTER, HEIGHTS, order)
        left, right = (whole.of_section(end, BORE, order) for end in (-AT, LENGTH - AT))
        if order:
            rows = csc_matrix(np.concatenate([left, right]))
            springs = rows.T @ diags([SPRING, TILTING] * 2) @ rows
            solid = splu((stiffness + springs).tocsc()).solve(rim.T)
            free = rim @ solid
            moved = np.array([whole.of_section(each - AT, BORE, order) @ solid for each in PLACES])
            moved = moved.reshape(len(PLACES), 2, len(HEIGHTS), 2)
            loads = moved[[0, -1]] * np.array([SPRING, TILTING])[:, None, None]
            pairs = (line[:, :1][..., motions], moved[:, :1]), (bearings[:, motions][..., motions], loads)
            for parts, by_solid in pairs:
                off, size = (np.abs(each).max(axis=(0, 2)) for each in (parts - by_solid, by_solid))
                assert (off / size).max() <= 0.01
        else:
            free = flexibility(stiffness, left, rim)
            free[::2, ::2] += 1.0 / SPRING
        wanted = free - flexibility_outside(stiffness, whole.nodes[:, 0] < BORE + 1e-9, rim)
        wanted = wanted.reshape(len(HEIGHTS), 2, len(HEIGHTS), 2)
        size = np.sqrt(np.einsum("ikik->ik", wanted)).max(axis=0)
        off = np.abs(found[:, motions][..., motions] - wanted).max(axis=(0, 2)) / np.outer(size, size)
        assert off.max() <= (0.01 if order else 1e-3)
    root = np.sqrt(np.diag(seat.reshape(6 * len(HEIGHTS), -1)))
    assert np.linalg.eigvalsh(seat.reshape(len(root), -1) / np.outer(root, root))[0] >= -1e-9
