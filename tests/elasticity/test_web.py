"""Gears whose web is less wide than the face."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest
from tests.annulus import BORE, OUTER, annulus, forces
from tests.scene.test_cut_away import SCENE

from fenics_gears import SceneError, gear_pair, scene_from_text
from fenics_gears.elasticity.condensation import condense
from fenics_gears.elasticity.elements import ELEMENTS
from fenics_gears.geometry.gear_data import Web

POISSON = 0.3
SHEAR, LAME = 0.5 / (1.0 + POISSON), POISSON / ((1.0 + POISSON) * (1.0 - 2.0 * POISSON))
# Its ends are circles of the annulus' mesh, or lie within cells.
WEBS = {"between cells": Web(BORE * 2.0**0.25, BORE * 2.0**0.75, 0.3), "within cells": Web(18.3, 26.1, 0.3)}
# h/r = 0.065; a jump of the width within cells is seen to first order.
TOLERANCE = {"between cells": 0.065**2, "within cells": 0.02}


def ring_under(web, element, motion):
    """Forces (n, 2) on the outer circle, and its points, when its nodes move by a function of their points."""
    chosen = ELEMENTS[element]
    mesh = replace(annulus(chosen.corners), web=web)
    body = condense(mesh, chosen, POISSON, {part: mesh.edge_nodes(part, chosen.order) for part in ("rim", "hub")})
    outer = 0.5 * (BORE + OUTER)
    return forces(
        body, lambda points: np.where(np.linalg.norm(points, axis=1)[:, None] > outer, motion(points), 0.0)
    ), body.points["rim"]


@pytest.mark.parametrize("element", ["P2", "Q2", "Q1 incompatible"])
@pytest.mark.parametrize("name", WEBS)
def test_a_ring_of_three_widths_under_torque(name, element):
    """Exact: the rim turns by T/(4 pi G) of the sum of (1/r_i^2 - 1/r_o^2)/w."""
    web = WEBS[name]
    at = np.array([BORE, web.hub_radius, web.rim_radius, OUTER]) ** -2.0
    exact = 4.0 * pi * SHEAR / ((at[:-1] - at[1:]) / [1.0, web.share, 1.0]).sum()
    found, points = ring_under(web, element, lambda points: np.column_stack([-points[:, 1], points[:, 0]]))
    torque = (points[:, 0] * found[:, 1] - points[:, 1] * found[:, 0]).sum()
    assert torque == pytest.approx(exact, rel=TOLERANCE[name])


@pytest.mark.parametrize("element", ["P2", "Q2", "Q1 incompatible"])
@pytest.mark.parametrize("name", WEBS)
def test_a_ring_of_three_widths_that_grows(name, element):
    """Lame: u = A r + B/r in each ring, displacement and width times radial stress continuous."""
    web = WEBS[name]
    radii, widths = (BORE, web.hub_radius, web.rim_radius, OUTER), (1.0, web.share, 1.0)

    def moved(r):
        return np.array([r, 1.0 / r])

    def stress(r):
        return np.array([2.0 * (LAME + SHEAR), -2.0 * SHEAR / r**2])

    equations, right = np.zeros((6, 6)), np.zeros(6)
    equations[0, :2], equations[5, 4:], right[5] = moved(BORE), moved(OUTER), 1.0
    for inner in (0, 1):
        r, own, next_ = radii[inner + 1], slice(2 * inner, 2 * inner + 2), slice(2 * inner + 2, 2 * inner + 4)
        equations[1 + 2 * inner, own], equations[1 + 2 * inner, next_] = moved(r), -moved(r)
        equations[2 + 2 * inner, own], equations[2 + 2 * inner, next_] = (
            widths[inner] * stress(r),
            -widths[inner + 1] * stress(r),
        )
    exact = 2.0 * pi * OUTER * (stress(OUTER) @ np.linalg.solve(equations, right)[4:])
    found, points = ring_under(web, element, lambda points: points / np.linalg.norm(points, axis=1)[:, None])
    assert (found * points / np.linalg.norm(points, axis=1)[:, None]).sum() == pytest.approx(exact, rel=TOLERANCE[name])


OVER_FACE = '[gears.material]\nname = "steel"\n[misalignment]\nin_plane = "5 um"\n'
WEB = '[gears.pinion.web]\nrim_inner_diameter = "45 mm"\nwidth = "{}"\n'


def test_the_scene_says_the_web_in_lengths():
    """Definition: from the bore unless there is a hub; a share of the gear's own face width."""
    assert scene_from_text(SCENE.format(gears="", pinion=WEB.format("5 mm"))).gears.pinion.web == Web(10.0, 22.5, 0.25)
    with_hub = scene_from_text(
        SCENE.format(gears="", pinion='face_width = "25 mm"\n' + WEB.format("5 mm") + 'hub_diameter = "30 mm"')
    ).gears
    assert with_hub.pinion.web == Web(15.0, 22.5, 0.2) and with_hub.wheel.web is None


@pytest.mark.parametrize(
    ("scene", "said"),
    [
        (SCENE.format(gears="", pinion=WEB.format("21 mm")), "gears.pinion.web.width is 1.05 of the face width"),
        (
            SCENE.format(gears="", pinion=WEB.format("5 mm") + 'hub_diameter = "45 mm"'),
            "no web: gears.pinion.web.hub_diameter = 45 mm, rim_inner_diameter = 45 mm",
        ),
        (SCENE.format(gears="", pinion=WEB.format("5 mm").replace("45 mm", "52 mm")), "the rim may begin at 51.3 mm"),
        (SCENE.format(gears="", pinion=WEB.format("5 mm") + 'axial_offset = "1 mm"'), "gears.pinion.web.axial_offset"),
        (
            SCENE.format(gears="", pinion=WEB.format("5 mm") + 'axial_offset = "-8 mm"') + OVER_FACE,
            "gears.pinion.web.axial_offset is -0.4 of the face width, and the web is 0.25 of it wide",
        ),
    ],
)
def test_a_web_that_cannot_be_is_refused(scene, said):
    """Field, value and what is allowed, before anything is computed."""
    with pytest.raises(SceneError) as refused:
        gear_pair(scene_from_text(scene).gears)
    assert said in str(refused.value)
