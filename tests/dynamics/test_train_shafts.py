"""Shafts that bend and carry several gears."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest
from scipy.linalg import eigh
from tests.beam_elements import FIVE, assembled
from tests.dynamics.test_elastic_shaft import E, G, area, second, shaft, shear

from fenics_gears.dynamics.bearings import Bearing
from fenics_gears.dynamics.elastic_shaft import ElasticShaft, SeatedGear
from fenics_gears.dynamics.shaft_system import ShaftSystem
from fenics_gears.dynamics.shafts import ShaftSection
from fenics_gears.dynamics.train_shafts import mesh_axes, turned_motions

SECTIONS = (ShaftSection(50.0, 30.0, bore=10.0), ShaftSection(60.0, 42.0), ShaftSection(40.0, 25.0))
BEARINGS = (Bearing(12.0, 3e5, 1e5), Bearing(85.0, 2e5, 0.0, 1e7), Bearing(140.0, 4e5))
GEARS = (30.0, 110.0)


def two_gears(sections=SECTIONS, bearings=BEARINGS, gears=GEARS, density=0.0):
    """A shaft with two gears without width; and the same as one with the first gear alone."""
    whole = shaft(sections, gears[0], bearings, torque_at=gears[0])
    seats = tuple(SeatedGear(name, at) for name, at in zip(("one", "other"), gears))
    both = replace(whole, name="both", seats=seats, torque_at=None, density=density)
    return ShaftSystem((replace(both, up_to=1e6) if density else both,)), whole


def test_two_gears_on_a_shaft_have_the_stiffness_of_a_textbooks_elements():
    """Brute force: the whole shaft of Przemieniecki's elements, at the middles of both gears."""
    found, whole = two_gears()
    places, stiffness = assembled(whole, shear, GEARS)
    kept = np.concatenate([np.arange(FIVE) + FIVE * places.index(each) for each in GEARS])
    others = np.setdiff1d(np.arange(len(stiffness)), kept)
    follows = np.linalg.solve(stiffness[np.ix_(others, others)], stiffness[np.ix_(others, kept)])
    wanted = stiffness[np.ix_(kept, kept)] - stiffness[np.ix_(kept, others)] @ follows
    assert found.stiffness == pytest.approx(wanted, rel=1e-8, abs=1e-9 * np.abs(wanted).max())


def test_three_gears_and_a_coupling_twist_as_springs_in_a_row():
    """Exact: G J over length between neighbours; a turn of all is free."""
    sections = (ShaftSection(200.0, 30.0),)
    seats = tuple(SeatedGear(name, at) for name, at in zip("abc", (40.0, 90.0, 120.0)))
    own = ElasticShaft("line", sections, (E, 0.3), seats, 180.0, (Bearing(10.0, 3e5, 1e5), Bearing(190.0, 3e5)))
    found = ShaftSystem((own,))
    wanted = np.zeros((4, 4))
    for first, length in enumerate((50.0, 30.0, 60.0)):
        ends = np.ix_([first, first + 1], [first, first + 1])
        wanted[ends] += G * 2.0 * second(30.0) / length * np.array([[1.0, -1.0], [-1.0, 1.0]])
    turns = np.zeros((len(found.motions), 4))
    turns[[found.motions.index(name) for name in own.turns], range(4)] = 1.0
    assert found.over(turns, "stiffness") == pytest.approx(wanted, rel=1e-9, abs=1e-9 * wanted.max())
    assert not (found.over(turns, "stiffness") @ np.ones(4)).any()


def test_a_shaft_with_two_gears_vibrates_as_a_textbooks_elements():
    """Brute force: two hundred elements with lumped masses, a mass at either gear."""
    density = 7.85e-9
    of_gears = np.array([[1e-3, 1e-3, 1e-3, 0.3, 0.3, 0.5], [2e-3, 2e-3, 2e-3, 0.8, 0.8, 1.5]])
    found, whole = two_gears(density=density)
    places, stiffness = assembled(whole, shear, [*np.linspace(0.0, whole.length, 201), *GEARS])
    ends = np.cumsum([each.length for each in SECTIONS])
    masses = np.zeros((len(places), FIVE))
    for number, (left, right) in enumerate(zip(places, places[1:])):
        part = SECTIONS[int(np.searchsorted(ends, 0.5 * (left + right)))]
        size = np.array([area(part.diameter, part.bore)] * 3 + [second(part.diameter, part.bore)] * 2)
        masses[number : number + 2] += 0.5 * density * (right - left) * size
    for at, own in zip(GEARS, of_gears):
        masses[places.index(at)] += own[:FIVE]
    lumped = np.sqrt(eigh(stiffness, np.diag(masses.ravel()), eigvals_only=True, subset_by_index=(0, 9))) / (2.0 * pi)
    # Its turns, which these elements have not, are held.
    held = [place for place, name in enumerate(found.given) if not name.endswith("turn")]
    kept = [*held, *range(len(found.given), len(found.mass))]
    mass = found.mass[np.ix_(kept, kept)] + np.diag([*of_gears[:, :FIVE].ravel(), *np.zeros(len(found.own_modes))])
    own = np.sqrt(eigh(found.stiffness, mass, eigvals_only=True)) / (2.0 * pi)
    assert [np.abs(own / each - 1.0).min() for each in lumped] == pytest.approx(np.zeros(10), abs=4e-4)


@pytest.mark.parametrize("sense", [1.0, -1.0])
@pytest.mark.parametrize("forwards", [1.0, -1.0])
def test_motions_of_a_rigid_shaft_are_one_motion_in_every_frame(sense, forwards):
    """Identity: what a tilt does to a place on the axis is the vector product of the tilt and the place, whichever way
    round a frame is."""
    in_plane = [[np.cos(0.4), np.sin(0.4)], [-sense * np.sin(0.4), sense * np.cos(0.4)]]
    axes = mesh_axes(np.array(in_plane), forwards)
    place = np.array([0.0, 0.0, 7.0])
    motion = np.array([0.1, -0.2, 0.3, 0.02, -0.01])
    moved = motion[:3] + np.cross([*motion[3:], 0.0], place)
    in_mesh = turned_motions(np.eye(3), axes)[:5, :5] @ motion
    there = in_mesh[:3] + np.cross([*in_mesh[3:], 0.0], axes @ place)
    assert there == pytest.approx(axes @ moved, abs=1e-15)
