"""What engineers call a field that has another name here: the schema, ISO 21771's and ISO 1328's symbols."""

import pytest
from tests.paper_text import PAPER as DEMO

from fenics_gears import SceneError, scene_from_text
from fenics_gears.inputs.problem import meant
from fenics_gears.inputs.synonyms import SYNONYMS
from fenics_gears.scene.schema import known_paths

FIELDS = {".".join(path) for path in known_paths()}


def test_every_synonym_is_of_a_field_and_of_one_alone():
    """The schema: no word stands for two fields of a section, nor is it one itself."""
    assert set(SYNONYMS) <= FIELDS
    places = [(name.rpartition(".")[0], word) for name, words in SYNONYMS.items() for word in words.split()]
    assert len(places) == len(set(places))
    assert not FIELDS & {f"{section}.{word}".lstrip(".") for section, word in places}


@pytest.mark.parametrize(
    ("old", "new", "hint"),
    [
        ("moment_of_inertia = ", "mass_moment = ", 'Did you mean "moment_of_inertia"?'),
        ("moment_of_inertia = ", "inertia = ", 'Did you mean "moment_of_inertia"?'),
        ("wheel_torque = ", "torque = ", 'Did you mean "wheel_torque"?'),
        ('mesh_frequency = "200 Hz"', 'speed = "750 rpm"', 'Did you mean "pinion_speed"?'),
        ("face_width = ", "width = ", 'Did you mean "face_width"?'),
        ("teeth = 16", "z = 16", 'Did you mean "teeth"?'),
        ("coefficient = 0.1", "mu = 0.1", 'Did you mean "coefficient"?'),
        ("[friction]\ncoefficient", "[coulomb]\ncoefficient", 'Did you mean "friction"?'),
        (
            "coefficient = 0.1",
            'coefficient = 0.1\n[tip_relief]\namount = "31 um"\nstart = "HPSTC"',
            'Did you mean "depth"?',
        ),
        (
            "coefficient = 0.1",
            'coefficient = 0.1\n[tip_relief.wheel]\nCa = "31 um"\nstart = "HPSTC"',
            'Did you mean "depth"?',
        ),
        ("[damping]", 'mass_moment = "3 kg m^2"\n[damping]', 'Did you mean "moment_of_inertia"?'),
        ("[shafts]", '[shafts]\nmass_moment = "3 kg m^2"', 'Did you mean "moment_of_inertia" of [inertia]?'),
    ],
)
def test_a_synonym_is_answered_with_the_name(old, new, hint):
    """One mistake, which names the field that is meant."""
    assert old in DEMO
    with pytest.raises(SceneError) as error:
        scene_from_text(DEMO.replace(old, new, 1), "pair")
    assert hint in str(error.value)
    assert "1 mistake in pair" in str(error.value)


def test_a_word_means_what_its_section_has():
    """mu is friction's coefficient and, of a material, Poisson's ratio."""
    assert meant(["friction"], "mu", ["coefficient"]) == "coefficient"
    assert meant(["gears", "material"], "mu", ["youngs_modulus", "poissons_ratio"]) == "poissons_ratio"
    assert meant(["gears", "wheel"], "z", ["teeth"]) == "teeth"
    assert meant(["friction"], "oil", ["coefficient"]) is None
