"""``[bearings]``."""

import pytest
from tests.paper_text import PAPER as DEMO

from fenics_gears import SceneError, scene_from_text
from fenics_gears.dynamics.bearings import Bearings, Support

ISOTROPIC = 'stiffness = "0.155e6 N/mm"'


# Four stiffnesses (N/mm) that no mistake of axis or gear leaves alone.
ALL_DIFFERENT = Bearings(0.2e6, stiffness_y=0.3e6, pinion=Support(stiffness_x=0.1e6), wheel=Support(stiffness_y=0.5e6))
EXPECTED = {("pinion", "x"): 0.1e6, ("pinion", "y"): 0.3e6, ("wheel", "x"): 0.2e6, ("wheel", "y"): 0.5e6}


def with_bearings(lines):
    assert ISOTROPIC in DEMO
    return scene_from_text(DEMO.replace(ISOTROPIC, lines))


def test_a_gears_own_stiffness_stands_before_that_of_both():
    """A direction's stiffness stands before that of every direction."""
    text = (
        'stiffness = "0.2e6 N/mm"\nstiffness_y = "0.3e6 N/mm"\n[bearings.pinion]\nstiffness_x = "0.1e6 N/mm"\n'
        '[bearings.wheel]\nstiffness_y = "0.5e6 N/mm"'
    )
    bearings = with_bearings(text).bearings
    assert bearings == ALL_DIFFERENT
    assert {key: bearings.of(*key) for key in EXPECTED} == EXPECTED


def test_places_are_read_from_mid_width():
    """In mm; the axial stiffness of a shaft before that of both."""
    text = (
        f'{ISOTROPIC}\naxial_stiffness = "1 N/mm"\nplaces = {{ pinion = ["-40 mm", "6 cm"]'
        ' }\n[bearings.pinion]\naxial_stiffness = "2 N/mm"'
    )
    bearings = with_bearings(text).bearings
    assert bearings.places_of("pinion") == (-40.0, 60.0) and bearings.places_of("wheel") is None
    assert bearings.axial("pinion") == 2.0 and bearings.axial("wheel") == 1.0
    assert with_bearings(ISOTROPIC).bearings.places is None


@pytest.mark.parametrize(("lines", "said"), [
    ("", "bearings.stiffness\n    is missing"),
    ('stiffness_x = "1 N/mm"', "bearings.stiffness_y\n    is missing"),
    ('[bearings.pinion]\nstiffness = "1 N/mm"\n[bearings.wheel]\nstiffness_y = "1 N/mm"',
     "bearings.wheel.stiffness_x\n    is missing"),
    (f'{ISOTROPIC}\nplaces = {{ wheel = ["40 mm", "40.1 mm"] }}',
     "bearings.places.wheel = a list\n    has both bearings on one spot"),
    (f'{ISOTROPIC}\nplaces = {{ wheel = ["40 mm"] }}',
     "has 1 entry. Allowed: a list of 2 quantities, each a length from -10 m to 10 m"),
    (f"{ISOTROPIC}\nplaces = {{}}", "[bearings.places]\n    is empty."),
    (f'{ISOTROPIC}\naxial_stiffness = "1 N/mm"',
     ('bearings.axial_stiffness = "1 N/mm"\n    has no effect: a shaft whose bearings have no places is held'
     " axially.")),
    (f'{ISOTROPIC}\nplaces = {{ wheel = ["-40 mm", "40 mm"] }}\n[bearings.pinion]\naxial_stiffness = "1 N/mm"',
     "Leave it out, or give bearings.places.pinion."),
])  # fmt: skip
def test_what_is_missing_or_cannot_be_is_named(lines, said):
    """House rule 7."""
    with pytest.raises(SceneError) as refused:
        with_bearings(lines)
    assert said in str(refused.value)
