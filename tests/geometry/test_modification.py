"""Where tip relief may begin."""

from math import radians

import numpy as np
import pytest

from fenics_gears import GeometryError
from fenics_gears.effects.relief import Relief
from fenics_gears.effects.tip_relief import TipRelief
from fenics_gears.geometry.relief import tip_reliefs


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
