"""Mistakes in shafts of trains that bend, each refused in words before anything is computed."""

import re

import pytest
from tests.trains import bearing_sections, bent_two_stages, helical_row, shaft_section

from fenics_gears import SceneError, train_from_text
from fenics_gears.model.train import train_model_of

MOVING = """[inertia]
mass = "1 kg"
moment_of_inertia = "0.001 kg m^2"
[motion]
input_speed = "100 rpm"
mesh_cycles = 1
"""
AGAIN = (
    '[shafts.again]\ncarries = ["second.pinion", "first.wheel"]\ntorsional_stiffness = "1e8 N mm/rad"\n[shafts.middle]'
)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        (', "100.0 mm"]', "]", "shafts.middle.gears_at.*another number of places, 1, than gears, 2"),
        ('gears_at = ["35.0 mm", "100.0 mm"]', "", "shafts.middle.gears_at.*is missing. Allowed: 2 lengths"),
        ('"100.0 mm"]', '"145 mm"]', "shafts.middle.gears_at = 145 mm: second.pinion's face .* 12 mm to 138 mm"),
        ('"100.0 mm"]', '"50 mm"]', "face of first.wheel ends at 43 mm, that of second.pinion begins at 38 mm"),
        ('at = "135.0 mm"', 'at = "160 mm"', "shafts.middle.bearings: the bearing at 160 mm.*beyond the shaft"),
        ('at = "135.0 mm"', 'at = "100 mm"', "shafts.middle.bearings: the bearing at 100 mm.*overlaps the gear"),
        ('axial_stiffness = "100000.0 N/mm"', "", "shafts.middle.bearings.*freely moves along its axis"),
        ('diameter = "35.0 mm" }', 'diameter = "35.0 mm", bore = "36 mm" }', "shafts.middle.sections: the bore"),
        ('diameter = "35.0 mm"', 'diameter = "75 mm"', "75 mm thick under first.wheel's face, more than the root"),
        ("sections =", "#", "shafts.middle.gears_at.*has no effect: it is of a shaft with sections"),
        ("gears_at =", 'torque_at = "0 mm"\ngears_at =', "is of the first shaft or one that drives no gear"),
        ("gears_at =", 'seat = "integral"\ngears_at =', 'Did you mean "seats"'),
        ("gears_at =", 'seats = ["integral"]\ngears_at =', "shafts.middle.seats.*number of seats, 1, than"),
        ("gears_at =", 'seats = ["glued", "integral"]\ngears_at =', "shafts.middle.seats.*is no list of seats"),
        (
            "gears_at =",
            'seats = ["press fit", "integral"]\ngears_at =',
            'shafts.middle.seats = "press fit": .* under first.wheel.s face; allowed is a cylinder as thick',
        ),
        ("gears_at =", 'housing = "k.txt"\ngears_at =', "shafts.middle.housing = .*k.txt.*: .*"),
        ("[shafts.middle]", "[shafts]\nhousing = 3\n[shafts.middle]", "shafts.housing = 3"),
        ("gears_at =", "gear_at =", 'Did you mean "gears_at"'),
        ("gears_at =", 'torsional_stiffness = "1e8 N mm/rad"\ngears_at =', "sections.*together with torsional"),
        ('["first.wheel", "second.pinion"]', '["second.wheel"]', "shafts.middle.torque_at.*is missing"),
        ("[shafts.middle]", f"{MOVING}[shafts.middle]", "shafts.middle.material.density.*is missing: with .inertia"),
        ("[shafts.middle]", AGAIN, "shafts.middle.carries.*is on the shaft of .shafts.again. already"),
    ],
)
def test_a_shaft_that_does_not_fit_is_refused(old, new, words):
    """A user's expectation: where it is wrong, by the names of the train, and what is allowed."""
    text = bent_two_stages(1.0).text
    assert old in text
    with pytest.raises(SceneError) as refused:
        train_model_of(train_from_text(text.replace(old, new, 1)))
    said = " ".join(str(refused.value).split())
    assert re.search(words, said), said


def test_a_shaft_without_bearings_is_refused():
    """Nothing holds it."""
    text = bent_two_stages(1.0).text
    text = text[: text.index("[[shafts.middle.bearings]]")]
    with pytest.raises(SceneError, match=r"(?s)shafts.middle.bearings.*\[\[shafts.middle.bearings\]\] with at"):
        train_from_text(text)


def test_a_seat_of_an_idler_that_gives_way_is_refused():
    """Not computed yet: both of its meshes would feel each other by the seat."""
    row = helical_row([24, 31, 40], [20, 80], 300).text + shaft_section("idler", {"row.2": 40.0}, 100.0, 30.0)
    text = row.replace("gears_at =", 'seats = ["integral"]\ngears_at =')
    text += bearing_sections("idler", (10.0, 90.0), 3e5, 1e5)
    with pytest.raises(SceneError, match=r"shafts.idler.seats.*\n.* of row.2, which is in several meshes.*rigid"):
        train_model_of(train_from_text(text))
