"""Scenes with an internal gear: what a user may write, and what is refused in words before any computation."""

from dataclasses import replace

import pytest
from tests.internal import internal_scene

from fenics_gears import GearsError, gear_pair, model_of
from fenics_gears.geometry.gear_data import RingSupport
from fenics_gears.scene.read import scene_from_text
from fenics_gears.scene.write import text_of

FOUNDATION = 'support = { kind = "foundation", radial_stiffness = "500 N/mm^3", tangential_stiffness = "200 N/mm^3" }'

SHAFT = """
[shafts.output]
gear_at = "50 mm"
torque_at = "100 mm"
sections = [{ length = "100 mm", diameter = "40 mm" }]
[[bearings.wheel]]
at = "10 mm"
radial_stiffness = "100 kN/mm"
"""


def scene_of(**changes):
    return scene_from_text(internal_scene(**changes))


def test_negative_teeth_and_internal_are_the_same():
    """ISO 21771 writes z2 < 0; others say internal, with either sign."""
    text = internal_scene()
    for written in ("teeth = 61, internal = true", "teeth = -61, internal = true"):
        other = scene_from_text(text.replace("teeth = -61", written))
        assert other.gears == scene_from_text(text).gears
    assert scene_from_text(text).gears.wheel.teeth == -61


@pytest.mark.parametrize("wheel", ["", f", {FOUNDATION}", ', profile_shift = 0.1, tooth_thickness = "6.5 mm"'])
def test_a_scene_written_from_its_data_is_the_same(wheel):
    """Round trip: the text of a scene's data, without what was written, gives the same data bit for bit."""
    text = internal_scene(wheel=wheel)
    text = text.replace("profile_shift = 0, outer", "outer") if "profile_shift" in wheel else text
    scene = scene_from_text(text)
    again = scene_from_text(text_of(replace(scene, written="")))
    assert again.gears == scene.gears and again.load.wheel_torque == scene.load.wheel_torque
    if FOUNDATION in wheel:
        assert again.gears.wheel.support == RingSupport("foundation", 500.0, 200.0)


def test_what_a_drawing_leaves_out_gives_a_pair_that_runs():
    """Centre distance and diameters of ISO 21771, the root by the cutter, and a tip that clears the pinion's fillet."""
    scene = scene_of()
    pair = gear_pair(scene.gears)
    assert scene.gears.centre_distance == pytest.approx(-78.0)
    assert scene.gears.wheel.root_diameter == pytest.approx(-254.0)
    start = pair.pinion.base_radius * pair.pinion.form_roll_angle
    assert pair.path_start == pytest.approx(start + 0.4, abs=1e-9)
    # By the torque's power, not by its sign.
    assert scene.load.wheel_torque == pytest.approx(500e3 * 61 / 22)


@pytest.mark.parametrize(
    "was, now, words",
    [
        ("pinion = { teeth = 22", "pinion = { teeth = -22", "Call the internal gear the wheel"),
        ('outer_diameter = "280 mm", ', "", "outer_diameter"),
        ("teeth = -61,", 'teeth = -61, bore_diameter = "70 mm",', "no meaning for an internal"),
        ("pinion = { teeth = 22", "pinion = { teeth = 22, cutter = { teeth = 20 }", "no meaning for an external gear"),
        ("[load]", SHAFT + "[load]", "shafts.output.sections"),
        ("[load]", '[corner_contact]\nedge_radius = "20 um"\n[load]', "not computed with an internal gear"),
        ("[accuracy]", '[accuracy]\ncondensation = "every step"', "not computed with an internal gear"),
        ('support = "held"', 'support = "foundation"', "radial_stiffness"),
        ('support = "held"', 'support = "points"', '"held", "foundation"'),
        ("teeth = -61,", 'teeth = -61, base_tangent_length = "30 mm",', "not computed for an internal gear"),
        ("teeth = -61,", "teeth = 61, ring_gear = true,", "negative number of teeth"),
        ("teeth = -61", "teeth = -24", "its teeth would cut 5.183 mm off the tips"),
        ("teeth = -61", "teeth = -20", "cannot cut 20 internal teeth"),
    ],
)  # fmt: skip
def test_what_cannot_be_is_refused_in_words(was, now, words):
    """A user's expectation: the message names what is wrong and what is allowed; nothing is computed."""
    text = internal_scene()
    assert was in text
    with pytest.raises(GearsError, match=words):
        model_of(scene_from_text(text.replace(was, now)))


def test_a_rim_that_bends_more_than_its_teeth_is_not_held_by_default():
    """Thin ring under three forces (series of the inextensional ring): 0.0159 P R^3/(E' I). Refused with the number
    unless its support is given; a thick rim is held without a word."""
    with pytest.raises(GearsError, match=r"1\.5 times as much as its teeth"):
        model_of(scene_from_text(internal_scene().replace(', support = "held"', "")))
    assert any("1.5 times" in each for each in model_of(scene_of()).warnings)
    on_springs = internal_scene(wheel=f", {FOUNDATION}")
    assert not any("thin rim" in each for each in model_of(scene_from_text(on_springs)).warnings)
    thick = internal_scene().replace(', support = "held"', "").replace("280 mm", "320 mm")
    assert not any("thin rim" in each for each in model_of(scene_from_text(thick)).warnings)
