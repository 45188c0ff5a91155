"""Numbers of the guide are those of the program, or kept beside the pages."""

import csv
import re
from dataclasses import replace

import numpy as np
import pytest
from tests.benchmarks.third_dimension import resolved
from tests.benchmarks.third_dimension.table import read_rows
from tests.docs.blocks import ROOT
from tests.docs.kept_numbers import SCENES, rows

from fenics_gears import build_scene, gear_pair, simulate
from fenics_gears.commands import cli
from fenics_gears.model.description import OVER_THE_FACE
from fenics_gears.model.modification import too_stiff


def told(page, words):
    """Numbers at the places of a sentence that are marked N."""
    text = " ".join((ROOT / page).read_text(encoding="utf-8").split())
    found = re.search(re.escape(words).replace("N", r"(-?\d+(?:\.\d+)?)"), text)
    assert found, f"{page} does not say: {words}"
    return [float(number) for number in found.groups()]


def test_points_of_the_papers_pair(paper_pair):
    """The pair's geometry; docs/model.md, section 1."""
    angle, pitch, ratio = told(
        "docs/model.md", "operating pressure angle of N deg, a base pitch of N mm and a contact ratio of N."
    )
    assert np.degrees(paper_pair.operating_pressure_angle) == pytest.approx(angle, abs=5e-3)
    assert paper_pair.base_pitch == pytest.approx(pitch, abs=5e-3)
    assert paper_pair.contact_ratio == pytest.approx(ratio, abs=5e-3)
    angles = told("docs/model.md", "roll angles of N deg on the pinion and N deg on the wheel")
    assert np.degrees(paper_pair.hpstc_roll_angles) == pytest.approx(angles, abs=5e-3)


def test_mesh_stiffness_of_the_papers_pair(quasi_static_scene):
    """A run without friction and inertia, but for the last digit."""
    mean, single, tangent = told("docs/model.md", "$c_\\gamma$ is N, $c'$ N and the tangent stiffness N")
    result = simulate(replace(quasi_static_scene, friction=None))
    width = 1e3 * quasi_static_scene.gears.face_width
    found = [result.attrs[f"{name}_stiffness"] for name in ("mean_mesh", "single_pair")]
    assert found == pytest.approx([mean, single], abs=0.06)
    assert result.mesh_stiffness_tangent.mean().item() / width == pytest.approx(tangent, abs=0.06)


def test_what_the_default_settings_err_by():
    """The numbers kept of `gears accuracy`."""
    errors = [
        100.0 * float(line["total_error"])
        for name in SCENES
        for line in rows(f"accuracy_{name}")
        if line["name"] == "the program's defaults"
    ]
    least, largest = told("docs/accuracy.md", "the error is N to N %")
    assert (round(min(errors), 2), round(max(errors), 2)) == (least, largest)


def test_how_near_resolved_models_are():
    """The numbers kept of the resolved models: approach by default sizes, line loads in many slices."""
    cases = {}
    for row in read_rows(resolved.NAME):
        key = (row["helix_angle"], row["phase"], row["opening"], row[resolved.BY_DEFAULTS])
        cases.setdefault(key, []).append(row)
    most, at_edges = told("docs/third_dimension.md", "approach of the gears | N %; N % where tip edges touch")
    (line_load,) = told("docs/third_dimension.md", "at the phase that is resolved most finely | N % of the largest")
    for (_, phase, _, by_defaults), slices in cases.items():
        off = 100.0 * abs(slices[0]["approach"] / slices[0]["reference_approach"] - 1.0)
        # Over half of the phases have a pair that touches with a tip edge.
        assert off < (at_edges if phase > 0.5 else most) + 0.05
        if phase == 0.35 and not by_defaults:
            load, exact = (np.array([row[name] for row in slices]) for name in ("line_load", "reference"))
            assert 100.0 * np.abs(load - exact).max() / exact.max() < line_load + 0.05


