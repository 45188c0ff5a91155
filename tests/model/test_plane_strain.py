"""What `gears check` says of widths and of plane strain."""

from dataclasses import replace

import pytest
from tests.benchmarks.third_dimension import plane_limits
from tests.benchmarks.third_dimension.table import read_rows

from fenics_gears import Material
from fenics_gears.model.description import SOFTER, describe, too_stiff

STEEL = Material(206e3, 0.3)


def model_rows(scene) -> dict:
    return {label: (value, words) for label, value, words in dict(describe(scene))["Model"]}


def test_plane_strain_is_too_stiff_as_the_table_says():
    """docs/evidence/third_dimension.md, plane limits; plane stress is softer by 1/(1 - nu^2)."""
    *between, strain = read_rows(plane_limits.NAME)[1:]
    assert {
        row["width"]: pytest.approx(100.0 * (row["mean"] / strain["mean"] - 1.0), abs=0.006) for row in between
    } == SOFTER
    assert [too_stiff(width, (STEEL, STEEL)) for width in SOFTER] == pytest.approx(list(SOFTER.values()), rel=1e-12)
    assert SOFTER[4.0] > too_stiff(6.0, (STEEL, STEEL)) > SOFTER[8.0]
    assert (
        too_stiff(4.0, (STEEL, Material(206e3, 0.0))) == pytest.approx(0.5 * SOFTER[4.0], rel=1e-12)
        and too_stiff(4.0, (Material(1.0, 0.0),) * 2) == 0.0
    )


def test_check_says_which_width_counts_and_what_plane_strain_leaves_out(paper_scene):
    """Nothing of gears of one width, of wide ones, or over the face."""
    wide = replace(
        paper_scene,
        gears=replace(
            paper_scene.gears,
            wheel=replace(paper_scene.gears.wheel, face_width=30.0),
            pinion=replace(paper_scene.gears.pinion, face_width=15.0),
        ),
    )
    value, words = model_rows(wide)["face width that counts"]
    assert value.startswith("pinion 15 mm, wheel 2") and "common width" in words
    value, words = model_rows(paper_scene)["plane strain"]
    assert value == "about 4.2%" and '[misalignment] with in_plane = "0 um"' in words
    assert "face width that counts" not in model_rows(paper_scene)
    assert "plane strain" not in model_rows(replace(paper_scene, gears=replace(paper_scene.gears, face_width=80.0)))
