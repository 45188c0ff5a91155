"""Gears with a web over the face."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest
from tests.coarse_sector import PINION, STEEL
from tests.elasticity.face.body_of_revolution import BORE, OUTER, POISSON, SECTORS, Meridian, Part, motion, simpson

from fenics_gears.elasticity.compliance import Reach
from fenics_gears.elasticity.face.compliance import face_compliance
from fenics_gears.elasticity.face.cost import expected_size
from fenics_gears.elasticity.face.discretisation import FaceDiscretisation
from fenics_gears.elasticity.face.layers import SweptWeb, layers_of_face, layers_with_web
from fenics_gears.elasticity.slice_averages import slice_averages
from fenics_gears.geometry.gear_data import Web

WIDTH, BOTH = 12.0, Reach(1, (-1, 1))
WEB = Web(18.0, 25.0, 0.4)


def swept(web):
    sides = (WIDTH * (web.offset + side * web.share) for side in (-0.5, 0.5))
    return SweptWeb(web.hub_radius, web.rim_radius, *sides)


def body(web=None, reach=BOTH):
    gear, division = PINION, FaceDiscretisation(2.0, 4, WIDTH)
    if web is not None:
        gear, division = replace(PINION, web=web), replace(division, web=swept(web))
    return face_compliance(gear, STEEL, division, reach)


def under_even_load(found):
    """Mean displacement (mm/N) of the drive flank along y."""
    dofs = 3 * len(found.roll_angle) * len(found.heights)
    along = np.zeros(dofs)
    along[1::3] = 3.0 / dofs
    return along @ found.blocks[0][:dofs, :dofs] @ along


def test_a_web_as_wide_as_the_face_is_the_gear_without_one():
    """Identity, but for another mesh below the rim: 1.4e-4 with elements of the body that are four times those of the
    flank, 2e-5 with three times."""
    whole, plain = (body(web) for web in (Web(18.0, 25.0, 1.0), None))
    assert under_even_load(whole) == pytest.approx(under_even_load(plain), rel=3e-4)


# Of the last the rim is a third of a module, whose elements are far smaller than those asked for.
THIN_RIM = Web(20.0, PINION.root_radius - 0.33 * PINION.module, 0.6)


@pytest.mark.parametrize(
    "web", [WEB, Web(15.0, 25.0, 0.3, offset=0.3), pytest.param(THIN_RIM, marks=pytest.mark.nightly)]
)
def test_expected_size_of_a_body_with_a_web(web):
    """The mesh itself: condensed unknowns exactly, all within 18 %."""
    found = body(web, reach=Reach(0)).timings
    size = expected_size(replace(PINION, web=web), FaceDiscretisation(2.0, 4, WIDTH, web=swept(web)))
    assert size.condensed == found["condensed_unknowns"]
    assert size.unknowns == pytest.approx(found["unknowns"], rel=0.18)


def test_layers_end_at_the_sides_of_a_web():
    """Definition: sides are boundaries, two layers or more are within, none is a needle beside it."""
    found = layers_with_web(layers_of_face(10, 30.0), -1.1, 3.1)
    assert {-1.1, 3.1, -15.0, 15.0} <= set(found) and 3.0 not in found and 0.0 in found
    assert layers_with_web(layers_of_face(3, 30.0), 1.0, 2.0).tolist() == [-15.0, -5.0, 1.0, 1.5, 2.0, 5.0, 15.0]


def moved(rim, width, thickness, order, radial, offset=0.0):
    """On average over the face, in the forces' direction, radial or along the axis."""
    direction = np.array([1.0, 0.0, 0.0] if radial else [0.0, 0.0, 1.0])
    heights, found = motion(rim, width, thickness, order, direction, offset)
    return slice_averages(heights, 2, np.zeros(1), np.array([width]))[0] @ found @ direction


