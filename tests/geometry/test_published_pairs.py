"""Whole pairs against numbers that others have printed."""

from math import cos, degrees, pi, radians, sin, sqrt

import pytest

from fenics_gears.geometry.characteristics import characteristics
from fenics_gears.geometry.pair import GearPair, gear_pair
from fenics_gears.scene.data import GearData, GearPairData, Material

PAPER = {
    "operating pressure angle": (22.44, "deg"),
    "base pitch": (13.28, "mm"),
    "contact ratio": (1.47, ""),
    "pinion roll angle, HPSTC": (29.61, "deg"),
    "wheel roll angle, HPSTC": (27.64, "deg"),
    "pitch point, from T2 (e)": (20.95, "mm"),
}


@pytest.mark.parametrize("label", PAPER)
def test_the_paper_s_numbers_come_out_of_its_gear_data(paper_pair, label):
    """Authority: Lundvall, Stromberg & Klarbring 2004 (Table 2 in, the printed digits out).

    Some of its digits are rounded, others cut off (29.615 is printed as 29.61, 20.955 as 20.95), hence one unit of the last digit.
    """
    rows = {name: (value, unit) for name, value, unit in characteristics(paper_pair)}
    printed, unit = PAPER[label]
    assert rows[label][1] == unit
    assert abs(rows[label][0] - printed) < 0.01


def test_the_paper_s_root_diameters_are_these_dedenda(paper_pair):
    """Authority: model.md section 5, 62.50 and 98.37 mm are 1.25 and 1.195 modules below the shifted pitch line."""
    assert paper_pair.pinion.dedendum / 4.5 == pytest.approx(1.25, abs=2e-3)
    assert paper_pair.wheel.dedendum / 4.5 == pytest.approx(1.195, abs=1e-12)


def test_the_paper_s_pair_has_about_a_tenth_of_a_millimetre_of_backlash(paper_pair):
    """Authority: model.md section 5, to the digit it gives; the touching centre distance is below 91.5 mm."""
    assert paper_pair.backlash == pytest.approx(0.1, abs=0.05)
    assert 91.0 < paper_pair.centre_distance_without_backlash < 91.5


def test_profile_shifted_pair_of_the_technical_reference():
    """Authority: KHK Gear Technical Reference, table "The calculation of profile shifted spur gear" (also printed at
    bolsover.com, Profile Shifted External Spur Gears): m 3, z 12/24, x 0.6/0.36, all results to the printed digits."""
    pair = gear_pair(
        GearPairData(
            module=3.0,
            pressure_angle=radians(20.0),
            centre_distance=56.5,
            face_width=10.0,
            pinion=GearData(12, 0.6, 44.840, 32.100, 15.0, 0.38),
            wheel=GearData(24, 0.36, 79.400, 66.660, 15.0, 0.38),
            material=Material(206e3, 0.3),
        )
    )
    assert 2.0 * pair.pinion.base_radius == pytest.approx(33.8289, abs=5e-5)
    assert 2.0 * pair.wheel.base_radius == pytest.approx(67.6579, abs=5e-5)
    assert degrees(pair.operating_pressure_angle) == pytest.approx(26.0888, abs=5e-5)
    assert pair.contact_ratio == pytest.approx(1.202, abs=5e-4)
    assert pair.centre_distance_without_backlash == pytest.approx(56.4999, abs=5e-5)
    assert pair.pinion.dedendum == pytest.approx(1.25 * 3.0, abs=1e-9)


@pytest.mark.parametrize("teeth", [(20, 40), (19, 42), (30, 60)])
def test_contact_ratio_of_standard_gears_by_the_textbook(cut_gear, teeth):
    """Authority: the textbook's path of contact sqrt(ra1^2 - rb1^2) + sqrt(ra2^2 - rb2^2) - a sin(alpha) over
    pi m cos(alpha) (e.g. Shigley, Mechanical Engineering Design, contact ratio), full-depth teeth of 20 deg."""
    alpha = radians(20.0)
    pair = GearPair(cut_gear(teeth[0]), cut_gear(teeth[1]), centre_distance=0.5 * sum(teeth), face_width=1.0)
    recess, approach = (sqrt((0.5 * z + 1.0) ** 2 - (0.5 * z * cos(alpha)) ** 2) for z in teeth)
    textbook = (recess + approach - pair.centre_distance * sin(alpha)) / (pi * cos(alpha))
    assert pair.contact_ratio == pytest.approx(textbook, rel=1e-12)
