"""The signs that docs/result.md tells of."""

import numpy as np
import pytest
from tests.coarse import coarse_scene, frictionless, teeth_alone

from fenics_gears import model_of, simulate


def test_signs_of_forces_torques_and_rotations(paper_scene):
    """Statics: F = T/rb2; action and reaction on both shafts."""
    scene = frictionless(teeth_alone(coarse_scene(paper_scene, cycles=1)))
    result, pair = simulate(scene), model_of(scene).pair
    force = scene.load.wheel_torque / pair.wheel.base_radius
    last = result.isel(time=-1)
    assert float(last.normal_force) == pytest.approx(force, rel=1e-9)
    assert last.reaction_x.values == pytest.approx([-force, force], rel=1e-9)
    assert last.reaction_couple.values == pytest.approx(
        [-force * pair.pinion.base_radius, -scene.load.wheel_torque], rel=1e-9
    )
    assert float(last.rotation.sel(gear="wheel")) > 0.0 and float(last.transmission_error) > 0.0
    assert np.all(np.diff(result.work_input.values) > 0.0) and np.all(np.diff(result.work_output.values) > 0.0)
