"""A helical pair with finite element bodies from scene to result: statics without friction on rigid shafts."""

from math import radians, tan

import numpy as np
import pytest
from tests.benchmarks.third_dimension.pairs import MODULE, scene_of, standard_pair

from fenics_gears import simulate
from fenics_gears.scene.data import Accuracy

HELIX_ANGLE = radians(20.0)
COARSE = Accuracy(
    element="P1",
    flank_element_size=0.3,
    contact_nodes=12,
    steps_per_mesh_cycle=6,
    slices=5,
    layers=2,
    body_element_size=3.0,
)


@pytest.fixture(scope="module")
def scene():
    """A narrow pair, coarsely."""
    return scene_of(standard_pair(3.0 * MODULE, HELIX_ANGLE, bore=0.8), COARSE)


@pytest.fixture(scope="module")
def result(scene):
    """Its run."""
    return simulate(scene)


def test_torques_are_as_the_numbers_of_teeth(scene, result):
    """Exact: without friction every contact force has the base radius as its lever arm on either gear."""
    pinion, wheel = np.abs(result.reaction_couple.values.T)
    teeth = scene.gears.pinion.teeth / scene.gears.wheel.teeth
    np.testing.assert_allclose(pinion / wheel, teeth, rtol=1e-12)
    np.testing.assert_allclose(wheel, scene.load.wheel_torque, rtol=1e-9)


def test_axial_force_is_the_tangential_one_times_the_tangent_of_the_helix(scene, result):
    """Exact: F_a = F_t tan(beta) with F_t at the reference cylinder, opposite on the two gears."""
    radius = 0.5 * scene.gears.wheel.teeth * MODULE / np.cos(HELIX_ANGLE)
    pinion, wheel = result.reaction_z.values.T
    np.testing.assert_allclose(pinion, -wheel, rtol=1e-12)
    np.testing.assert_allclose(np.abs(wheel), scene.load.wheel_torque / radius * tan(HELIX_ANGLE), rtol=1e-9)


def test_line_load_adds_up_to_the_normal_force(result):
    """Identity: the line loads of all pairs over all slices are the force along the contact normal."""
    of_slices = (result.line_load * result.face_slice_width).sum(("slot", "face_position")).values
    np.testing.assert_allclose(
        of_slices, result.normal_force.sel(time=result.contact_time.values, method="nearest").values, rtol=1e-12
    )
