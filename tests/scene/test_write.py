"""A scene's text follows from its data: `scene_from_text` gives the same data, bit for bit."""

import re
import tomllib
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given, settings
from tests.effects.examples import EXAMPLES, scene_of, with_needs
from tests.hard_cases.random_scenes import valid_scenes
from tests.scene.test_cut_away import RACK, SCENE

from fenics_gears import Load, Material, Scene, SceneError, as_toml, load_scene, scene_from_text, simulate
from fenics_gears.scene.data import Accuracy, Motion
from fenics_gears.scene.parsing import NO_FILE
from fenics_gears.scene.schema import WORDS
from fenics_gears.scene.write import refuse_wrong, section_trees, text_of

DEMOS = Path(__file__).parents[2] / "demos"
SCENES = [
    path
    for path in sorted(DEMOS.rglob("*.toml"))
    if "teeth" in path.read_text() and "sweep" not in (tree := tomllib.loads(path.read_text())) and "stages" not in tree
]
# What no demonstration has, each in a section that the paper's scene then has in place of its own.
FURTHER = {
    "reliefs": (
        '[tip_relief.pinion]\ndepth = "31.3 um"\nstart = "29.61 deg"\nexponent = 1.5\n[tip_relief.wheel]\ndepth = "1'
        ' um"\nlength_on_flank = "0.7 mm"\nshape = "parabolic"\n[root_relief.wheel]\ndepth = "7 um"\nstart = "100.1'
        ' mm"\n'
    ),
    "each its own": (
        '[inertia]\ndensity = "7.85 g/cm^3"\n[inertia.pinion]\nmass = "4.9 kg"\nmoment_of_inertia = "24.5e-3 kg'
        ' m^2"\n[inertia.load]\nmoment_of_inertia = "1 kg m^2"\n[shafts]\n[shafts.input]\ntorsional_stiffness = "1e6 N'
        ' m/rad"\n[shafts.output]\ntorsional_stiffness = "2e6 N m/deg"\n[bearings]\nstiffness_x = "0.1'
        ' kN/um"\nstiffness_y = "0.2 kN/um"\n[damping]\nratios = [0.05, 0.1]\n'
    ),
    "ripple": (
        '[torque_ripple]\nharmonics = [{ order = 1.5, amplitude = "7 lbf in", phase = "17 deg" }, { order = 3,'
        ' amplitude = "1 N m" }]\n'
    ),
    "ramp": (
        '[inertia]\nmass = "4.9 kg"\nmoment_of_inertia = "24.5e-3 kg m^2"\n[speed_ramp]\nend_frequency = "0.137'
        ' kHz"\nhold_cycles = 0\n'
    ),
    "errors": (
        "[flank_errors]\ntolerance_class = 5\nseed = 3\n[flank_errors.pinion]\nprofile_form = ["
        + ", ".join(['"1.7 um"'] * 16)
        + ']\nwaviness = { amplitude = "0.3 um", waves = 31, phase = "12 deg" }\n'
    ),
    "corners": '[corner_contact]\n[corner_contact.wheel]\nedge_radius = "0.07 in"\n',
    "formula": '[friction]\nformula = "Schlenk"\nviscosity = "13 mPa s"\nroughness = "0.4 um"\n',
    "face": (
        '[lead_modifications.pinion]\nend_relief = { depth = "10 um", length = "4 mm", sides = "left", shape ='
        ' "parabolic" }\nhelix_slope = "-3 um"\n[misalignment]\nout_of_plane = "7 um"\n[bearings]\nstiffness = "0.155e6'
        ' N/mm"\nplaces = { pinion = ["-40 mm", "61 mm"] }\n'
    ),
}


def plain(scene: Scene) -> Scene:
    return replace(scene, title="", name="", derived=(), written="", folder="")


def assert_written(scene: Scene) -> None:
    refuse_wrong(scene)
    found = scene_from_text(as_toml(section_trees(scene)), scene.name, directory=Path(scene.folder))
    assert plain(found) == plain(scene) and found.title == (scene.title or scene.name)


@pytest.mark.parametrize("path", SCENES, ids=lambda path: path.stem)
def test_every_demonstration_is_written_from_its_data(path):
    """Over all scenes of the demonstrations."""
    assert_written(load_scene(path))


def test_every_effect_is_written_from_its_data():
    """Over the examples of effects."""
    for section in EXAMPLES:
        assert_written(scene_of(*with_needs(section, "tooth_elasticity")))
    base = scene_of("tooth_elasticity").text.replace("mesh_cycles = 1\n", "mesh_cycles = 3\n")
    for more in FURTHER.values():
        assert_written(scene_from_text(base + more))


