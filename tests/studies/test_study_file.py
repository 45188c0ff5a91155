"""Study files."""

import copy

import numpy as np
import pytest
from tests.studies.conftest import write_study

from fenics_gears.commands.cli import main
from fenics_gears.errors import SceneError
from fenics_gears.inputs.tree import value_at
from fenics_gears.studies import fields
from fenics_gears.studies.study_file import load_study

FREQUENCIES = 'motion.mesh_frequency = ["100 Hz", "200 Hz"]\n'


def swept(folder, text):
    return load_study(write_study(folder, "[sweep]\n" + text))


def test_a_product_has_every_combination_the_last_field_turning_fastest(folder):
    """Authority: itertools.product."""
    study = swept(folder, FREQUENCIES + 'load.wheel_torque = ["1 N m", "2 N m", "3 N m"]')
    assert study.shape == (2, 3) and study.dimensions == ("mesh_frequency", "wheel_torque")
    said = [(case.scene.motion.mesh_frequency, case.scene.load.wheel_torque) for case in study.cases]
    assert said == [(f, 1000.0 * t) for f in (100.0, 200.0) for t in (1, 2, 3)]


def test_zip_varies_all_fields_together(folder):
    """Authority: zip."""
    study = load_study(
        write_study(folder, 'combine = "zip"\n[sweep]\n' + FREQUENCIES + 'load.wheel_torque = ["1 N m", "2 N m"]')
    )
    assert study.shape == (2,) and study.dimensions == ("case",)
    assert [(c.scene.motion.mesh_frequency, c.scene.load.wheel_torque) for c in study.cases] == [
        (100.0, 1000.0),
        (200.0, 2000.0),
    ]


@pytest.mark.parametrize(
    ("written", "numbers"),
    [
        ('{ start = "100 Hz", stop = "0.4 kHz", count = 4 }', [100, 200, 300, 400]),
        ('{ start = "100 Hz", stop = "350 Hz", step = "100 Hz" }', [100, 200, 300]),
        ('{ start = "300 Hz", stop = "100 Hz", step = "-0.1 kHz" }', [300, 200, 100]),
        ('{ start = "100 Hz", stop = "10 kHz", count = 3, spacing = "logarithmic" }', [100, 1000, 10000]),
    ],
)
def test_a_range_is_the_list_it_stands_for(folder, written, numbers):
    """Authority: arithmetic."""
    (axis,) = swept(folder, f"motion.mesh_frequency = {written}").axes
    assert axis.unit == "Hz"
    np.testing.assert_allclose(axis.coordinate(), numbers, rtol=1e-11)


@pytest.mark.parametrize(
    "spelling",
    [
        'motion.mesh_frequency = ["100 Hz"]',
        '"motion.mesh_frequency" = ["100 Hz"]',
        'motion = { mesh_frequency = ["100 Hz"] }',
    ],
)
def test_dotted_names_may_be_bare_quoted_or_tables(folder, spelling):
    """TOML."""
    assert swept(folder, spelling).axes[0].path == ("motion", "mesh_frequency")


def test_sections_can_be_absent_present_or_written_out(folder):
    """Authority: the definition of the three spellings."""
    study = swept(folder, 'friction = ["absent", "present", { coefficient = 0.3 }]')
    assert [case.scene.friction and case.scene.friction.coefficient for case in study.cases] == [None, 0.1, 0.3]
    assert list(study.axes[0].coordinate()) == ["absent", "present", "coefficient = 0.3"]


@pytest.mark.parametrize("section", ["coast_flanks = {}", "[set.coast_flanks]"])
def test_a_section_without_fields_can_be_set_and_swept(folder, section):
    """docs/studies.md."""
    path = write_study(folder, f'[set]\n{section}\n[sweep]\ncoast_flanks = ["absent", "present"]\n')
    assert [case.scene.coast_flanks is not None for case in load_study(path).cases] == [False, True]


def test_a_section_set_without_fields_keeps_those_of_the_scene(folder):
    """docs/studies.md."""
    study = load_study(write_study(folder, '[set]\nfriction = {}\n[sweep]\nload.wheel_torque = ["1 N m"]\n'))
    assert study.cases[0].scene.friction.coefficient == 0.1


def test_what_is_left_out_is_gone_before_what_is_set(folder):
    """docs/studies.md."""
    study = load_study(
        write_study(
            folder,
            'without = ["inertia", "damping", "motion.mesh_frequency"]\n[set]\nmotion.pinion_speed = "60 rpm"\n'
            '[sweep]\nload.wheel_torque = ["1 N m"]',
        )
    )
    scene = study.cases[0].scene
    assert scene.inertia is None and scene.damping is None and scene.bearings is not None
    assert scene.motion.mesh_frequency == pytest.approx(16.0)


