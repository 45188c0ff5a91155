"""Profile shifts and bores that a scene leaves out."""

import pytest
from tests.geometry.test_drawing import derived, scene_of

from fenics_gears import GeometryError, gear_pair


@pytest.mark.parametrize("gear", ["pinion", "wheel"])
@pytest.mark.parametrize(
    "pair", [{}, {"helix_angle": "18 deg"}, {"transverse_module": "3.2 mm", "module": None, "helix_angle": "25 deg"}]
)
def test_the_centre_distance_gives_the_profile_shift_that_is_left_out(gear, pair):
    """The way back: the centre distance of both profile shifts without backlash."""
    both = scene_of(pair).gears
    distance = {"centre_distance": f"{both.centre_distance!r} mm"}
    other = scene_of(pair | distance, **{gear: {"profile_shift": None}})
    shift = getattr(both, gear).profile_shift
    assert getattr(other.gears, gear).profile_shift == pytest.approx(shift, abs=1e-11)
    assert derived(other)[f"{gear} profile shift"] == pytest.approx(shift, abs=1e-11)


def test_an_internal_gear_s_profile_shift_follows_too():
    """The way back, with the signs of ISO 21771."""
    ring = {"teeth": -61, "bore_diameter": None, "outer_diameter": "230 mm", "support": "held"}
    both = scene_of({}, {}, ring | {"profile_shift": -0.4}).gears
    distance = {"centre_distance": f"{-both.centre_distance!r} mm"}
    other = scene_of(distance, {}, ring | {"profile_shift": None}).gears
    assert other.wheel.profile_shift == pytest.approx(-0.4, abs=1e-11)


def test_without_a_centre_distance_profile_shifts_are_zero():
    """The rack: gears without profile shift, at their reference centre distance."""
    scene = scene_of({}, {"profile_shift": None}, {"profile_shift": None})
    assert (scene.gears.pinion.profile_shift, scene.gears.wheel.profile_shift) == (0.0, 0.0)
    assert gear_pair(scene.gears).centre_distance == pytest.approx(75.0, abs=1e-12)
    at_reference = scene_of({"centre_distance": "75 mm"}, {"profile_shift": None}, {"profile_shift": None})
    assert (at_reference.gears.pinion, at_reference.gears.wheel) == (scene.gears.pinion, scene.gears.wheel)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        (
            ({"centre_distance": "76 mm"}, {"profile_shift": None}, {"profile_shift": None}),
            "both profile shifts are left out, and gears.centre_distance = 76 mm gives only their sum, 0.349",
        ),
        (
            ({"centre_distance": "76 mm"}, {"profile_shift": None}, {"profile_shift": None, "tooth_thickness": "5 mm"}),
            "gears.pinion.profile_shift is missing; with gears.centre_distance and a measured tooth thickness",
        ),
    ],
)
def test_a_centre_distance_that_fixes_no_single_profile_shift_is_refused(changes, message):
    """The rule that the message names; 0.349 by ISO 21771, by hand: 25 (0.01999 - 0.01490)/0.36397."""
    with pytest.raises(GeometryError, match=message):
        scene_of(*changes)


def test_a_bore_is_two_fifths_of_the_root_circle():
    """The rule of docs/scene.md."""
    scene = scene_of({}, {"bore_diameter": None})
    pinion = scene.gears.pinion
    assert pinion.bore_diameter == pytest.approx(0.4 * pinion.root_diameter, rel=1e-12)
    assert derived(scene)["pinion bore diameter"] == pinion.bore_diameter
