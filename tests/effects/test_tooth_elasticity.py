"""Rigid flanks."""

from dataclasses import replace

import numpy as np
import pytest
from tests.coarse import rigid_pair

from fenics_gears import SceneError, scene_from_text, simulate
from fenics_gears.contact.rigid_step import SAME_GAP
from fenics_gears.effects.tip_relief import TipRelief
from fenics_gears.geometry.relief import Relief
from fenics_gears.model.modification import removals
from fenics_gears.scene.data import Accuracy, Motion

DEPTH = 0.031


@pytest.fixture(scope="module")
def rigid_scene(paper_scene):
    return replace(rigid_pair(paper_scene), accuracy=Accuracy(), motion=Motion(200.0, 1, 1))


def test_true_involutes_transmit_exactly(rigid_scene):
    """Exact: conjugate flanks have no transmission error."""
    result = simulate(rigid_scene)
    assert np.abs(result.transmission_error.values).max() <= 1e-12
    force = rigid_scene.load.wheel_torque / result.attrs["base_radius_wheel"]
    assert result.normal_force.values == pytest.approx(force, rel=1e-12)
    pairs = result.pair_normal_force.values
    undetermined = np.isnan(pairs).any(axis=1)
    # Two pairs are in mesh for the contact ratio's part above 1.
    assert undetermined.mean() == pytest.approx(0.46977, abs=0.01)
    assert pairs[~undetermined].sum(axis=1) == pytest.approx(force, rel=1e-12)
    assert "their shares of the force are not determined" in result.attrs["warnings"]


def test_relief_is_the_least_gap_of_the_pairs_on_the_line_of_action(rigid_scene, paper_pair):
    """Exact: the smallest sum of removals on the path of contact, but for what a step of the window gains (below 0.4
    um)."""
    scene = replace(rigid_scene, tip_relief=TipRelief(Relief(DEPTH, None), Relief(DEPTH, None)))
    result = simulate(scene)
    pinion, wheel = removals(scene, paper_pair)
    expected = []
    for phase in result.mesh_phase.values % 1.0:
        xi = paper_pair.path_start + (phase + np.arange(3)) * paper_pair.base_pitch
        xi = xi[xi <= paper_pair.path_end]
        removed = pinion(xi / paper_pair.pinion.base_radius) + wheel(
            (paper_pair.line_of_action_length - xi) / paper_pair.wheel.base_radius
        )
        expected.append(removed.min())
    error = result.transmission_error.values * paper_pair.wheel.base_radius
    assert np.abs(error - expected).max() <= 4e-4
    assert error.max() > 0.3 * DEPTH
    assert np.all(error <= np.array(expected) + SAME_GAP)


def test_friction_needs_elastic_teeth(paper_scene):
    """Not determined: refused in words; of a misspelt section nothing more is said."""
    text = (
        paper_scene.text.replace("[gears.material]\n", "")
        .replace('youngs_modulus = "206 GPa"\n', "")
        .replace("poissons_ratio = 0.3\n", "")
    )
    with pytest.raises(SceneError, match=r"\[friction\]\n    needs the section \[gears.material\], which is missing"):
        scene_from_text(text)
    with pytest.raises(SceneError) as refused:
        scene_from_text(text.replace("[friction]", "[fricton]"))
    assert 'Did you mean "friction"' in str(refused.value) and "needs the section" not in str(refused.value)


def test_rigid_gears_accelerate_as_their_errors_say(rigid_scene, paper_scene):
    """Newton's law: the mesh force is (T + J phi2'')/rb2, by backward Euler's own second difference."""
    slow = Motion(20.0, 3, 1)
    scene = replace(
        rigid_scene,
        inertia=paper_scene.inertia,
        motion=slow,
        tip_relief=TipRelief(Relief(DEPTH, None), Relief(DEPTH, None)),
    )
    scene = replace(scene, accuracy=Accuracy(steps_per_mesh_cycle=100))
    result = simulate(scene)
    radius, step = result.attrs["base_radius_wheel"], float(result.time[1] - result.time[0])
    turned = result.rotation.sel(gear="wheel").values
    assert turned == pytest.approx(simulate(replace(scene, inertia=None)).transmission_error.values, abs=1e-12)
    acceleration = (turned[2:] - 2.0 * turned[1:-1] + turned[:-2]) / step**2
    expected = (scene.load.wheel_torque - scene.inertia.moment_of_inertia * acceleration) / radius
    forces = result.normal_force.values[2:]
    assert np.all(forces > 0.0)
    assert forces == pytest.approx(expected, rel=1e-6)
