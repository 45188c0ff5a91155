"""Row 3: what one gear does to the other comes back."""

from dataclasses import replace

import numpy as np
import pytest
from tests.coarse import coarse_scene, frictionless, quasi_static

from fenics_gears import simulate
from fenics_gears.effects.coast_flanks import CoastFlanks

SCENES = {
    "quasi-static, friction": quasi_static,
    "quasi-static, frictionless": lambda scene: frictionless(quasi_static(scene)),
    "200 Hz, friction": lambda scene: scene,
    "coast flanks, friction": lambda scene: replace(
        quasi_static(scene), coast_flanks=CoastFlanks(), load=replace(scene.load, wheel_torque=-scene.load.wheel_torque)
    ),
    "friction 0.5": lambda scene: replace(quasi_static(scene), friction=replace(scene.friction, coefficient=0.5)),
}


@pytest.fixture(scope="module", params=SCENES)
def case(request, paper_scene):
    """Name of a scene, the scene and its result."""
    scene = SCENES[request.param](coarse_scene(paper_scene, cycles=2))
    return request.param, scene, simulate(scene)


@pytest.mark.parametrize("case", [name for name in SCENES if "Hz" not in name], indirect=True)
def test_reactions_are_what_the_springs_and_the_load_hold(case, measured):
    """Equilibrium of each gear without inertia."""
    name, scene, result = case
    size = np.hypot(result.reaction_x, result.reaction_y).max().item()
    held = [
        np.abs(scene.bearings.stiffness * result[f"centre_{axis}"] - result[f"reaction_{axis}"]).max().item() / size
        for axis in ("x", "y")
    ]
    torque = abs(scene.load.wheel_torque)
    couple = result.reaction_couple
    held.append(np.abs(couple.sel(gear="wheel") + scene.load.wheel_torque).max().item() / torque)
    twist = scene.shafts.torsional_stiffness * result.rotation.sel(gear="pinion")
    held.append(np.abs(twist - couple.sel(gear="pinion")).max().item() / torque)
    measured(f"{name}: difference of the reactions from springs and load", max(held), 1e-12)
