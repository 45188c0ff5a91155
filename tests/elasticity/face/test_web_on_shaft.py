"""A wheel with web on an elastic shaft, by the program's parts, against one solid of shaft, hub, web and rim."""

import numpy as np
import pytest
from tests.elasticity.face.body_of_revolution import BORE, OUTER, POISSON, SECTORS, Meridian, Part, motion

from fenics_gears.dynamics.elastic_shaft import ElasticShaft
from fenics_gears.effects.bearings import Bearing
from fenics_gears.effects.shafts import ShaftSection
from fenics_gears.elasticity.slice_averages import slice_averages

# mm; of the bearings N/mm, of which Young's modulus is 1 MPa: 3e5 on steel.
INNER, HUB, RIM, FACE, THICKNESS, OFFSET, LENGTH, BEARING = 5.0, 28.0, 52.0, 24.0, 6.0, 6.0, 200.0, 1.5
# Places of the gear and of the bearings.
SHAFTS = {"between bearings": (70.0, (20.0, 180.0)), "overhung": (170.0, (20.0, 120.0))}
# N and N mm: a transverse force cos(theta) around the rim, and an axial one, whose moment is all that it makes.
FORCE, MOMENT = 0.5 * SECTORS, 0.5 * SECTORS * OUTER
# Offset of the axis and its inclination at the gear under the force; inclination there under the moment.
AXIS = ("offset", "inclination", "inclination by moment")


def by_solid(name, size=1.0):
    """Of the solid: AXIS, as means over a section of the shaft in the middle of the face; on the average over the face,
    and as slope over it, what the rim moves radially under the force."""
    at, bearings = SHAFTS[name]
    low, high = at - 0.5 * FACE, at + 0.5 * FACE
    web = Part(HUB, RIM, at + OFFSET - 0.5 * THICKNESS, at + OFFSET + 0.5 * THICKNESS)
    parts = [Part(INNER, BORE, 0.0, LENGTH), Part(BORE, HUB, low, high), web, Part(RIM, OUTER, low, high)]
    bodies = [Meridian(parts, order, size) for order in (1, 4)]
    one, four = bodies
    loads = 0.5 * SECTORS * np.stack([one.even_over(OUTER, 0), one.even_over(OUTER, 2)], axis=1)
    found = one.solved(loads, springs=[(BEARING, one.section_moved(each, BORE)[0]) for each in bearings])
    (offset, _), tilts = one.section_moved(at, BORE) @ found
    outer = one.at_radius(OUTER)
    slope = np.polyfit(one.nodes[outer, 1], found[3 * outer, 0], 1)[0]
    # What the rim gives way beside the forces is in every harmonic.
    beside = four.even_over(OUTER, 0) @ four.solved(loads[:, :1])
    rim = float(one.even_over(OUTER, 0) @ found[:, 0] - beside[0])
    return dict(zip((*AXIS, "rim", "slope"), map(float, (offset, *tilts, rim, slope))))


def axis(name, sections, seat):
    """AXIS by the program, with a seat that is rigid over a width (mm)."""
    at, bearings = SHAFTS[name]
    held = tuple(Bearing(each, BEARING, 1.0) for each in bearings)
    shaft = ElasticShaft("wheel", sections, (1.0, POISSON), at, seat, 0.0, held)
    moved = np.linalg.inv(shaft.stiffness)
    return dict(zip(AXIS, (FORCE * moved[0, 0], FORCE * moved[4, 0], -MOMENT * moved[4, 4])))


def by_program(name):
    """As `by_solid`, with the seat that is rigid over the face: the body on its bore, and the shaft under that."""
    found = axis(name, PLAIN, FACE)
    radial = np.array([1.0, 0.0, 0.0])
    heights, own = motion(RIM, FACE, THICKNESS, 1, radial, OFFSET, HUB)
    four = motion(RIM, FACE, THICKNESS, 4, radial, OFFSET, HUB)[1]
    over_face = slice_averages(heights, 2, np.zeros(1), np.array([FACE]))[0]
    found["rim"] = float(over_face @ (own - four)[:, 0]) + found["offset"]
    found["slope"] = float(np.polyfit(heights, own[:, 0], 1)[0]) + found["inclination"]
    return found


def with_cones(name):
    """Sections of a shaft that is as thick as the hub but for cones of 45 degrees at both ends of the face."""
    low, rise = SHAFTS[name][0] - 0.5 * FACE, HUB - BORE
    thick, thin = 2.0 * HUB, 2.0 * BORE
    return tuple(
        ShaftSection(length, left, right, 2.0 * INNER)
        for length, left, right in (
            (low, thin, thin),
            (rise, thin, thick),
            (FACE - 2.0 * rise, thick, thick),
            (rise, thick, thin),
            (LENGTH - low - FACE, thin, thin),
        )
    )


PLAIN = (ShaftSection(LENGTH, 2.0 * BORE, bore=2.0 * INNER),)


@pytest.mark.nightly
@pytest.mark.parametrize("name", SHAFTS)
def test_the_axis_of_a_solid_is_between_a_rigid_seat_and_none(name):
    """Authority: finite elements of the solid's meridian section. A rigid seat gives way too little, a shaft that bends
    under the face as beside it too much; the hub helps the shaft as cones of 45 degrees do."""
    solid, rigid, free, cones = (
        by_solid(name), axis(name, PLAIN, FACE), axis(name, PLAIN, 0.0), axis(name, with_cones(name), 0.0)
    )  # fmt: skip
    for each in AXIS:
        least, most = sorted((abs(rigid[each]), abs(free[each])))
        assert least < abs(solid[each]) < most
    for each in AXIS[:2]:
        assert cones[each] == pytest.approx(solid[each], rel=0.01)


@pytest.mark.nightly
def test_an_overhung_wheel_with_web_on_a_rigid_seat_against_one_solid():
    """Authority: as above; where the shaft bends beside the gear, not under it, axis and rim are within 2 %; so is
    the rim's slope, what axis and web make of it against each other, by the axis's."""
    solid, found = by_solid("overhung"), by_program("overhung")
    for each in ("offset", "inclination", "rim"):
        assert found[each] == pytest.approx(solid[each], rel=0.02)
    assert found["slope"] == pytest.approx(solid["slope"], abs=0.02 * solid["inclination"])


@pytest.mark.nightly
def test_finer_elements_of_the_solid_change_little():
    """By refinement: squares of half the size."""
    assert by_solid("overhung", 0.5) == pytest.approx(by_solid("overhung"), rel=2e-3)
