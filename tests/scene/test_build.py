"""A scene from plain dictionaries, against the same scene read from a file."""

import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from tests.programs import python

import fenics_gears
from fenics_gears import SceneError, build_scene, load_scene, scene_from_text

DEMOS = sorted((Path(__file__).parents[2] / "demos").glob("*.toml"))
SCENES = [path for path in DEMOS if "sweep" not in tomllib.loads(path.read_text())]
DEMO = tomllib.loads((DEMOS[0].parent / "lundvall2004.toml").read_text())


def facts(scene):
    return {name: value for name, value in vars(scene).items() if name not in ("text", "written")}


@pytest.mark.parametrize("path", SCENES, ids=lambda path: path.stem)
def test_dictionaries_make_the_scene_that_the_file_makes(path):
    """`load_scene`, over every demo; the carried text makes it again."""
    built = build_scene(tomllib.loads(path.read_text()), path.stem, directory=path.parent)
    assert facts(built) == facts(load_scene(path))
    assert scene_from_text(built.text, path.stem, directory=path.parent) == built


def test_values_of_numpy_tuples_and_none_are_taken():
    """The same scene in plain Python."""
    damping = {"ratios": (0.05, np.float64(0.1))}
    sections = DEMO | {"damping": damping, "friction": {"coefficient": np.float64(0.1)}, "tip_relief": None}
    sections["gears"] = DEMO["gears"] | {"material": DEMO["gears"]["material"] | {"youngs_modulus": "206 GPa"}}
    plain = DEMO | {"damping": {"ratios": [0.05, 0.1]}, "friction": {"coefficient": 0.1}}
    plain["gears"] = sections["gears"]
    plain.pop("tip_relief", None)
    assert build_scene(sections) == build_scene(plain)
    assert build_scene(sections | {"damping": {"ratios": np.array([0.05, 0.1])}}) == build_scene(plain)


def test_mistakes_are_named_by_field_and_without_lines_of_a_text_that_nobody_wrote():
    """The messages of a file, which name lines besides."""
    with pytest.raises(SceneError) as caught:
        build_scene(DEMO | {"load": {"wheel_torque": 437}, "frictoin": {}}, "mine")
    assert "mine: load.wheel_torque = 437\n    is a number without its unit." in str(caught.value)
    assert 'mine: [frictoin]\n    is not a known section or field of a scene. Did you mean "friction"?' in str(
        caught.value
    )
    assert str(caught.value).endswith("2 mistakes in mine. Nothing was computed or written.")


@pytest.mark.parametrize(
    ("sections", "said"),
    [
        ({"load": {"wheel_torque": object()}}, "is neither a text nor a number"),
        ({"load": {437: "437 N m"}}, "the name 437 is no text"),
        ({"load": {"wheel torque": "437 N m"}}, 'load.wheel torque = "437 N m"'),
    ],
)
def test_what_no_file_can_hold_is_refused(sections, said):
    """TOML."""
    with pytest.raises(SceneError, match=said):
        build_scene(DEMO | sections)
    with pytest.raises(SceneError, match="NoneType is no dictionary"):
        build_scene(None)


def test_a_notebook_shows_fields_with_units_and_meanings(paper_scene):
    """The scene file; markup of a title is none of the page's."""
    html = replace(paper_scene, title="<b>paper</b>")._repr_html_()
    assert (
        '<td style="text-align: left">gears.pinion.tip_diameter</td><td style="text-align: left">82.64 mm</td>' in html
    )
    assert (
        "<caption>&lt;b&gt;paper&lt;/b&gt;</caption>" in html
        and "torque that resists the wheel" in html
        and "437 N m" in html
    )
    assert str(paper_scene) == paper_scene.text


def test_names_of_the_package_are_told_without_loading_them():
    """The package's own list, by `dir` and `help` in a process of its own."""
    assert {"load_scene", "build_scene", "simulate", "__version__"} <= {*dir(fenics_gears)}
    assert [name for name in fenics_gears.__all__ if not hasattr(fenics_gears, name)] == []
    program = (
        "import sys, fenics_gears; dir(fenics_gears); print(sorted({'numpy', 'xarray', 'pydantic'} & set(sys.modules)))"
    )
    assert python("-c", program).stdout == "[]\n"
