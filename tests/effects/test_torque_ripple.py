"""``[torque_ripple]``."""

from dataclasses import replace

import numpy as np
import pytest
from tests.coarse import COARSE, frictionless, quasi_static
from tests.paper_text import PAPER as DEMO

from fenics_gears import SceneError, scene_from_text, simulate
from fenics_gears.dynamics.torque_ripple import Harmonic, TorqueRipple
from fenics_gears.scene.data import Motion

ORDER = 24.0  # of the wheel's turn: once a mesh cycle
RIPPLE = TorqueRipple((Harmonic(ORDER, 30e3, 0.4), Harmonic(2.5, 10e3)))


def coarse(scene, cycles=2):
    return replace(scene, accuracy=COARSE, motion=Motion(200.0, cycles, cycles))


def expected_couple(result, ripple, torque=437e3, teeth=24):
    turned = 2.0 * np.pi * result.mesh_phase.values / teeth
    return torque + sum(each.amplitude * np.cos(each.order * turned + each.phase) for each in ripple.harmonics)


@pytest.mark.parametrize(
    ("harmonics", "said"),
    [
        ("[]", "is empty"),
        ('"20 N m"', "is not a list"),
        ("[3]", "is no table"),
        ('[{ amplitude = "20 N m" }]', "has no order at place 1"),
        ('[{ order = 1, amplitude = "20 N m" }, { order = 0, amplitude = "20 N m" }]', "order = 0 at place 2"),
        ('[{ order = 1, amplitud = "20 N m" }]', 'Did you mean "amplitude"?'),
        (
            '[{ order = 1, amplitude = "400 N m" }, { order = 2, amplitude = "40 N m" }]',
            "440 N m together, more than load.wheel_torque",
        ),
    ],
)
def test_a_wrong_section_is_refused(harmonics, said):
    """House rule 7."""
    with pytest.raises(SceneError) as refused:
        scene_from_text(DEMO + f"[torque_ripple]\nharmonics = {harmonics}\n")
    assert said in str(refused.value) and "Allowed: " in str(refused.value)


def test_quasi_static_transmission_error_follows_the_couple(paper_scene):
    """Exact: without friction and inertia the error at a step is that under its constant couple."""
    scene = coarse(frictionless(quasi_static(paper_scene)), cycles=1)
    result = simulate(replace(scene, torque_ripple=RIPPLE))
    couples = expected_couple(result, RIPPLE)
    assert result.wheel_couple.values == pytest.approx(couples, rel=1e-14)
    for step in (0, 13, 29):
        constant = simulate(replace(scene, load=replace(scene.load, wheel_torque=float(couples[step]))))
        assert result.transmission_error.values[step] == pytest.approx(
            constant.transmission_error.values[step], rel=1e-10
        )
        assert result.normal_force.values[step] == pytest.approx(
            couples[step] / result.attrs["base_radius_wheel"], rel=1e-10
        )


def test_a_ripple_far_above_all_vibrations_is_not_felt(paper_scene):
    """Known limit: at 20 kHz the gears stay at their mean position."""
    scene = replace(frictionless(coarse(paper_scene)), motion=Motion(20e3, 30, 2))
    ripple = TorqueRipple((Harmonic(24.0, 200e3),))
    off, on = (simulate(replace(scene, torque_ripple=each)) for each in (None, ripple))
    static = simulate(quasi_static(coarse(frictionless(paper_scene))))
    assert on.attrs["mean_transmission_error"] == pytest.approx(off.attrs["mean_transmission_error"], rel=2e-3)
    assert on.attrs["peak_to_peak_transmission_error"] < 0.05 * static.attrs["peak_to_peak_transmission_error"]
    assert "lose contact" not in on.attrs["warnings"]