def test_gears_and_motions_that_no_demonstration_has_are_written_from_their_data(paper_scene):
    """A width, place, rack and web of a gear's own, other lengths of a run."""
    web = '[gears.pinion.web]\nrim_inner_diameter = "45 mm"\nwidth = "5.1 mm"\n'
    own = 'face_width = "23 mm"\naxial_offset = "1.5 mm"\n' + web
    assert_written(scene_from_text(SCENE.format(gears=RACK, pinion=own)))
    for cycles in ('mesh_cycles = "hunting tooth period"', 'settling_time = "0.05 s"'):
        text = re.sub("recorded_cycles = .*", "", paper_scene.text)
        assert_written(scene_from_text(re.sub("mesh_cycles = .*", cycles, text)))


@settings(max_examples=4)
@given(valid_scenes())
def test_random_scenes_are_written_from_their_data(scene):
    """Over random gears, loads, speeds and effects."""
    assert_written(scene)


@pytest.mark.nightly
@settings(max_examples=500)
@given(valid_scenes())
def test_many_random_scenes_are_written_from_their_data(scene):
    """The same, and with a larger load, where the other sections stay as written."""
    assert_written(scene)
    changed = replace(scene, load=Load(1.03 * scene.load.wheel_torque))
    assert plain(scene_from_text(changed.text)) == plain(changed) and changed.text.count("\n") > 10


def test_a_change_shows_in_the_text_and_the_rest_stays_as_written(paper_scene):
    """Untouched sections keep the file's spelling, 62.50 mm."""
    assert "# " in paper_scene.text and paper_scene.text == paper_scene.written
    changed = replace(
        paper_scene,
        title="Another",
        friction=None,
        load=Load(1e5),
        motion=Motion(150.0, 3, 2),
        accuracy=Accuracy(target=0.01),
    )
    found = scene_from_text(changed.text, paper_scene.name)
    assert found == changed and found.title == "Another"
    assert (
        '"62.50 mm"' in changed.text
        and "[friction]" not in changed.text
        and 'wheel_torque = "100 N m"' in changed.text
        and 'target = "1 %"' in changed.text
    )
    assert (
        replace(changed, load=paper_scene.load).load
        == scene_from_text(replace(changed, load=paper_scene.load).text).load
    )


def test_what_no_file_gives_is_said(paper_scene):
    """A Poisson's ratio that no file may have."""
    material = Material(206e3, 0.6)
    odd = replace(
        paper_scene,
        gears=replace(
            paper_scene.gears,
            material=material,
            **{name: replace(getattr(paper_scene.gears, name), material=None) for name in ("pinion", "wheel")},
        ),
    )
    text = text_of(odd)
    assert text.startswith(NO_FILE) and "gears.material.poissons_ratio = 0.6" in text and text.count("\n") == 1
    with pytest.raises(SceneError):
        scene_from_text(text)
    assert set(WORDS) <= set(Scene.__dataclass_fields__)


@pytest.mark.parametrize(
    "section, changes, words",
    [
        ("load", {"wheel_torque": float("nan")}, "load.wheel_torque = .*not a finite number"),
        ("load", {"wheel_torque": "437 N m"}, "load.wheel_torque = '437 N m' is of type str. Allowed: a number"),
        ("accuracy", {"steps_per_mesh_cycle": 0}, "is zero. Allowed: a whole number from 2"),
        ("accuracy", {"steps_per_mesh_cycle": 20.5}, "is of type float. Allowed: a whole number"),
        ("motion", {"mesh_cycles": -2}, "is negative. Allowed: a whole number from 1"),
    ],
)
def test_a_scene_changed_to_what_no_file_may_have_is_refused(paper_scene, section, changes, words):
    """Standard: what `gears check` says of a file with the same values. A scene that a file may have passes."""
    refuse_wrong(paper_scene)
    with pytest.raises(SceneError, match=f"(?s){words}.*Nothing was computed"):
        simulate(replace(paper_scene, **{section: replace(getattr(paper_scene, section), **changes)}))
    for name, value, kind in (
        ("load", None, "NoneType"),
        ("friction", 0.1, "float"),
        ("inertia", paper_scene.load, "Load"),
    ):
        with pytest.raises(SceneError, match=f"{name} = .* is of type {kind}. Allowed: the data of a scene"):
            simulate(replace(paper_scene, **{name: value}))
