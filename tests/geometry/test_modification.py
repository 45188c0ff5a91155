"""Tip relief, linear in the roll angle."""

from math import radians

import numpy as np
import pytest

from fenics_gears import GeometryError
from fenics_gears.effects.relief import Relief
from fenics_gears.effects.tip_relief import TipRelief
from fenics_gears.geometry.relief import tip_reliefs


def test_relief_from_the_highest_point_of_single_tooth_contact(paper_pair):
    """Authority: definition (paper, Section 5): nothing below HPSTC, the depth at the tip, linear between."""
    pinion, wheel = tip_reliefs(paper_pair, TipRelief(Relief(0.031, None), Relief(0.020, None)))
    for relief, depth, start, gear in (
        (pinion, 0.031, paper_pair.hpstc_roll_angles[0], paper_pair.pinion),
        (wheel, 0.020, paper_pair.hpstc_roll_angles[1], paper_pair.wheel),
    ):
        fractions = np.array([-1.0, 0.0, 0.25, 0.5, 1.0])
        rolls = start + fractions * (gear.tip_roll_angle - start)
        assert relief(rolls) == pytest.approx(depth * np.array([0.0, 0.0, 0.25, 0.5, 1.0]), abs=1e-16)


def test_two_pairs_are_never_both_relieved_nor_both_unrelieved(paper_pair):
    """Authority: what HPSTC means: a pair in single contact touches where neither flank is relieved; in double contact
    one pair touches where the pinion, the other where the wheel is relieved."""
    pinion, wheel = tip_reliefs(paper_pair, TipRelief(Relief(0.031, None), Relief(0.031, None)))

    def removed(position):
        return (
            pinion(paper_pair.pinion_roll_angle(position)) > 0.0,
            wheel(paper_pair.wheel_roll_angle(position)) > 0.0,
        )

    start, pitch = paper_pair.path_start, paper_pair.base_pitch
    for phase in np.linspace(0.01, 0.46, 10):
        assert removed(start + phase * pitch) == (False, True)
        assert removed(start + (1.0 + phase) * pitch) == (True, False)
    for phase in np.linspace(0.48, 0.99, 10):
        assert removed(start + phase * pitch) == (False, False)


def test_relief_from_a_roll_angle_on_one_gear(paper_pair):
    """Authority: the scene's meaning: a start of its own, and None for a gear without relief."""
    pinion, wheel = tip_reliefs(paper_pair, TipRelief(None, Relief(0.01, 0.5)))
    assert pinion is None
    assert wheel.start_roll_angle == 0.5


@pytest.mark.parametrize(
    ("relief", "said"),
    [
        (Relief(0.01, radians(41.0)), ["41 deg", "40.19 deg (tip)", "tip_relief.pinion.start"]),
        (Relief(0.01, radians(2.0)), ["2 deg", "2.904 deg (form circle)", "tip_relief.pinion.start"]),
        (Relief(-0.01, None), ["tip_relief", "-0.01 mm"]),
        (Relief(float("nan"), None), ["tip_relief", "nan"]),
    ],
)
def test_relief_off_the_flank_is_refused(paper_pair, relief, said):
    """Authority: house rule on errors: what, which gear, the value, what is allowed, the field."""
    with pytest.raises(GeometryError) as refused:
        tip_reliefs(paper_pair, TipRelief(relief, None))
    assert str(refused.value).startswith("pinion: tip")
    for part in said:
        assert part in str(refused.value)
