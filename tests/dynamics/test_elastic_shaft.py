"""A gear on an elastic shaft."""

from dataclasses import replace
from math import inf, pi

import numpy as np
import pytest
from tests.beam_elements import alone, condensed

from fenics_gears.dynamics.beam import shear_coefficient
from fenics_gears.dynamics.bearings import Bearing, Bearings, Support
from fenics_gears.dynamics.elastic_shaft import ElasticShaft, SeatedGear, free_motions, in_series
from fenics_gears.dynamics.shafts import Shaft, Shafts, ShaftSection
from fenics_gears.model.drivetrain import drivetrain

STEEL = (206e3, 0.3)
E, G = STEEL[0], STEEL[0] / 2.6
STIFF = 1e12  # N/mm, of bearings that hardly give way; what they give is in the closed forms.
LOAD = 1e3


def shaft(sections, gear_at, bearings, torque_at=0.0, seat=0.0):
    return ElasticShaft(
        "pinion", tuple(sections), STEEL, (SeatedGear("pinion", gear_at, seat),), torque_at, tuple(bearings)
    )


def area(diameter, bore=0.0):
    return pi / 4.0 * (diameter**2 - bore**2)


def second(diameter, bore=0.0):
    return pi / 64.0 * (diameter**4 - bore**4)


def shear(diameter, bore=0.0):
    return float(shear_coefficient(STEEL[1], np.array(bore / diameter)))


def pushed(found, motion):
    return np.linalg.solve(alone(found).stiffness, LOAD * np.eye(5)[motion])


def test_the_shear_coefficient_is_cowpers():
    """Cowper 1966, table 1: 6 (1 + nu) / (7 + 6 nu) of a solid circle, 2 (1 + nu) / (4 + 3 nu) of a thin tube."""
    assert shear_coefficient(0.3, np.array([0.0, 1.0])) == pytest.approx([7.8 / 8.8, 2.6 / 4.9], rel=1e-14)


def simply_supported(place, motion, tilt, sense):
    """Deflection (mm) and slope (rad) between two bearings, in closed form and found: F a^2 b^2 / 3 E I L + F a b /
    (kappa G A L), and the supports' part by the lever rule."""
    length, diameter, bore = 120.0, 24.0, 10.0
    found = shaft(
        [ShaftSection(length, diameter, bore=bore)], place, [Bearing(0.0, STIFF, 1e5), Bearing(length, STIFF)]
    )
    a, b = place, length - place
    bending, shearing = E * second(diameter, bore), shear(diameter, bore) * G * area(diameter, bore)
    own = a**2 * b**2 / (3.0 * bending * length) + a * b / (shearing * length)
    supports = ((b / length) ** 2 + (a / length) ** 2) / STIFF
    moved = pushed(found, motion)
    # With shear the section keeps its tilt, that of bending alone.
    slope = a * b * (b - a) / (3.0 * bending * length) + (a - b) / length**2 / STIFF
    return (LOAD * (own + supports), moved[motion]), (LOAD * slope, moved[tilt] * sense)


@pytest.mark.parametrize("place", [30.0, 45.0, 82.0])
@pytest.mark.parametrize(("motion", "tilt", "sense"), [(0, 4, 1.0), (1, 3, -1.0)])
def test_a_simply_supported_shaft_bends_as_in_closed_form(place, motion, tilt, sense):
    """Exact: a beam with shear."""
    deflection, slope = simply_supported(place, motion, tilt, sense)
    assert deflection[1] == pytest.approx(deflection[0], rel=1e-10)
    assert slope[1] == pytest.approx(slope[0], rel=1e-8, abs=1e-12)


def overhung():
    """Deflection (mm) in closed form and found: F c^2 (l + c) / 3 E I + F c (1 + c/l) / (kappa G A), c the overhang,
    and what the bearings give."""
    span, overhang, diameter = 80.0, 35.0, 25.0
    found = shaft(
        [ShaftSection(span + overhang, diameter)], span + overhang, [Bearing(0.0, STIFF, 1e5), Bearing(span, STIFF)]
    )
    bending, shearing = E * second(diameter), shear(diameter) * G * area(diameter)
    share = overhang / span
    own = overhang**2 * (span + overhang) / (3.0 * bending) + overhang * (1.0 + share) / shearing
    return LOAD * (own + (share**2 + (1.0 + share) ** 2) / STIFF), pushed(found, 0)[0]


def test_an_overhung_gear_bends_its_shaft_as_in_closed_form():
    """Exact: a beam with shear beyond its bearings."""
    exact, found = overhung()
    assert found == pytest.approx(exact, rel=1e-10)


CLAMP = Bearing(0.0, STIFF, STIFF, 1e18)


