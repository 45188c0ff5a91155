"""Crowning and slope of the profile, and the exponent of a relief."""

import numpy as np
import pytest
from tests.effects.examples import BASE, EXAMPLES

from fenics_gears import SceneError, scene_from_text
from fenics_gears.effects.profile_modifications import ProfileModification, ProfileModifications
from fenics_gears.effects.relief import LINEAR, PARABOLIC, Relief
from fenics_gears.effects.tip_relief import TipRelief
from fenics_gears.geometry.profile_modification import profile_curves
from fenics_gears.geometry.relief import tip_reliefs

ELASTIC = BASE + EXAMPLES["tooth_elasticity"]


def test_curves_are_what_the_fields_say(paper_pair):
    """Definition: crowning at both ends, slope at the tip; nothing is ever added."""
    start, end = paper_pair.sap_roll_angles[1], paper_pair.wheel.tip_roll_angle
    places = np.array([start, 0.5 * (start + end), end])
    for modification, removed in (
        (ProfileModification(0.004, 0.0), [0.004, 0.0, 0.004]), (ProfileModification(-0.004, 0.0), [0.0, 0.004, 0.0]),
        (ProfileModification(0.0, 0.005), [0.0, 0.0025, 0.005]),
        (ProfileModification(0.0, -0.005), [0.005, 0.0025, 0.0]),
    ):  # fmt: skip
        pinion, wheel = profile_curves(paper_pair, ProfileModifications(None, modification))
        assert pinion is None and wheel(places) == pytest.approx(np.array(removed), abs=1e-15)
        assert (wheel(np.linspace(start - 0.2, end + 0.2)) >= 0.0).all()


def test_exponents_of_one_and_two_are_the_shapes(paper_pair):
    """Identity; an exponent of 1.5 lies between them."""
    rolls = np.linspace(paper_pair.hpstc_roll_angles[0], paper_pair.pinion.tip_roll_angle, 20)

    def removed(**how):
        return tip_reliefs(paper_pair, TipRelief(Relief(0.02, None, **how), None))[0](rolls)

    assert np.array_equal(removed(exponent=1.0), removed(shape=LINEAR)) and np.array_equal(
        removed(exponent=2.0), removed(shape=PARABOLIC)
    )
    assert (removed(exponent=2.0) <= removed(exponent=1.5)).all() and (
        removed(exponent=1.5) <= removed(exponent=1.0)
    ).all()


@pytest.mark.parametrize(
    ("section", "words"),
    [
        ("[profile_modifications]\n", "modifies neither gear"),
        ("[profile_modifications.pinion]\n", "names no modification. Add crowning or slope"),
        ('[profile_modifications.wheel]\nslope = "1 mm"\n', "is too large an error of manufacture"),
        ('[tip_relief]\ndepth = "20 um"\nstart = "HPSTC"\nshape = "linear"\nexponent = 1.5\n', "stands beside shape"),
    ],
)
def test_wrong_modifications_are_refused(section, words):
    """docs/scene.md."""
    with pytest.raises(SceneError, match=words):
        scene_from_text(ELASTIC + section)
