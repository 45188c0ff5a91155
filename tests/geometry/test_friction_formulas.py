"""Coefficients of friction by formula."""

from math import cos, log10, pi, radians

import pytest

from fenics_gears import gear_pair
from fenics_gears.geometry.friction_formulas import benedict_kelley, schlenk
from fenics_gears.scene.data import GearData, GearPairData, Material


@pytest.fixture
def fzg_c():
    """The FZG test gear C, 14 mm wide."""
    gears = GearData(16, 0.1817, 82.636, 62.386, 30.0, 0.38), GearData(24, 0.1715, 118.544, 98.294, 30.0, 0.38)
    return gear_pair(GearPairData(4.5, radians(20.0), 91.501, 14.0, *gears, Material(206e3, 0.3)))


def test_schlenk_is_another_program_s(fzg_c):
    """GEARpie's report of C14, 200 N m at 1500 1/min, M32 at 60 degC, Ra 0.4 and 0.31 um: 0.0449."""
    assert 0.85 * schlenk(fzg_c, 5912.1, 1500.0, 13.28, 0.355) == pytest.approx(0.0449, rel=6e-3)


def test_below_150_newtons_a_millimetre_it_does_not_rise(fzg_c):
    """ISO/TR 14179-2."""
    assert (
        schlenk(fzg_c, 100.0, 1500.0, 13.0, 0.4)
        == schlenk(fzg_c, 140.0 * 14.0, 1500.0, 13.0, 0.4)
        < schlenk(fzg_c, 300.0 * 14.0, 1500.0, 13.0, 0.4)
    )


def test_above_50_metres_a_second_it_does_not_fall(fzg_c):
    """ISO/TR 14179-2."""
    a_metre_a_second = 60e3 / (2.0 * pi * fzg_c.pinion.base_radius / cos(fzg_c.operating_pressure_angle))
    by_speed = [schlenk(fzg_c, 5912.1, speed * a_metre_a_second, 13.0, 0.4) for speed in (49.0, 50.0, 80.0)]
    assert by_speed[0] > by_speed[1] == pytest.approx(by_speed[2], rel=1e-12)


def test_benedict_and_kelley_is_the_published_formula(fzg_c):
    """0.0127 (50/(50 - S)) log10(3.17e8 X/(eta V_s V_r^2)) with lb/in, cP, in/s and microinches; the mean lies
    between its values on the path."""
    inch, pound = 25.4, 4.4482216152605
    force, speed, viscosity, rough = 5912.1, 1500.0, 13.28, 0.4

    def local(position):
        turning = 2.0 * 3.141592653589793 * speed / 60.0
        first, second = turning * position / inch, turning * 16 / 24 * (fzg_c.line_of_action_length - position) / inch
        load = force / 14.0 / pound * inch
        microinch = rough / 0.0254
        return (
            0.0127
            * 50.0
            / (50.0 - microinch)
            * log10(3.17e8 * load / (viscosity * abs(first - second) * (first + second) ** 2))
        )

    ends = [local(fzg_c.path_start), local(fzg_c.path_end)]
    places = [fzg_c.path_start + (number + 0.5) / 400 * (fzg_c.path_end - fzg_c.path_start) for number in range(400)]
    mean = sum(local(each) for each in places) / 400
    found = benedict_kelley(fzg_c, force, speed, viscosity, rough)
    assert found == pytest.approx(mean, rel=1e-4) and min(ends) < found < local(fzg_c.pitch_point + 0.1)
