"""Elements of shafts over named motions, and shafts that one housing ties together."""

from dataclasses import dataclass, replace
from math import pi

import numpy as np
import pytest
from tests.beam_elements import alone, assembled
from tests.dynamics.test_elastic_shaft import ON_THREE, STEEL, STEPS, STIFF, E, G, area, second, shaft, shear

from fenics_gears.dynamics.beam import Beam
from fenics_gears.dynamics.bearings import Bearing
from fenics_gears.dynamics.elastic_shaft import ElasticShaft, SeatedGear
from fenics_gears.dynamics.shaft_elements import Assembly, Element, Link, Springs, carried, motions_of
from fenics_gears.dynamics.shaft_system import ShaftSystem
from fenics_gears.dynamics.shafts import ShaftSection

LENGTH, DIAMETER = 150.0, 25.0


def influence(x, load):
    """Deflection (mm/N) at x of a simply supported beam with shear by a force at another place, in closed form: a
    cubic, the shear's share, and what the supports give by the lever rule."""
    x, load = min(x, load), max(x, load)
    b = LENGTH - load
    bent = b * x * (LENGTH**2 - b**2 - x**2) / (6.0 * E * second(DIAMETER) * LENGTH)
    sheared = x * b / (shear(DIAMETER) * G * area(DIAMETER) * LENGTH)
    supports = (x * load + (LENGTH - x) * b) / LENGTH**2 / STIFF
    return bent + sheared + supports


def test_two_gears_on_one_shaft_bend_it_as_in_closed_form():
    """Exact: the influence lines of a beam between two supports, and the twist between the gears, L / G J."""
    gears = (40.0, 105.0)
    seats = tuple(SeatedGear(str(each), each) for each in gears)
    chain = ElasticShaft("shaft", (ShaftSection(LENGTH, DIAMETER),), STEEL, seats).chain
    nodes = [motions_of("shaft", number) for number in chain.nodes([0.0, LENGTH])]
    ends = [tuple(motions_of("shaft", node) for node in face) for face in chain.faces]
    elements = [
        *chain.outside,
        *(Springs(node[:3], STIFF * np.diag([1.0, 1.0, axial])) for node, axial in zip(nodes, (1.0, 0.0))),
        *(Link((*left, *right)) for left, right in ends),
    ]
    held = Assembly(elements).held(nodes[0][-1:])
    rows = held.assembly.numbers([left[motion] for motion in (0, 1, 5) for left, _ in ends])
    found = held.flexibility[np.ix_(rows, rows)]
    wanted = np.array([[influence(one, other) for other in gears] for one in gears])
    assert found[:2, :2] == pytest.approx(wanted, rel=1e-10)
    assert found[2:4, 2:4] == pytest.approx(wanted, rel=1e-10)
    polar = G * pi / 32.0 * DIAMETER**4
    assert found[4:, 4:] == pytest.approx(np.minimum.outer(gears, gears) / polar, rel=1e-12)
    assert not found[:2, 2:].any()


@dataclass(frozen=True, eq=False)
class Foot(Element):
    """A support that anyone may add: springs, a damper and a lump of mass on the displacements of a node."""

    motions: tuple[str, ...]
    spring: float
    viscosity: float
    lump: float = 0.0

    @property
    def mass(self):
        return self.lump * np.eye(len(self.motions))

    @property
    def stiffness(self):
        return self.spring * np.eye(len(self.motions))

    @property
    def damping(self):
        return self.viscosity * np.eye(len(self.motions))


def test_an_element_of_ones_own_joins_by_the_names_of_its_motions():
    """Identity: a support by a class of its own, on the node of the coupling, is a bearing there; its damping and its
    mass move with a stiff shaft as with a rigid one."""
    two = shaft(STEPS, 55.0, ON_THREE[:2], torque_at=115.0, seat=18.0)
    node = motions_of("pinion", int(two.chain.nodes([115.0])[0]))
    found = ShaftSystem((two,), more=(Foot(node[:2], 2e5, 3.0),))
    wanted = alone(replace(two, bearings=(*two.bearings, Bearing(115.0, 2e5))))
    assert found.stiffness == pytest.approx(wanted.stiffness, rel=1e-10, abs=1e-10 * wanted.stiffness.max())
    stiff = ShaftSystem((replace(two, material=(1e30, 0.3)),), more=found.more)
    moved = carried(115.0 - 55.0)[:2, :5]
    assert stiff.damping == pytest.approx(3.0 * moved.T @ moved, rel=1e-9, abs=1e-9)
    heavy = replace(stiff, more=(Foot(node[:2], 2e5, 3.0, 0.7),))
    assert heavy.over(heavy.motions_over(heavy.coordinates), "mass") == pytest.approx(
        0.7 * moved.T @ moved, rel=1e-9, abs=1e-9
    )


