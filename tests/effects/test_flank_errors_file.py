"""Deviations of teeth from tables."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from tests.paper_text import PAPER

from fenics_gears import SceneError, gear_pair, load_scene, scene_from_text
from fenics_gears.commands.work.scenes import checked_model
from fenics_gears.geometry.flank_deviations import flank_deviations
from fenics_gears.geometry.flank_errors import GearErrors

DEMOS = Path(__file__).parents[2] / "demos"
PITCHES = [3.0, -3.0, *(0.0,) * 14]


@pytest.fixture
def scene_with(tmp_path):
    """Writes a table and reads a scene that names it."""

    def read(table, more=""):
        if table is not None:
            (tmp_path / "pinion.csv").write_bytes(table if isinstance(table, bytes) else table.encode())
        (tmp_path / "pair.toml").write_text(f'{PAPER}\n[flank_errors.pinion]\nfile = "pinion.csv"\n{more}\n')
        return checked_model(tmp_path / "pair.toml").scene

    return read


def table(heading="tooth, pitch (um)", rows=PITCHES, first=1, joint=", "):
    return "\n".join([heading, *(f"{tooth}{joint}{row}" for tooth, row in enumerate(rows, first))])


def test_the_example_has_what_the_class_draws():
    """Identity: the drawn deviations, rounded to 0.1 um; a cumulative one sums the roundings of its pitches."""
    drawn, listed = (load_scene(DEMOS / "flank_errors" / f"{name}.toml") for name in ("flank_errors", "measured"))
    assert replace(listed, flank_errors=None, title="", name="") == replace(drawn, flank_errors=None, title="", name="")
    pair = gear_pair(drawn.gears)
    for found, expected in zip(flank_deviations(listed.flank_errors, pair), flank_deviations(drawn.flank_errors, pair)):
        np.testing.assert_allclose(found.slope, expected.slope, atol=0.0501e-3)
        np.testing.assert_allclose(found.form, expected.form, atol=0.0501e-3)
        np.testing.assert_allclose(found.index, expected.index, atol=24 * 0.0501e-3)
        assert found.waviness == expected.waviness


@pytest.mark.parametrize(
    "text",
    [
        table(),
        table("\ufefftooth,pitch [um]", joint=","),
        table("tooth;pitch (µm)", joint=";"),
        table("tooth\tpitch (um)", joint="\t"),
        table("tooth, pitch", [f"{value} um" for value in PITCHES]),
        "# a note\n\n" + table("tooth, pitch (mm)", [1e-3 * value for value in PITCHES]),
        "\r\n".join(["tooth, pitch (um)", *(f"{tooth}, {PITCHES[tooth - 1]}" for tooth in range(16, 0, -1))]),
    ],
)
def test_a_table_is_read_however_it_is_written(scene_with, text):
    """Definition: separators, units, byte order mark, line ends and the order of lines do not matter."""
    found = scene_with(text).flank_errors.pinion
    assert found.pitch == pytest.approx((0.003, -0.003, *(0.0,) * 14), rel=1e-14)
    assert found.profile_slope is None and found.file == "pinion.csv"


WRONG = {
    "no file": (None, ["pinion.csv: there is no such file", "from the scene file's folder on"]),
    "a workbook": (b"PK\x03\x04\xff\xfe", ["is not a text in UTF-8", "not a workbook"]),
    "NUL": (table().replace("-3.0", "-3.0\0"), ["is not a text: it has the character NUL in line 3", "not a workbook"]),
    "an endless field": (
        table().replace("-3.0", "9" * 200_000),
        ["pinion.csv:3: is no line of a table: field larger than field limit", "cells parted by commas"],
    ),
    "nothing": ("", ["has no teeth", "`tooth, pitch (um), profile_slope (um)`"]),
    "a column of another name": (
        table("tooth, fp (um)"),
        ["pinion.csv:1:", 'the column "fp"', 'Did you mean "pitch"?'],
    ),
    "no column of teeth": ("pitch (um)\n1\n", ["pinion.csv:1: has no column tooth"]),
    "no deviations": ("tooth\n1\n", ["pinion.csv:1: has no deviations"]),
    "a column twice": ("tooth, pitch (um), pitch (um)\n1, 2, 3", ["has the column pitch twice"]),
    "a wrong unit": (table("tooth, pitch (N)"), ['pitch in "N", which is no unit of length', "pitch (um)"]),
    "no unit": (table("tooth, pitch"), ["pinion.csv:2:", "is a number without unit, not a length", "pitch (um)"]),
    "a comma in a number": (
        table().replace("-3.0", "-3,0"),
        ["pinion.csv:3: has 3 columns, the first line 2", "decimal sign is a point"],
    ),
    "another comma": (
        table("tooth;pitch (um)", joint=";").replace("-3.0", "-3,0"),
        ["pinion.csv:3: pitch", "the decimal sign is a point"],
    ),
    "a word": (table().replace("-3.0", "bad"), ['pinion.csv:3: pitch = "bad"', "does not begin with a number"]),
    "not a number": (table().replace("-3.0", "nan"), ["pinion.csv:3:", "is no number"]),
    "a tooth twice": (table().replace("\n2,", "\n1,"), ["pinion.csv:3: has tooth 1 again"]),
    "a tooth of zero": (table(first=0), ['pinion.csv:2: has the tooth "0"', "from 1 on"]),
    "a tooth left out": (table().replace("\n5,", "\n17,"), ["has 16 teeth, but none of number 5"]),
    "too few teeth": (table(rows=PITCHES[:15]), ["has 15 teeth, but the pinion has 16"]),
    "pitches that do not close": (
        table(rows=[3.0] * 16),
        ["pitch sums to 48 um over the whole turn", "not cumulative ones"],
    ),
    "no error of manufacture": (
        table(rows=[500.0, -500.0, *PITCHES[2:]]),
        ["pitch of tooth 1 is 0.5 mm", "up to 0.45 mm"],
    ),
}


@pytest.mark.parametrize("name", WRONG)
def test_a_wrong_table_is_refused(scene_with, name):
    """Field, file, line, what is allowed; nothing is computed."""
    text, said = WRONG[name]
    with pytest.raises(SceneError) as refused:
        scene_with(text)
    for words in (
        'flank_errors.pinion.file = "pinion.csv": ',
        "Allowed: " if text is not None else "folder on",
        "Nothing was computed or written.",
        *said,
    ):
        assert words in str(refused.value)


def test_a_deviation_from_two_places_is_refused(scene_with):
    with pytest.raises(SceneError, match="the table has pitch, which the scene has, too. Leave one of the two out"):
        scene_with(table(), "pitch = [" + ", ".join(['"0 um"'] * 16) + "]")


def test_a_scene_whose_table_is_gone_can_be_looked_at():
    """A result is drawn from the scene that it carries."""
    found = scene_from_text(f'{PAPER}\n[flank_errors.wheel]\nfile = "gone.csv"\n').flank_errors
    assert (
        found.wheel.pitch is None and "there is no such file" in found.wheel.problem[1] and found.pinion == GearErrors()
    )