def test_a_case_is_known_by_what_it_says_not_by_how_it_is_written(folder):
    """200 Hz are 0.2 kHz, and a comment changes nothing."""
    first = swept(folder, 'motion.mesh_frequency = ["200 Hz", "100 Hz"]')
    scene = folder / "pair.toml"
    scene.write_text("# another comment\n" + scene.read_text())
    second = swept(folder, 'motion.mesh_frequency = ["0.2 kHz"]')
    assert first.cases[0].key == second.cases[0].key != first.cases[1].key


WRONG = {
    "no sweep": ("", ["sweep", "is missing"]),
    "unknown key": ("swep = 1\n[sweep]\n" + FREQUENCIES, ["swep = 1", 'Did you mean "sweep"?']),
    "scene's section": ('[load]\nwheel_torque = "1 N m"\n[sweep]\n' + FREQUENCIES, ["[load]", "[set]"]),
    "unknown field": (
        '[sweep]\nmotion.mesh_frequenzy = ["1 Hz"]',
        ["mesh_frequenzy", 'Did you mean "motion.mesh_frequency"?', ":3:"],
    ),
    "field without section": ('[sweep]\nmesh_frequency = ["1 Hz"]', ["mesh_frequency", "motion.mesh_frequency"]),
    "unknown in without": ('without = ["inertea"]\n[sweep]\n' + FREQUENCIES, ["inertea", 'Did you mean "inertia"?']),
    "one value": ('[sweep]\nmotion.mesh_frequency = "1 Hz"', ['"1 Hz"', "Allowed: a list of values", "[set]"]),
    "empty list": ("[sweep]\nmotion.mesh_frequency = []", ["is an empty list"]),
    "wrong unit": ('[sweep]\nmotion.mesh_frequency = ["1 Hz", "3 mm"]', ['"3 mm"', "is a length", "Allowed"]),
    "no unit": ("[sweep]\nmotion.mesh_frequency = [200]", ["without its unit", '"200 Hz"']),
    "section as number": ("[sweep]\nfriction = [0.1]", ["friction", "is a section", '"absent"']),
    "misspelt absent": ('[sweep]\nfriction = ["absnt"]', ['Did you mean "absent"?']),
    "present but absent": (
        'without = ["tip_relief"]\n[sweep]\ntip_relief.pinion = ["present"]',
        ["present", "pair.toml"],
    ),
    "zip of different lengths": (
        'combine = "zip"\n[sweep]\n' + FREQUENCIES + "friction.coefficient = [0.1]",
        ["mesh_frequency has 2", "coefficient has 1"],
    ),
    "unknown combination": ('combine = "prodct"\n[sweep]\n' + FREQUENCIES, ["prodct", 'Did you mean "product"?']),
    "range without stop": ('[sweep]\nmotion.mesh_frequency = { start = "1 Hz", count = 3 }', ["has no stop"]),
    "range with count and step": (
        '[sweep]\nmotion.mesh_frequency = { start = "1 Hz", stop = "3 Hz", count = 3, step = "1 Hz" }',
        ["one of count and step"],
    ),
    "range of two kinds": (
        '[sweep]\nmotion.mesh_frequency = { start = "1 Hz", stop = "3 mm", count = 3 }',
        ["mixes a frequency (1/time) and a length"],
    ),
    "range backwards": (
        '[sweep]\nmotion.mesh_frequency = { start = "1 Hz", stop = "3 Hz", step = "-1 Hz" }',
        ["does not lead from start to stop"],
    ),
    "logarithm of zero": (
        '[sweep]\nload.wheel_torque = { start = "0 N m", stop = "3 N m", count = 3, spacing = "logarithmic" }',
        ["must be above zero"],
    ),
    "misspelt range": (
        '[sweep]\nmotion.mesh_frequency = { begin = "1 Hz", stop = "3 Hz", count = 3 }',
        ["begin", "start, stop"],
    ),
    "endless range": (
        '[sweep]\nmotion.mesh_frequency = { start = "1 Hz", stop = "1e6 Hz", step = "1e-6 Hz" }',
        ["up to 100000"],
    ),
    "too many cases": (
        (
            "[sweep]\naccuracy.contact_nodes = { start = 1, stop = 1000, count = 1000 }\nfriction.coefficient = { start"
            " = 0.1, stop = 1, count = 1000 }"
        ),
        ["makes 1000000 cases"],
    ),
    "section and its field": (
        '[sweep]\nfriction = ["absent", "present"]\nfriction.coefficient = [0.1]',
        ["friction.coefficient is given twice"],
    ),
    "two loads": (
        '[sweep]\nload.wheel_torque = ["1 N m"]\nload.pinion_torque = ["2 N m", "3 N m"]',
        ["sweep.load.pinion_torque", "gives the load, as load.wheel_torque does"],
    ),
    "set and swept": ('[set]\nmotion.mesh_frequency = "1 Hz"\n[sweep]\n' + FREQUENCIES, ["is swept too"]),
    "same case twice": (
        '[sweep]\nmotion.mesh_frequency = ["200 Hz", "0.2 kHz"]',
        ["case 0", "case 1", "the same scene"],
    ),
    "effects that do not fit": ('[sweep]\ninertia = ["present", "absent"]', ["damping", "inertia", "needs"]),
    "impossible gears": ('[sweep]\ngears.centre_distance = ["91.5 mm", "95.5 mm"]', ["contact ratio", "95.5 mm"]),
    "half a relief": ('[sweep]\ntip_relief.depth = ["10 um"]', ["tip_relief.start", "is missing"]),
}