def cantilever_of_cylinders():
    """In closed form and found: the integral of M^2 / E I."""
    steps = [ShaftSection(40.0, 30.0), ShaftSection(60.0, 20.0)]
    found = shaft(steps, 100.0, [CLAMP])
    thick, thin = E * second(30.0), E * second(20.0)
    bent = 60.0**3 / (3.0 * thin) + (100.0**3 - 60.0**3) / (3.0 * thick)
    sheared = sum(each.length / (shear(each.diameter) * G * area(each.diameter)) for each in steps)
    turned = 60.0**2 / (2.0 * thin) + (100.0**2 - 60.0**2) / (2.0 * thick)
    stretched = sum(each.length / (E * area(each.diameter)) for each in steps)
    exact = bent + sheared + 1.0 / STIFF + 100.0**2 / 1e18, turned + 100.0 / 1e18, stretched + 1.0 / STIFF
    moved = *pushed(found, 0)[[0, 4]], pushed(found, 2)[2]
    return tuple((LOAD * own, value) for own, value in zip(exact, moved))


def cone():
    """In closed form and found: stretch 4 F L / (pi E d1 d2); deflection 64 F L^3 / (3 pi E d1^3 d2)."""
    found = shaft([ShaftSection(50.0, 40.0, 4.0)], 50.0, [CLAMP])
    conical = 4.0 * 50.0 / (pi * E * 40.0 * 4.0)
    bent = 64.0 * 50.0**3 / (3.0 * pi * E * 40.0**3 * 4.0)
    sheared = conical * E / (shear(1.0) * G)
    exact = conical + 1.0 / STIFF, bent + sheared + 1.0 / STIFF + 50.0**2 / 1e18
    return (LOAD * exact[0], pushed(found, 2)[2]), (LOAD * exact[1], pushed(found, 0)[0])


def test_a_stepped_shaft_a_cone_and_axial_force():
    """Closed forms of a cantilever and a cone."""
    deflection, slope, stretch = cantilever_of_cylinders()
    assert deflection[1] == pytest.approx(deflection[0], rel=1e-9)
    assert slope[1] == pytest.approx(slope[0], rel=1e-9)
    assert stretch[1] == pytest.approx(stretch[0], rel=1e-10)
    stretch, deflection = cone()
    assert stretch[1] == pytest.approx(stretch[0], rel=1e-10)
    assert deflection[1] == pytest.approx(deflection[0], rel=1e-9)


def of_steps_and_a_cone():
    sections = [ShaftSection(40.0, 30.0, bore=12.0), ShaftSection(50.0, 20.0, 35.0), ShaftSection(30.0, 35.0)]
    return shaft(sections, 110.0, [Bearing(10.0, 1e5, 1e5), Bearing(70.0, 1e5)], seat=20.0)


def torsion(found):
    return alone(found).torsional_stiffness(found)


def twisted():
    """Twist (rad/(N mm)) in closed form and found: sum of L / G J; a cone's 32 L (1/d1^3 - 1/d2^3) / (3 pi G (d2 -
    d1))."""
    tapered = 32.0 * 50.0 * (20.0**-3 - 35.0**-3) / (3.0 * pi * G * 15.0)
    exact = 40.0 / (G * 2.0 * second(30.0, 12.0)) + tapered + 10.0 / (G * 2.0 * second(35.0))
    return exact, 1.0 / torsion(of_steps_and_a_cone())


def test_torsion_of_steps_and_of_a_cone():
    """Closed form up to the gear's seat; none within it."""
    exact, found = twisted()
    assert found == pytest.approx(exact, rel=1e-12)
    assert torsion(replace(of_steps_and_a_cone(), torque_at=104.0)) == inf


MATRIX = np.array([
    [3e5, 2e4, 1e3, -4e5, 9e5], [2e4, 4e5, 2e3, -8e5, 3e5], [1e3, 2e3, 1e5, 1e4, 2e4],
    [-4e5, -8e5, 1e4, 5e7, 1e6], [9e5, 3e5, 2e4, 1e6, 6e7],
])  # fmt: skip
STEPS = (ShaftSection(32.0, 28.0, bore=8.0), ShaftSection(60.0, 35.0), ShaftSection(30.0, 22.0, bore=5.0))
ON_THREE = (
    Bearing(12.0, 3e5, 1e5),
    Bearing(88.0, stiffness_matrix=tuple(map(tuple, MATRIX))),
    Bearing(115.0, 2e5, 0.0, 4e6),
)


def test_the_stiffness_is_that_of_a_textbooks_elements():
    """Brute force: elements of a textbook, condensed, with bearings of all kinds."""
    found = shaft(STEPS, 55.0, ON_THREE, seat=18.0)
    # Elements cannot be rigid: what their flexibility leaves is in proportion to it, and extrapolated.
    by_elements = 2.0 * condensed(found, shear, 2e4) - condensed(found, shear, 1e4)
    size = np.outer(*2 * [np.sqrt(np.diag(by_elements))])
    assert alone(found).stiffness / size == pytest.approx(by_elements / size, abs=1e-8)
    free = replace(found, seats=(SeatedGear("pinion", 55.0),))
    assert alone(free).stiffness / size == pytest.approx(condensed(free, shear) / size, abs=1e-9)