def plate_edge(order, thickness, radius):
    """Forces (2, 2) on the edge of a thin plate, clamped at the bore, by its deflection and slope there: w = sum of
    c_i R_i(r) cos(order theta)."""
    stiff, nu = thickness**3 / (12.0 * (1.0 - POISSON**2)), POISSON
    # Powers of r, and whether times ln r.
    kinds = [(0, 0), (0, 1), (2, 0), (2, 1)] if order == 0 else [(1, 0), (-1, 0), (3, 0), (1, 1)]

    def derivative(kind, r, times):
        power, log = kind
        if times == 0:
            return r**power * (np.log(r) if log else 1.0)
        return power * derivative((power - 1, log), r, times - 1) + (
            derivative((power - 1, 0), r, times - 1) if log else 0
        )

    def row(r, *factors):
        return [sum(factor * derivative(kind, r, times) for times, factor in enumerate(factors)) for kind in kinds]

    n2, r = order**2, radius
    motions = np.array([row(BORE, 1.0), row(BORE, 0.0, 1.0), row(r, 1.0), row(r, 0.0, 1.0)])
    moment = np.array(row(r, -nu * n2 / r**2, nu / r, 1.0))
    kirchhoff = (1.0 - nu) * n2 / r**2
    shear = np.array(row(r, 2.0 * n2 / r**3 + kirchhoff / r, -(1.0 + n2) / r**2 - kirchhoff, 1.0 / r, 1.0))
    around = (2.0 if order == 0 else 1.0) * pi * r * stiff
    return around * np.array([-shear, moment]) @ np.linalg.inv(motions)[:, 2:]


@pytest.mark.parametrize("order", [0, 1])
def test_a_disk_under_an_axial_force_and_under_a_moment_at_its_rim(order):
    """Thin plates (Timoshenko and Woinowsky-Krieger, chapter 9), the rim a ring that bends and twists (Roark). Force
    along the axis (0); tilting moment (1)."""
    rim, width, thickness, depth = 56.0, 12.0, 1.0, 4.0
    middle = 0.5 * (rim + OUTER)
    bending, torsion = (
        depth * width**3 / 12.0,
        depth**3 * width / 3.0 * (1.0 - 0.63 * depth / width) / (2.0 + 2.0 * POISSON),
    )
    # By deflection and slope at the web's edge: what the ring is bent by.
    bent = np.array([-order / middle, 1.0 - order * (middle - rim) / middle])
    ring = (2.0 * bending if order == 0 else bending + torsion) * pi / middle * np.outer(bent, bent)
    arm = np.array([1.0, OUTER - rim])
    loads = SECTORS if order == 0 else 0.5 * SECTORS
    exact = loads * arm @ np.linalg.solve(plate_edge(order, thickness, rim) + ring, arm)
    assert moved(rim, width, thickness, order, radial=False) == pytest.approx(exact, rel=0.02)


def annuli(circles, widths, order, load):
    """Radial displacement of the outermost circle under a harmonic radial `load` (N/mm of arc), the innermost held:
    plane stress, exact in each annulus (Michell), u_r = sum of U r^s cos, u_t = sum of V r^s sin."""
    stiff, shear, n = 1.0 / (1.0 - POISSON**2), 0.5 / (1.0 + POISSON), order
    powers, columns = [n + 1, n - 1, 1 - n, -n - 1], []
    for s in powers:
        turn, grow = 0.5 * np.array([n, s + 1]), np.array([s + 1, n])
        equations = [stiff * (s - 1) * grow - 2 * shear * n * turn, -stiff * n * grow + 2 * shear * (s - 1) * turn]
        columns.append(np.linalg.svd(np.array(equations))[2][-1])

    def at(r, number):
        scaled = [(s, *(column * (r / circles[number + 1]) ** s)) for s, column in zip(powers, columns)]
        motion = np.array([[u, v] for _, u, v in scaled]).T
        tractions = [[stiff * (s * u + POISSON * (u + n * v)), shear * (-n * u + (s - 1) * v)] for s, u, v in scaled]
        return motion, widths[number] / r * np.array(tractions).T

    count, rows, right = len(widths), [], []
    rows.append(np.hstack([at(circles[0], 0)[0], np.zeros((2, 4 * count - 4))]))
    for joint in range(1, count):
        for inner, outer in zip(at(circles[joint], joint - 1), at(circles[joint], joint)):
            row = np.zeros((2, 4 * count))
            row[:, 4 * joint - 4 : 4 * joint], row[:, 4 * joint : 4 * joint + 4] = inner, -outer
            rows.append(row)
    motion, traction = at(circles[-1], count - 1)
    rows.append(np.hstack([np.zeros((2, 4 * count - 4)), traction]))
    right = np.zeros(4 * count)
    right[-2] = load
    return motion[0] @ np.linalg.solve(np.vstack(rows), right)[-4:]


