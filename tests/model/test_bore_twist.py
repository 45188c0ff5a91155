"""How much of the mesh's stiffness is twist of the bodies on their bores."""

from dataclasses import replace
from math import inf, pi

import numpy as np
import pytest
from tests.coarse import coarse_scene, frictionless, teeth_alone

from fenics_gears import model_of, simulate
from fenics_gears.dynamics.damping import Damping
from fenics_gears.geometry.gear_data import Web
from fenics_gears.model.description import describe
from fenics_gears.model.drivetrain import bore_twist_stiffness, mesh_stiffness
from fenics_gears.results.summary import summary_rows
from fenics_gears.scene.data import Accuracy


def with_bores(scene, share):
    """Bores of a share of the root diameter."""
    gears = scene.gears
    bored = {
        name: replace(getattr(gears, name), bore_diameter=share * getattr(gears, name).root_diameter)
        for name in ("pinion", "wheel")
    }
    return replace(scene, gears=replace(gears, **bored))


def test_bores_change_the_mesh_stiffness_by_the_twist_of_a_disc(paper_scene):
    """Closed form of a sheared disc, against finite elements with teeth: flexibilities with bores of a quarter and of
    half the root diameter differ by it, to 15 %, since teeth stand on the disc; the summary tells a notable share."""
    scene = frictionless(teeth_alone(coarse_scene(paper_scene, cycles=1)))
    found = []
    for share in (0.15, 0.5):
        bored = with_bores(scene, share)
        result = simulate(bored)
        pair = model_of(bored).pair
        assert result.attrs["bore_twist_stiffness"] == pytest.approx(
            1e-3 * bore_twist_stiffness(bored, pair) / pair.face_width, rel=1e-12
        )
        found.append((1.0 / result.attrs["mean_mesh_stiffness_tangent"], 1.0 / result.attrs["bore_twist_stiffness"]))
        told = any(label == "twist of the bodies on their bores" for label, _, _ in summary_rows(result))
        assert told == (found[-1][1] / found[-1][0] >= 0.25)
        one = 1e-3 * mesh_stiffness(bored, pair) / pair.face_width
        assert one == pytest.approx(result.attrs["single_pair_stiffness"], rel=0.1)
    (small, of_small), (large, of_large) = found
    assert small - large == pytest.approx(of_small - of_large, rel=0.15)


def test_a_web_twists_more_by_what_it_is_thinner(paper_scene):
    """The integral of dr/(b r^3), by numbers; rigid gears and those with a body of their own have no such twist."""
    scene = paper_scene
    pair = model_of(scene).pair
    webbed = replace(pair, pinion=replace(pair.pinion, web=Web(20.0, 27.0, 0.25)))
    springs = []
    for each in (pair, webbed):
        flexibility = 0.0
        for gear, material in zip((each.pinion, each.wheel), scene.gears.materials):
            edges = np.linspace(gear.bore_radius, gear.root_radius, 200_001)
            r = 0.5 * (edges[1:] + edges[:-1])
            thin = (r > gear.web.hub_radius) & (r < gear.web.rim_radius) if gear.web else np.zeros(len(r), dtype=bool)
            shear = material.youngs_modulus / (2.0 + 2.0 * material.poissons_ratio)
            integral = np.sum(np.diff(edges) / (np.where(thin, 0.25, 1.0) * each.face_width * r**3))
            flexibility += gear.base_radius**2 * integral / (2.0 * pi * shear)
        springs.append(1.0 / flexibility)
        assert bore_twist_stiffness(scene, each) == pytest.approx(springs[-1], rel=1e-4)
    assert springs[1] < springs[0]
    rigid = replace(scene, accuracy=replace(scene.accuracy, model="rigid teeth"))
    assert bore_twist_stiffness(rigid, pair) == inf


def test_modes_that_are_printed_have_the_ratios_of_the_scene(paper_scene):
    """Definition: the modes of both are those of one stiffness; 0.062 was printed where the scene has 0.05."""
    scene = with_bores(replace(paper_scene, damping=Damping(ratios=(0.05,))), 0.3)
    ratios = [mode.damping_ratio for mode in model_of(scene).vibrations]
    assert len(ratios) > 5 and ratios == pytest.approx(len(ratios) * [0.05], rel=1e-8)


def test_pairs_by_iso_6336_are_as_stiff_as_is_told(paper_scene):
    """Identity: one pair of such a run has the stiffness that `check` prints, where it was 14 N/(mm um)."""
    scene = frictionless(teeth_alone(coarse_scene(paper_scene, cycles=1)))
    scene = replace(scene, accuracy=Accuracy(model="ISO 6336-1", steps_per_mesh_cycle=20))
    model, result = model_of(scene), simulate(scene)
    told = 1e-3 * mesh_stiffness(scene) / model.pair.face_width
    assert result.attrs["single_pair_stiffness"] == pytest.approx(told, rel=1e-9)
    rows = dict(describe(scene))["Model"]
    assert ("stiffness of one tooth pair", f"{told:.3g}", "N/(mm um), about") in rows