def test_deflection_lines_go_through_gear_and_bearings():
    """Identity: as the gear and the shaft in its bearings move; straight beyond the last bearing."""
    found = shaft(STEPS, 55.0, ON_THREE[:2], seat=18.0)
    places = np.array([55.0, 12.0, 88.0, 100.0, 110.0, 120.0, 49.0])
    lines = alone(found).deflection(found, places)
    assert lines[0] == pytest.approx(np.eye(5), abs=1e-14)
    assert lines[1:3].reshape(10, 5) == pytest.approx(alone(found).at_bearings, rel=1e-9, abs=1e-15)
    assert lines[5] - lines[4] == pytest.approx(lines[4] - lines[3], abs=1e-13)
    # Within the seat it is the gear's own.
    assert lines[6, 0] == pytest.approx([1.0, 0.0, 0.0, 0.0, -6.0], abs=1e-14)


def test_the_twist_is_that_of_a_torsional_spring(paper_scene, paper_pair):
    """Identity: a torsional spring of that stiffness, on either side."""
    scene = replace(paper_scene, inertia=None, damping=None, bearings=None)
    own = Shaft(sections=(ShaftSection(120.0, 30.0),), gear_at=100.0, torque_at=0.0)
    bearings = Support(each=(Bearing(10.0, 1e5, 1e5), Bearing(60.0, 1e5)))
    width = paper_pair.face_widths[0]
    twisted = G * 2.0 * second(30.0) / (100.0 - 0.5 * width)
    wanted = drivetrain(replace(scene, shafts=Shafts(twisted)), paper_pair)
    for side, gear, name in (("input", "pinion", "rotation_1"), ("output", "wheel", "twist_2")):
        other = {"input": "output", "output": "input"}[side]
        shafts = Shafts(None, **{side: own, other: Shaft(twisted)})
        found = drivetrain(replace(scene, shafts=shafts, bearings=Bearings(**{gear: bearings})), paper_pair)
        assert {"rotation_1", "rotation_2", "twist_2"} <= set(found.coordinates)
        place, there = found.coordinates.index(name), wanted.coordinates.index(name)
        assert found.stiffness[place] == pytest.approx(np.eye(len(found.load))[place] * wanted.stiffness[there, there])
        assert found.load[place] == wanted.load[there]


def test_a_housing_of_springs_is_in_series_with_the_bearings():
    """Exact: k h / (k + h) for each bearing over nine decades; seats that hold each other, as blocks of springs."""
    bearings = [Bearing(12.0, 3e5, 1e5, 1e7), Bearing(88.0, 4e5, 0.0, 2e6)]
    own = np.concatenate([np.diag(each.matrix) for each in bearings])
    for times in (1e-9, 0.3, 1e9):
        seats = times * np.array([2e5, 5e5, 1e5, 2e7, 1e7, 1e5, 3e5, 2e5, 1e7, 3e7])
        series = np.diag(own * seats / (own + seats))
        blocks = (series[:5, :5], series[5:, 5:])
        wanted = [Bearing(each.at, stiffness_matrix=tuple(map(tuple, of))) for each, of in zip(bearings, blocks)]
        found = alone(shaft(STEPS, 55.0, bearings), np.diag(seats))
        by_hand = alone(shaft(STEPS, 55.0, wanted)).stiffness
        assert found.stiffness == pytest.approx(by_hand, rel=1e-12, abs=1e-12 * by_hand.max())
    draw = np.random.default_rng(7).normal(size=(10, 6))
    coupled, springs = 1e5 * draw @ draw.T, np.diag(own + 1e3)
    eliminated = springs - springs @ np.linalg.solve(springs + coupled, springs)
    assert in_series(springs, coupled) == pytest.approx(eliminated, rel=1e-9, abs=1e-12 * springs.max())


@pytest.mark.parametrize(
    ("bearings", "free"),
    [
        ([Bearing(10.0, 1e5, 1e4)], ["tilts about x", "tilts about y"]),
        ([Bearing(10.0, 1e5), Bearing(60.0, 1e5)], ["moves along its axis"]),
        ([Bearing(10.0, 1e5, 1e4, 1e6)], []),
        ([Bearing(10.0, 1e5, 1e4), Bearing(60.0, 1e5)], []),
    ],
)
def test_motions_that_bearings_leave_free(bearings, free):
    """Exact: motions of a rigid shaft without stiffness."""
    found = alone(shaft([ShaftSection(100.0, 30.0)], 80.0, bearings))
    assert free_motions(found.shafts, found.springs) == {"pinion": free}
