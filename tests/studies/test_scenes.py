"""Scenes with other reliefs against the same scenes read from the start."""

import pickle
import tomllib
from dataclasses import fields
from pathlib import Path

import pytest

from fenics_gears.elasticity.cache import content_key
from fenics_gears.numbers_version import NUMBERS_VERSION
from fenics_gears.runs.run import run_of, scene_key
from fenics_gears.scene.read import scene_from_text
from fenics_gears.scene.schema import WORDS
from fenics_gears.studies import scenes
from fenics_gears.studies.scenes import Models, NoScene, model_of_tree

DEMOS = Path(__file__).parents[2] / "demos"
BASE = tomllib.loads((DEMOS / "lundvall2004.toml").read_text()) | {
    "tip_relief": {"depth": "20 um", "length_on_path": "5 mm", "wheel": {"depth": "15 um"}},
    "profile_modifications": {"pinion": {"slope": "2 um"}},
}
CHANGES = {
    "a depth": {"tip_relief": {"depth": "30 um", "length_on_path": "4 mm", "wheel": {"depth": "10 um"}}},
    "a shape": {"tip_relief": {"depth": "30 um", "length_on_path": "4 mm", "shape": "parabolic"}},
    "a slope": {"profile_modifications": {"pinion": {"slope": "-3 um"}}},
    "another field": {"profile_modifications": {"pinion": {"slope": "1 um", "crowning": "4 um"}}},
    "a load": {"load": {"wheel_torque": "300 N m"}},
    "none": {"tip_relief": None},
}
WRONG = {
    "beyond its range": {"tip_relief": {"depth": "-3 um", "length_on_path": "4 mm", "wheel": {"depth": "10 um"}}},
    "of another kind": {"tip_relief": {"depth": "3 N", "length_on_path": "4 mm", "wheel": {"depth": "10 um"}}},
    "off the flank": {"tip_relief": {"depth": "3 um", "length_on_path": "90 mm", "wheel": {"depth": "10 um"}}},
    "deeper than the tooth": {"tip_relief": {"depth": "9 mm", "length_on_path": "4 mm", "wheel": {"depth": "10 um"}}},
    "too large for an error": {"profile_modifications": {"pinion": {"slope": "2 mm"}}},
    "both ways at once": {"tip_relief": {"depth": "3 um", "length_on_path": "4 mm", "length_on_flank": "4 mm"}},
    "no section": {"tip_relief": "20 um"},
}


def changed(change):
    return {name: each for name, each in (BASE | change).items() if each is not None}


@pytest.mark.parametrize("name", CHANGES)
def test_a_scene_with_other_reliefs_is_that_scene(name, monkeypatch):
    """Identity with the parsed file; other numbers of reliefs alone are not read again."""
    models, read = Models("design", DEMOS), []
    models.of(BASE)
    monkeypatch.setattr(scenes, "model_of_tree", lambda *given: read.append(given) or model_of_tree(*given))
    model, expected = models.of(changed(CHANGES[name])), model_of_tree("design", changed(CHANGES[name]), DEMOS)
    assert model.scene == expected.scene and model.removal == expected.removal
    assert model.pair == expected.pair and model.resolution == expected.resolution
    assert model.drivetrain.load.tolist() == expected.drivetrain.load.tolist()
    assert (run_of(model).key, run_of(model).sharing) == (run_of(expected).key, run_of(expected).sharing)
    assert bool(read) == (name not in ("a depth", "a slope"))
    assert scene_from_text(model.scene.text, "design") == model.scene
    again = pickle.loads(pickle.dumps([run_of(expected), run_of(model)]))[1].model
    assert again.scene == model.scene and again.removal == model.removal and again.resolution == model.resolution


def test_under_a_light_load_windows_reach_as_far_as_a_designs_own_reliefs():
    """Identity with the parsed file, whose window follows the relief."""
    light = BASE | {"load": {"wheel_torque": "0.5 N m"}, "accuracy": {}}
    models = Models("design", DEMOS)
    before = models.of(light)
    design = light | CHANGES["a depth"]
    found = models.of(design)
    assert found.resolution == model_of_tree("design", design, DEMOS).resolution != before.resolution


@pytest.mark.parametrize("name", WRONG)
def test_wrong_reliefs_are_refused_in_the_same_words(name):
    """Identity."""
    models = Models("design", DEMOS)
    models.of(BASE)
    with pytest.raises(NoScene) as found:
        models.of(changed(WRONG[name]))
    with pytest.raises(NoScene) as expected:
        model_of_tree("design", changed(WRONG[name]), DEMOS)
    assert str(found.value) == str(expected.value) and str(found.value)


def test_the_key_of_a_scene_is_that_of_all_it_says():
    """Definition: the hash of its values, whichever way it is put together."""
    scene = model_of_tree("design", BASE, DEMOS).scene
    said = {each.name: getattr(scene, each.name) for each in fields(scene) if each.name not in WORDS}
    assert scene_key(scene) == scene_key(scene) == content_key({"scene": said, "numbers": NUMBERS_VERSION})