@pytest.mark.parametrize("name", WRONG)
def test_wrong_studies_are_refused_before_anything_is_written(folder, capsys, name):
    """Hard case 26."""
    text, fragments = WRONG[name]
    study = write_study(folder, text)
    before = sorted(folder.rglob("*"))
    assert main(["study", str(study)]) == 2
    error = capsys.readouterr().err
    assert str(study) in error
    for fragment in fragments:
        assert fragment in error
    assert sorted(folder.rglob("*")) == before


def test_a_wrong_base_scene_is_told_as_the_scenes_own_mistake(folder, capsys):
    """Hard case 26."""
    study = write_study(folder, "[sweep]\n" + FREQUENCIES)
    scene = folder / "pair.toml"
    scene.write_text(scene.read_text().replace('"4.5 mm"', '"4.5"'))
    assert main(["study", str(study)]) == 2
    assert "pair.toml:" in capsys.readouterr().err


def test_a_mistake_of_many_cases_is_said_once(folder, capsys):
    """Authority: one cause, one message."""
    study = write_study(
        folder,
        '[set]\nmotion.recorded_cycles = 9\n[sweep]\nload.wheel_torque = { start = "1 N m", stop = "9 N m", count ='
        " 50 }",
    )
    assert main(["study", str(study)]) == 2
    error = capsys.readouterr().err
    assert error.count("recorded_cycles") == 1 and "1 mistake" in error


@pytest.mark.parametrize(
    "path, value",
    [
        (("gears", "pinion", "teeth"), 17),
        (("load", "power"), "1 kW"),
        (("friction", "coefficient"), 0.1),
        (("gears",), fields.ABSENT),
        (("gears", "material", "name"), fields.ABSENT),
    ],
)
def test_a_change_leaves_the_base_scene_as_it_was(path, value):
    """Its own changes, not those of the cases before it."""
    tree = {"gears": {"pinion": {"teeth": 16}}, "load": {"wheel_torque": "1 N m"}}
    before = copy.deepcopy(tree)
    changed = fields.changed(tree, path, value)
    assert tree == before
    for name in path[:-1]:
        changed = changed.get(name, {})
    assert changed.get(path[-1], fields.ABSENT) == value and "wheel_torque" not in changed


LISTED = {
    "shafts": {"input": {"sections": [{"length": "10 mm", "diameter": "28 mm"}, {"length": "60 mm"}]}},
    "bearings": {"pinion": [{"at": "12 mm", "rolling": {"number": 9}}, {"at": "85 mm"}]},
}


@pytest.mark.parametrize(
    ("path", "value", "found"),
    [
        ("shafts.input.sections.2.diameter", "35 mm", {"length": "60 mm", "diameter": "35 mm"}),
        ("bearings.pinion.1.rolling.clearance", "10 um", {"number": 9, "clearance": "10 um"}),
        ("bearings.pinion.2", fields.ABSENT, 1),
    ],
)
def test_tables_that_are_listed_are_counted_from_1(path, value, found):
    """The places in the list; the scene that is changed stays."""
    before = copy.deepcopy(LISTED)
    path = tuple(path.split("."))
    assert fields.why_unknown(path) is None
    changed = fields.changed(LISTED, path, value)
    shaft, bearings = changed["shafts"]["input"]["sections"][1], changed["bearings"]["pinion"]
    assert found in (shaft, bearings[0]["rolling"], len(bearings))
    assert LISTED == before
    assert value_at(changed, *path) == (None if value == fields.ABSENT else value)
    written = {"bearings": {"pinion": {"each": LISTED["bearings"]["pinion"]}}}
    if path[0] == "bearings":
        assert fields.changed(written, path, value)["bearings"]["pinion"]["each"] == bearings


def test_a_table_that_is_not_in_the_list_is_told():
    """How many there are."""
    assert fields.is_numeric(("bearings", "wheel", "1", "rolling", "clearance"))
    assert "no section or field" in fields.why_unknown(("gears", "1", "module"))
    assert "no section or field" in fields.why_unknown(("bearings", "pinion", "1", "rolling", "module"))
    with pytest.raises(SceneError, match="the scene has 2 of these tables"):
        fields.changed(LISTED, ("bearings", "pinion", "3", "at"), "1 mm")
