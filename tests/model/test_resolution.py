"""Accuracy that follows from the scene."""

from dataclasses import replace
from math import pi, sqrt

import numpy as np
import pytest

from fenics_gears import mesh_stiffness, model_of
from fenics_gears.dynamics.frequencies import natural_frequencies, vibrations
from fenics_gears.model.drivetrain import drivetrain
from fenics_gears.model.resolution import (
    COARSEST_ELEMENT,
    FINEST_ELEMENT,
    MOST_STEPS_PER_MESH_CYCLE,
    hertz_half_width,
    resolve,
)
from fenics_gears.scene.data import Accuracy


def of_scene(scene, **accuracy):
    return model_of(replace(scene, accuracy=Accuracy(**accuracy))).resolution


def test_values_of_the_scene_are_used_as_they_are(paper_scene):
    """The paper's own."""
    resolution = model_of(paper_scene).resolution
    assert (resolution.element, resolution.flank_element_size) == ("P2", 0.08)
    assert (resolution.contact_grid.length, resolution.contact_grid.nodes) == (1.5, 20)
    assert resolution.steps_per_mesh_cycle == 100


def test_half_width_of_a_textbook_contact():
    """Johnson 1985, ch. 4: b = sqrt(4 F' R/(pi E*)) = 0.1060 mm for R = 10 mm, 100 N/mm."""
    assert hertz_half_width(100.0, 10.0, 0.5 * 206e3 / 0.91) == pytest.approx(0.10606, rel=1e-3)


@pytest.mark.parametrize("torque, part", [(0.0, FINEST_ELEMENT), (437e7, COARSEST_ELEMENT)])
def test_elements_stay_reasonable_whatever_the_load(paper_scene, torque, part):
    """Without half-width, or with one of teeth."""
    scene = replace(paper_scene, load=replace(paper_scene.load, wheel_torque=torque))
    assert of_scene(scene).flank_element_size == pytest.approx(part * 4.5)


def test_narrow_contact_has_two_elements_in_its_half_width_or_a_warning(paper_scene):
    """Definition, as the load falls: three elements in the half-width, a 200th of the module, two in the half-width, a
    400th of the module with a warning that names a value that resolves it; over the face the warning comes from a 200th
    on. Hertz (docs/evidence/accuracy.md): with two the peak pressure is 5 % off, with one a fifth."""
    sizes, over_face = [], Accuracy(slices=10, layers=4)
    for torque in np.geomspace(1e2, 1e6, 60):
        scene = replace(paper_scene, load=replace(paper_scene.load, wheel_torque=torque), accuracy=Accuracy())
        model = model_of(scene)
        size, half_width = model.resolution.flank_element_size, model.resolution.half_width
        sizes.append(size)
        warned = [said for said in model.warnings if "half the Hertz" in said or "not resolved" in said]
        assert bool([said for said in warned if "flank_element_size" in said]) == (size > 0.5 * 1.01 * half_width)
        assert size == pytest.approx(max(min(max(half_width / 3, 4.5 / 200), half_width / 2), 4.5 / 400), rel=1e-12)
        named = [float(said.split('flank_element_size = "')[1].split()[0]) for said in warned if 'size = "' in said]
        assert all(each == pytest.approx(half_width / 2, rel=0.05) for each in named)
        coarse = model_of(replace(scene, accuracy=over_face))
        if coarse.resolution.flank_element_size > 0.51 * half_width:
            assert any(f"Hertz half-width of {half_width:.3g} mm" in said for said in coarse.warnings)
    assert min(sizes) == 4.5 / 400 and sizes == sorted(sizes)


def test_steps_follow_the_highest_frequency(paper_scene, paper_pair):
    """Twenty steps a period of the highest mode, within bounds; the mesh cycle alone without inertia."""
    shafts = drivetrain(paper_scene, paper_pair)
    highest = natural_frequencies(shafts, mesh_stiffness(paper_scene))[-1]
    scene = replace(paper_scene, motion=replace(paper_scene.motion, mesh_frequency=100.0), accuracy=Accuracy())
    assert resolve(scene, paper_pair, shafts, (None, None)).steps_per_mesh_cycle == pytest.approx(
        20.0 * highest / 100.0, abs=1.0
    )
    slow = replace(scene, motion=replace(scene.motion, mesh_frequency=0.01))
    assert resolve(slow, paper_pair, shafts, (None, None)).steps_per_mesh_cycle == MOST_STEPS_PER_MESH_CYCLE
    static = replace(scene, inertia=None, damping=None)
    assert model_of(static).resolution.steps_per_mesh_cycle == 200


def test_damping_ratios_and_what_the_mesh_excites(paper_scene, paper_pair):
    """Exact: (alpha w + beta/w)/2; without friction nothing moves off the line of action."""
    for friction in (False, True):
        modes = vibrations(drivetrain(paper_scene, paper_pair), mesh_stiffness(paper_scene), friction)
        omega = sqrt(0.155e6 / 4.9e-3)
        across = [mode for mode in modes if mode.frequency == pytest.approx(omega / (2.0 * pi), rel=1e-9)]
        assert [mode.damping_ratio for mode in across] == pytest.approx(
            3 * [0.5 * (0.4e-3 * omega + 0.5e-3 / omega)], rel=1e-9
        )
        assert any(mode.excited for mode in across) == friction
        assert sum(mode.excited for mode in modes) >= 4


def test_steps_too_few_to_see_the_transmission_error_are_named(paper_scene):
    """Measured: of 200 steps' peak-to-peak value 20 see 99 %, 10 as little as 95 %, 4 as little as half."""
    few, enough = (
        model_of(
            replace(paper_scene, accuracy=Accuracy(steps_per_mesh_cycle=steps), inertia=None, damping=None)
        ).warnings
        for steps in (19, 20)
    )
    assert any("steps_per_mesh_cycle is 19" in warning for warning in few)
    assert not any("steps_per_mesh_cycle" in warning for warning in enough)