def test_a_beam_has_the_stiffness_of_the_textbooks_element():
    """Textbook: tests.beam_elements, which has no twist."""
    from tests.beam_elements import element

    chain = ElasticShaft("shaft", (ShaftSection(60.0, 30.0, bore=10.0),), STEEL, ()).chain
    (beam,) = chain.outside
    assert isinstance(beam, Beam)
    five = [*range(5), *range(6, 11)]
    wanted = element(60.0, *STEEL, 30.0, 10.0, shear(30.0, 10.0))
    assert beam.stiffness[np.ix_(five, five)] == pytest.approx(wanted, rel=1e-10, abs=1e-10 * np.abs(wanted).max())


OTHER = ElasticShaft(
    "wheel",
    (ShaftSection(150.0, 40.0),),
    STEEL,
    (SeatedGear("wheel", 60.0),),
    150.0,
    (Bearing(20.0, 2e5, 1e5), Bearing(110.0, 4e5)),
)
PAIR = (shaft(STEPS, 55.0, ON_THREE[:2]), OTHER)


def coupled(seed=3, size=20):
    """A housing in which every seat moves every other one."""
    draw = np.random.default_rng(seed).normal(size=(size, size))
    scale = np.tile([1.0, 1.0, 1.0, 30.0, 30.0], size // 5)
    return 2e4 * scale[:, None] * (draw @ draw.T + np.eye(size)) * scale


def by_textbook(shafts, housing, seat_stiffness=1.0):
    """Stiffness (5 g, 5 g) at the gears of shafts of a textbook's elements, with a node for each seat."""
    free = [
        assembled(replace(each, bearings=()), shear, [own.at for own in each.bearings], seat_stiffness)
        for each in shafts
    ]
    sizes = [len(stiffness) for _, stiffness in free]
    total = sum(sizes)
    whole = np.zeros((total + len(housing),) * 2)
    whole[total:, total:] = housing
    first, seat, gears = 0, total, []
    for each, (places, stiffness), size in zip(shafts, free, sizes):
        whole[first : first + size, first : first + size] += stiffness
        for bearing in each.bearings:
            node = first + 5 * places.index(bearing.at)
            rows = np.zeros((5, len(whole)))
            rows[:, node : node + 5] = np.eye(5)
            rows[:, seat : seat + 5] = -np.eye(5)
            whole += rows.T @ np.array(bearing.matrix) @ rows
            seat += 5
        gear = first + 5 * places.index(each.seats[0].at)
        gears += range(gear, gear + 5)
        first += size
    others = np.setdiff1d(np.arange(len(whole)), gears)
    follow = np.linalg.solve(whole[np.ix_(others, others)], whole[np.ix_(others, gears)])
    return whole[np.ix_(gears, gears)] - whole[np.ix_(gears, others)] @ follow


def test_two_shafts_in_one_housing_are_those_of_a_textbooks_elements():
    """Brute force: a textbook's elements and a node for each seat; also where the housing ties nothing together, as
    two shafts in housings of their own."""
    housing = coupled()
    found, wanted = ShaftSystem(PAIR, housing).gear_stiffness, by_textbook(PAIR, housing)
    size = np.sqrt(np.outer(np.diag(wanted), np.diag(wanted)))
    assert found / size == pytest.approx(wanted / size, abs=1e-9)
    # One gear moves the other.
    assert np.abs((wanted / size)[:5, 5:]).max() > 1e-3
    apart = housing.copy()
    apart[:10, 10:] = apart[10:, :10] = 0.0
    both = ShaftSystem(PAIR, apart)
    for each, own in zip(PAIR, (apart[:10, :10], apart[10:, 10:])):
        single = alone(each, own).gear_stiffness
        assert both.stiffness_at(each.seats[0]) == pytest.approx(single, rel=1e-9, abs=1e-10 * single.max())