def test_how_near_hertz_and_the_standards_are():
    """The numbers kept of the comparisons."""
    (hertz,) = told("docs/third_dimension.md", "axis ratios of 3 to 40 | N %")
    fine = [row for row in read_rows("crowned") if row["layer"] < 0.5]
    names = ("peak_pressure", "short_axis", "long_axis", "line_load", "approach")
    assert len(fine) == 5 and max(100.0 * abs(row[name]) for row in fine for name in names) < hertz + 0.05
    stiffer = [100.0 * (row["mesh"] / row["standard_mesh"] - 1.0) for row in read_rows("tooth_stiffness")]
    least, largest = told("docs/third_dimension.md", "mesh stiffness of spur and helical pairs | N to N % stiffer")
    assert (round(min(stiffer)), round(max(stiffer))) == (least, largest)
    above = [
        100.0 * (row["single_pair"] / row["iso_6336"] - 1.0)
        for row in read_rows("misaligned")
        if 5.0 <= row["misalignment"] <= 40.0
    ]
    least, largest = told("docs/third_dimension.md", "misaligned by 5 to 40 µm | N to N % above")
    assert (round(min(above)), round(max(above))) == (least, largest)


def test_how_much_contact_undercut_takes():
    """ISO 21771's contact ratio; the path of contact with undercut."""
    with_it, without = told("docs/evidence/geometry.md", "has a contact ratio of N in place of N.")
    gear = {"profile_shift": 0, "bore_diameter": "16 mm"}
    gears = {"module": "4 mm", "pressure_angle": "20 deg", "face_width": "20 mm", "backlash": "0.1 mm"}
    gears |= {"pinion": gear | {"teeth": 13}, "wheel": gear | {"teeth": 25}}
    pair = gear_pair(build_scene({"gears": gears, "load": {"wheel_torque": "100 N m"}}).gears)
    tips = sum(np.sqrt(each.tip_radius**2 - each.base_radius**2) for each in (pair.pinion, pair.wheel))
    assert (tips - pair.line_of_action_length) / pair.base_pitch == pytest.approx(without, abs=5e-4)
    assert pair.contact_ratio == pytest.approx(with_it, abs=5e-4)


def test_how_thin_a_rim_may_be(paper_pair):
    """The program's law, which tests/model/test_rim.py holds."""
    words = "From a bore of about N root diameters on a warning says how far off that is. "
    words += "At that size the deflection of a flank is N %"
    bore, off = told("docs/drawing.md", words)
    gear = replace(paper_pair.wheel, bore_radius=bore * paper_pair.wheel.root_radius)
    assert too_stiff(gear) == pytest.approx(off, abs=0.5)


@pytest.mark.nightly
def test_the_rating_is_as_shown(tmp_path, monkeypatch):
    """`gears rate` of the demo with root stress, but for the last digits."""
    scene = (ROOT / "demos" / "lundvall2004.toml").read_text(encoding="utf-8") + "\n[output]\nroot_stress = true\n"
    (tmp_path / "pair.toml").write_text(scene, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    assert cli.main(["run", "pair.toml", "--quiet"]) == 0 and cli.main(["rate", "results/pair"]) == 0
    with open(tmp_path / "results" / "pair" / "rating.csv", encoding="utf-8", newline="") as opened:
        found = sorted(float(cell) for line in csv.reader(opened) for cell in line if re.fullmatch(r"[\d.e+-]+", cell))
    page = (ROOT / "docs" / "rating.md").read_text(encoding="utf-8").partition("## What is compared")[0]
    shown = [float(number) for number in re.findall(r"\| (\d+(?:\.\d+)?) (?=\|)", page.replace("|\n", "| \n"))]
    assert len(shown) > 15
    assert not [number for number in shown if min(abs(each / number - 1.0) for each in found if each) > 6e-3]


def test_number_of_hard_cases():
    """The headings of their page, which is made from their tests."""
    (said,) = told("README.md", "has the N cases that are tested for numerical stability")
    assert said == len(re.findall(r"^## \d+\. ", (ROOT / "docs/hard_cases.md").read_text(encoding="utf-8"), re.M))


def test_variables_of_the_environment_are_on_the_page_of_the_commands():
    """All that the program and its launcher read."""
    sources = [ROOT / "gears", ROOT / "setup/install", *(ROOT / "fenics_gears").rglob("*.py")]
    *read, told = (set(re.findall(r"\bFENICS_GEARS_[A-Z_]+\b", file.read_text(encoding="utf-8")))
                   for file in [*sources, ROOT / "docs/commands.md"])  # fmt: skip
    assert any(read) and set().union(*read) <= told


def test_page_and_check_name_the_same_way_out_of_plane_strain():
    """Two ways would make a reader look for the difference."""
    (section, field) = re.match(r"(\[\w+\]) with (\w+ = \"[^\"]+\")", OVER_THE_FACE).groups()
    page = (ROOT / "docs/third_dimension.md").read_text(encoding="utf-8")
    assert f"To compute it over the face, add `{section}` with `{field}`" in page
