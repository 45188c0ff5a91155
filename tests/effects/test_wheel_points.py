"""``[wheel_points]``: a ring on bolts in a run, and what cannot stand beside it."""

from math import pi

import numpy as np
import pytest
from tests.internal import COARSE as COARSE_FLANKS
from tests.internal import internal_scene, moving

from fenics_gears import GearsError, model_of, scene_from_text, simulate

COARSE = f'{COARSE_FLANKS}body_element_size = "3 mm"\n'
STIFF = 'radial_stiffness = "2e5 N/mm"\ntangential_stiffness = "1e5 N/mm"'
LONG = "\n[motion]\nmesh_cycles = 4\n"
TWO = LONG.replace("4", "2")


def points_scene(points: str = "count = 6", more: str = COARSE + LONG, springs: str = STIFF) -> str:
    text = internal_scene(more=more).replace(', support = "held"', "")
    return f"{text}\n[wheel_points]\n{points}\n{springs}\n"


def test_bolts_carry_the_torque_and_teeth_beside_them_are_stiffer():
    """Equilibrium: tangential forces on the outer circle hold the wheel's torque at every step, within what the
    coarse flank's nodes move its contact forces. With bolts the mesh cycles differ."""
    run = simulate(scene_from_text(points_scene()))
    torque = 140.0 * run.wheel_support_tangential.sum("support").values
    assert np.abs(np.abs(torque) / (500e3 * 61 / 22) - 1.0).max() < 3e-3
    cycles = run.transmission_error.values[1:].reshape(4, -1)
    assert np.ptp(cycles.mean(axis=0) - cycles) > 1e-3 * np.abs(cycles).max()
    assert run.wheel_support_radial.dims == ("time", "support") and run.sizes["support"] == 6


def test_bolts_on_every_tooth_are_a_foundation():
    """Limit: transmission error of a ring on 61 bolts and on a foundation of the same stiffness per length."""
    text = points_scene("count = 61", COARSE + TWO)
    per_area = 61 / (2.0 * pi * 140.0 * 50.0)
    springs = (
        f', support = {{ kind = "foundation", radial_stiffness = "{2e5 * per_area} N/mm^3",'
        f' tangential_stiffness = "{1e5 * per_area} N/mm^3" }}'
    )
    on_bolts = simulate(scene_from_text(text)).transmission_error.values
    even = simulate(scene_from_text(internal_scene(wheel=springs, more=COARSE + TWO))).transmission_error.values
    assert np.abs(on_bolts - even).max() < 0.01 * np.abs(even).max()


def test_what_bolts_store_is_in_the_account_of_energy():
    """Energy balance of a run in time with friction: its defect is round-off of the work done."""
    run = simulate(scene_from_text(points_scene(more=COARSE + moving(2))))
    assert np.abs(run.energy_defect.values).max() < 1e-9 * np.abs(run.work_input.values).max()


@pytest.mark.parametrize(
    "points, more, words",
    [
        ("", "", "wheel_points.count\n    is missing"),
        ("count = 1", "", "from 2 up to 200|from 2 to 200"),
        ('angles = ["10 deg"]', "", "a list of quantities"),
        ('angles = ["10 deg", "90 deg", "-270 deg"]', "", "has a point twice"),
        ('count = 6\nangles = ["10 deg", "90 deg"]', "", "angles"),
        ("count = 6", "[coast_flanks]\n", r"cannot be combined with \[coast_flanks\]"),
        ("count = 6", "[output]\nroot_stress = true\n", "knows equal teeth only"),
    ],
)
def test_what_cannot_be_is_refused_in_words(points, more, words):
    """A user's expectation: the message says what is allowed; nothing is computed."""
    with pytest.raises(GearsError, match=words):
        model_of(scene_from_text(points_scene(points, COARSE + more)))
    with pytest.raises(GearsError, match="above|from 1 N/mm"):
        scene_from_text(points_scene(springs=STIFF.replace("2e5", "0")))


def test_another_support_is_refused_and_points_are_one():
    """A thin rim whose support is not given is refused (docs/scene.md); points are a support."""
    with pytest.raises(GearsError, match="says what holds the wheel"):
        scene_from_text(internal_scene() + f"\n[wheel_points]\ncount = 6\n{STIFF}\n")
    assert not any("thin rim" in each for each in model_of(scene_from_text(points_scene())).warnings)