@pytest.mark.nightly
@pytest.mark.parametrize("thickness", [5e-3, 1.0])
def test_a_ring_that_is_nearly_free_and_one_on_a_web_that_becomes_oval(thickness):
    """Plane stress, exact; a free ring's curved beam has q R^4/(9 E I) by a load q cos(2 theta).

    A web of 2 um ends in a typed error: the sector's stiffnesses then reach from 1e-13 to 5e3 N/mm, past all digits.
    """
    rim, width, load = 54.0, 4.0, SECTORS / (2.0 * pi * OUTER)
    middle = 0.5 * (rim + OUTER)
    beam = load * OUTER / middle * middle**4 / (9.0 * width * (OUTER - rim) ** 3 / 12.0)
    assert annuli([BORE, rim, OUTER], [1e-4, width], 2, load) == pytest.approx(beam, rel=0.05)
    # Two harmonics: what the rim gives way beside each sector's force is in both.
    exact = [annuli([BORE, rim, OUTER], [thickness, width], order, load) for order in (2, 4)]
    found = [moved(rim, width, thickness, order, radial=True) for order in (2, 4)]
    assert found[0] - found[1] == pytest.approx(exact[0] - exact[1], rel=0.01)


def resolved(rim, width, thickness, order, offset, size=0.5):
    """Heights (k,), and radial displacement (k,) of the outer circle under radial forces, by an assembly of its own."""
    web = Part(BORE, rim, offset - 0.5 * thickness, offset + 0.5 * thickness)
    body = Meridian([web, Part(rim, OUTER, -0.5 * width, 0.5 * width)], order, size)
    # Half the sectors' forces, since the mean of cos^2 is 1/2.
    found = body.solved(0.5 * SECTORS * body.even_over(OUTER, 0), body.nodes[:, 0] < BORE + 1e-9)
    outer = body.at_radius(OUTER)
    return body.nodes[outer, 1], found[3 * outer]


@pytest.mark.nightly
@pytest.mark.parametrize("offset", [0.0, 3.0])
def test_a_rim_on_a_web_against_a_resolved_model(offset):
    """Finite elements of a meridian section by harmonics: bending and tilting of the rim, 2 %."""
    rim, width, thickness, radial = 54.0, 12.0, 3.0, np.array([1.0, 0.0, 0.0])
    means, tilts = [], []
    for order in (1, 2, 4):
        fine, swept = (
            resolved(rim, width, thickness, order, offset),
            motion(rim, width, thickness, order, radial, offset),
        )
        over_face = slice_averages(swept[0], 2, np.zeros(1), np.array([width]))[0]
        means.append((simpson(len(fine[0])) @ fine[1], over_face @ swept[1][:, 0]))
        # By least squares, to all heights.
        tilts.append([np.polyfit(*each, 1)[0] for each in (fine, (swept[0], swept[1][:, 0]))])
    (one, own_one), (two, own_two), (four, own_four) = means
    assert own_one - own_four == pytest.approx(one - four, rel=0.02)
    assert own_two - own_four == pytest.approx(two - four, rel=0.02)
    if offset:
        for exact, found in tilts:
            assert found == pytest.approx(exact, rel=0.02)
