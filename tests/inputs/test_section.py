"""Sections of a scene: one declaration is what a file may say and the data."""

import pickle
from dataclasses import dataclass, fields, replace

import pytest
from tests.effects.examples import EXAMPLES, scene_of, with_needs

from fenics_gears.effects import AT_THE_TOP, effect_named
from fenics_gears.inputs.allowed import Refused
from fenics_gears.inputs.fields import quantity, whole_number
from fenics_gears.inputs.section import Section, allowed_in, read, tree_of


@dataclass(frozen=True)
class Spring(Section):
    empty = "says nothing."
    alternatives = (("stiffness", "turns"),)

    stiffness: float | None = quantity("1 N/mm to 1 kN/mm", "2 N/mm", meaning="stiffness", otherwise="from `turns`")
    turns: int | None = whole_number(1, 99, 5, meaning="turns", otherwise="from `stiffness`")
    length: float = quantity("0 mm to 1 m", "20 mm", meaning="length", default="3 cm")


def test_a_default_is_written_with_its_unit_and_held_in_the_programs():
    """3 cm are 30 mm; the page says what was written."""
    assert read(Spring, {"turns": 4}) == (Spring(turns=4, length=30.0), [])
    assert allowed_in(Spring, "length").otherwise == "3 cm"
    assert tree_of(Spring(stiffness=0.2e3)) == {"stiffness": "200 N/mm"}


@pytest.mark.parametrize(
    ("tree", "path", "said"),
    [
        ({}, ("spring",), "says nothing."),
        (
            {"stiffness": "2 N/mm", "turns": 4},
            ("spring", "turns"),
            "is given together with stiffness; allowed is one of the two.",
        ),
        ({"stiffness": "2 N"}, ("spring", "stiffness"), "is a force, not a stiffness."),
        ({"turns": 4, "length": "2 m"}, ("spring", "length"), "is too large. Allowed: a length from 0 mm to 1 m"),
    ],
)
def test_what_is_wrong_with_a_section_is_told_with_its_place(tree, path, said):
    """House rule 7."""
    found, (problem,) = read(Spring, tree, ("spring",))
    assert found is None and problem.path == path and said in problem.message


def test_a_refused_value_says_why_in_a_sentence():
    """The range declared above."""
    with pytest.raises(Refused, match="is negative"):
        allowed_in(Spring, "length").convert("-1 mm")


@pytest.mark.parametrize("section", AT_THE_TOP)
def test_data_are_plain_values(section):
    """A study compares them, sends them to other processes and changes a field."""
    data = getattr(scene_of(*with_needs(section)), section)
    assert pickle.loads(pickle.dumps(data)) == data == replace(data)
    assert hash(data) == hash(replace(data))
    assert all(not each.metadata or "allowed" in each.metadata for each in fields(data))
    assert section in EXAMPLES and issubclass(effect_named(section).fields, Section)
