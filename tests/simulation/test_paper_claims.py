"""Claims 1-4 of the paper (model.md section 6)."""

from dataclasses import replace

import numpy as np
import pytest

from fenics_gears import simulate
from fenics_gears.scene.data import Motion


@pytest.fixture(scope="module")
def static(paper_scene):
    """The quasi-static runs of Figs. 2 and 4, with friction and without."""
    scene = replace(paper_scene, inertia=None, damping=None, motion=Motion(200.0, 3, 2))
    return {"friction": simulate(scene), "plain": simulate(replace(scene, friction=None))}


def phase(result):
    return result.mesh_phase.values % 1.0


def single_contact(result):
    """Steps at which one tooth pair carries."""
    return (result.pair_normal_force.values > 0.0).sum(axis=1) == 1


def test_claim_1_without_friction_nothing_moves_off_the_line_of_action(static):
    """Fig. 2: exactly zero."""
    assert np.all(static["plain"].centre_y.values == 0.0)
    assert np.abs(static["friction"].centre_y.values).max() > 5e-3


def test_claim_2_displacement_is_small_with_two_pairs_and_jumps_with_one(static, paper_scene):
    """Figs. 2, 3: with one pair +-mu F/k_b, its sign changing at the pitch point."""
    result = static["friction"]
    wheel = result.centre_y.sel(gear="wheel").values
    full = paper_scene.friction.coefficient * result.normal_force.values / paper_scene.bearings.stiffness
    begin = phase(result) < 0.4
    assert np.abs(wheel[begin]).max() < 0.2 * full.max()
    alone = single_contact(result)
    before, after = alone & (phase(result) < 0.70), alone & (phase(result) > 0.85)
    assert wheel[before] == pytest.approx(-full[before], rel=1e-6)
    assert wheel[after] == pytest.approx(full[after], rel=1e-6)


def test_claim_3_friction_changes_the_static_error_suddenly_at_the_end_of_the_cycle(static):
    """Fig. 2: many times what it does without friction."""
    fall = {}
    for name, result in static.items():
        error = result.transmission_error.values
        window = (phase(result) > 0.72) & (phase(result) < 0.85)
        fall[name] = np.ptp(error[window & (result.mesh_phase.values < 2.0)])
    mean_elastic = np.ptp(static["plain"].transmission_error.values)
    assert fall["friction"] > 0.5 * mean_elastic
    assert fall["plain"] < 0.05 * mean_elastic


def test_claim_4_friction_makes_reactions_and_input_couple_vary_at_constant_output(static, paper_scene):
    """Fig. 4: R_x1, R_y1 and C_z1 vary by several per cent with friction, constant without."""
    for name, varies in (("friction", True), ("plain", False)):
        result = static[name]
        pinion, wheel = result.sel(gear="pinion"), result.sel(gear="wheel")
        assert wheel.reaction_couple.values == pytest.approx(-paper_scene.load.wheel_torque, rel=1e-9)
        for variable in (pinion.reaction_x, pinion.reaction_couple):
            spread = np.ptp(variable.values) / np.abs(variable.values).mean()
            assert spread > 0.03 if varies else spread < 1e-12
    assert np.ptp(static["friction"].reaction_y.sel(gear="pinion").values) > 1.5 * 0.1 * 8400.0
