"""Row 3: what one gear does to the other comes back: forces and moments of the pair, and of each gear with its
shaft."""

from dataclasses import replace

import numpy as np
import pytest
from tests.coarse import coarse_scene, frictionless, quasi_static

from fenics_gears.effects.coast_flanks import CoastFlanks
from fenics_gears.geometry.pair import gear_pair
from fenics_gears.scene.data import Motion
from fenics_gears.simulation.simulate import simulate

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


def test_contact_forces_sum_to_nothing(case, measured):
    """Newton's third law: forces on either gear are opposite, and so are their moments about one point, here the
    pinion's centre."""
    name, scene, result = case
    pair = gear_pair(scene.gears)
    centre = (pair.line_of_action_length, -(pair.pinion.base_radius + pair.wheel.base_radius))
    (x_1, x_2), (y_1, y_2), (c_1, c_2) = (
        result[f"reaction_{part}"].transpose("gear", "time").values for part in ("x", "y", "couple")
    )
    size = np.hypot(x_1, y_1).max()
    forces = max(np.abs(x_1 + x_2).max(), np.abs(y_1 + y_2).max()) / size
    moments = np.abs(c_1 + c_2 + centre[0] * y_2 - centre[1] * x_2).max() / (size * pair.centre_distance)
    measured(f"{name}: sum of forces, sum of moments", f"{forces:.1g}, {moments:.1g}", "1e-12")
    assert forces <= 1e-12
    assert moments <= 1e-12


@pytest.mark.parametrize("case", [name for name in SCENES if "Hz" not in name], indirect=True)
def test_reactions_are_what_the_springs_and_the_load_hold(case, measured):
    """Equilibrium of each gear without inertia: bearings hold the force, the input shaft and the load the couples."""
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
    measured(f"{name}: difference of the reactions from springs and load", max(held), "1e-12")
    assert max(held) <= 1e-12


@pytest.mark.parametrize("frequency", [None, 200.0, 2000.0])
def test_couples_are_as_the_base_radii_without_friction(frequency, paper_scene, measured):
    """Exact (involute): T1/rb1 = T2/rb2 at every step, in motion too, for it is the contact's, not the shafts'."""
    scene = frictionless(coarse_scene(paper_scene))
    scene = quasi_static(scene) if frequency is None else replace(scene, motion=Motion(frequency, 2, 1))
    pair, result = gear_pair(scene.gears), simulate(scene)
    by_radius = result.reaction_couple.values / np.array([pair.pinion.base_radius, pair.wheel.base_radius])
    difference = np.abs(by_radius[:, 0] - by_radius[:, 1]).max() / np.abs(by_radius).max()
    measured(
        f"difference of T1/rb1 and T2/rb2, {'quasi-static' if frequency is None else f'{frequency:g} Hz'}",
        difference,
        "1e-12",
    )
    assert difference <= 1e-12
