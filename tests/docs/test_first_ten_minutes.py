"""The README's first ten minutes, as a reader goes through them."""

import re

import pytest
from tests.docs.blocks import ROOT, blocks

from fenics_gears import results
from fenics_gears.results.summary import summary_rows
from fenics_gears.scene.read import scene_from_text
from fenics_gears.simulation.simulate import simulate

README = ROOT / "README.md"
DEMO = ROOT / "demos" / "lundvall2004.toml"
# By day tests/docs/test_examples.py runs the same commands and what the README does with their results.
pytestmark = pytest.mark.nightly


@pytest.fixture(scope="module")
def first_run(readers_folder):
    """The result of the first command."""
    return results.load(readers_folder / "results" / "lundvall2004" / "run.nc")


def micrometres(result):
    """Peak-to-peak transmission error on the wheel's base circle, um."""
    return 1e3 * result.attrs["base_radius_wheel"] * result.attrs["peak_to_peak_transmission_error"]


def test_the_summary_is_as_shown(first_run):
    """Authority: the README; its lines are those of the run, with numbers as meshes of other gmsh versions give them."""
    shown = next(block.code for block in blocks(README) if block.language == "text").splitlines()
    assert shown[0] == first_run.attrs["title"]
    rows = {label: value for label, value, _ in summary_rows(first_run)}
    lines = [re.split(r"\s{2,}", line.strip()) for line in shown[1:] if line.strip() != "..."]
    assert len(lines) >= 3
    for label, value in lines:
        numbers = [[float(number) for number in re.findall(r"\d+\.?\d*", text)] for text in (value, rows[label])]
        assert numbers[0] == pytest.approx(numbers[1], rel=5e-3)


def test_the_four_pictures_are_there(readers_folder):
    """Authority: the README."""
    assert "and four pictures are in" in README.read_text(encoding="utf-8")
    assert len(list((readers_folder / "results" / "lundvall2004").glob("*.png"))) == 4


def test_tip_relief_does_what_the_readme_says(first_run):
    """Authority: the README's two numbers; the scene with what it tells to append."""
    text = README.read_text(encoding="utf-8")
    before, after = (float(number) for number in re.search(r"falls from ([\d.]+) to ([\d.]+) um", text).groups())
    appended = next(block.code for block in blocks(README) if block.language == "toml")
    relieved = simulate(scene_from_text(DEMO.read_text(encoding="utf-8") + "\n" + appended, "mine"))
    assert micrometres(first_run) == pytest.approx(before, rel=5e-3)
    assert micrometres(relieved) == pytest.approx(after, rel=1e-2)
