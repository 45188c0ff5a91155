"""Gears with protuberance, finishing stock and tip chamfer."""

from math import radians

import pytest

from fenics_gears import SceneError, gear_pair, scene_from_text

SCENE = """
[gears]
module = "3 mm"
pressure_angle = "20 deg"
face_width = "20 mm"
centre_distance = "90.1 mm"
{gears}

[gears.pinion]
teeth = 20
profile_shift = 0
bore_diameter = "20 mm"
{pinion}

[gears.wheel]
teeth = 40
profile_shift = 0
bore_diameter = "40 mm"

[load]
wheel_torque = "100 N m"
"""
RACK = '[gears.rack]\nprotuberance = "0.15 mm"\nfinishing_stock = "0.1 mm"\n'


def gears(rack="", pinion=""):
    return scene_from_text(SCENE.format(gears=rack, pinion=pinion)).gears


def test_what_is_left_of_the_protuberance_is_it_less_the_stock():
    """ISO 6336-3: s_pr = pr - q; half the pressure angle as protuberance angle unless given."""
    data = gears(RACK)
    for gear in (data.pinion, data.wheel):
        assert gear.protuberance == pytest.approx(0.05, rel=1e-12)
        assert gear.protuberance_angle == pytest.approx(radians(10.0), rel=1e-12)
    assert gears(RACK + 'protuberance_angle = "8 deg"').wheel.protuberance_angle == pytest.approx(
        radians(8.0), rel=1e-12
    )


def test_a_gear_s_own_rack_goes_before_that_of_both():
    """docs/scene.md."""
    data = gears(RACK, '[gears.pinion.rack]\nprotuberance = "0.2 mm"\n')
    assert (data.pinion.protuberance, data.wheel.protuberance) == pytest.approx((0.1, 0.05), rel=1e-12)


def test_protuberance_as_large_as_the_stock_leaves_the_plain_rack():
    """Exact: a rack without both."""
    assert gear_pair(gears(RACK.replace("0.15", "0.1"))) == gear_pair(gears())


def test_the_chamfer_is_the_gear_s():
    """docs/scene.md."""
    data = gears(pinion='tip_chamfer = "0.3 mm"')
    assert (data.pinion.tip_chamfer, data.wheel.tip_chamfer) == pytest.approx((0.3, 0.0), rel=1e-12)


@pytest.mark.parametrize(
    ("rack", "said"),
    [
        (
            '[gears.rack]\nfinishing_stock = "0.1 mm"',
            'gears.rack.finishing_stock = "0.1 mm"\n    is more than the protuberance of the wheel\'s rack',
        ),
        (
            RACK.replace("0.1 mm", "0.2 mm"),
            'finishing_stock = "0.2 mm"\n    is more than the protuberance of the wheel\'s rack',
        ),
        (
            '[gears.rack]\nprotuberance_angle = "10 deg"',
            'protuberance_angle = "10 deg"\n    has no meaning without a protuberance',
        ),
        (RACK + 'protuberance_angle = "25 deg"', "must be less than the pressure angle, 20 deg"),
    ],
)
def test_a_protuberance_that_cannot_be_is_refused(rack, said):
    """The field, its value and what is allowed."""
    with pytest.raises(SceneError) as refused:
        gears(rack)
    assert said in str(refused.value)
