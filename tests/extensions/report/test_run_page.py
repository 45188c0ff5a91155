"""The report on a run."""

import base64
import csv
import json
import re
from dataclasses import replace

import numpy as np
import pytest
from tests.extensions.report.conftest import DRAWN
from tests.extensions.report.pages import seen
from tests.paper_text import coarse_text

from fenics_gears import results
from fenics_gears.commands.cli import main
from fenics_gears.extensions.measuring import work
from fenics_gears.extensions.measuring.effect_costs.table import CSV_COLUMNS
from fenics_gears.results.pairs import contact_times

pytestmark = pytest.mark.usefixtures("without_stills")
SECTIONS = [
    "summary", "warnings", "geometry", "motion", "forces", "pressure", "stress", "root-stress", "spectra", "numbers",
    "effects", "energy", "solver",
    "versions", "scene",
]  # fmt: skip


def page_of(dataset, directory, *options):
    results.save(dataset, directory / "run.nc")
    assert main(["report", str(directory), "--quiet", "--no-stress", *options]) == 0
    return seen(directory / "report.html")


def captions(page):
    return [attributes["aria-label"] for tag, attributes in page.tags if attributes.get("class") == "curves"]


def test_every_section_is_there_and_says_what_the_result_holds(report, run):
    """The sections' list; the result's file."""
    page, dataset = seen(report), results.load(run / "run.nc")
    assert list(page.sections) == SECTIONS
    micrometres = dataset.attrs["peak_to_peak_transmission_error"] * dataset.attrs["base_radius_wheel"] * 1e3
    assert f"{micrometres:.4g} µm" in page.sections["summary"]
    assert f"{dataset.attrs['dynamic_factor_by_stress']:.3f} by root stress" in page.sections["numbers"]
    for warning in dataset.attrs["warnings"].splitlines():
        assert warning[1:] in page.sections["warnings"]
    assert "elastic torsion of the input" in page.sections["effects"] and "constant speed" in page.sections["effects"]
    assert "contact ratio" in page.sections["geometry"] and "4.5 mm" in page.sections["geometry"]
    assert "lost to friction" in page.sections["energy"] and "lost to damping" in page.sections["energy"]
    assert (
        f"{dataset.attrs['newton_iterations_total']:,}" in page.sections["solver"]
        and "mode 1" in page.sections["solver"]
    )
    assert dataset.attrs["fenics_gears_version"] in page.sections["versions"]
    assert dataset.attrs["scene"] in page.sections["scene"]
    wanted = {
        "Normal force of the mesh",
        "Friction force of the mesh",
        "Load sharing: normal force of each tooth pair",
        "Energy held",
    }
    assert wanted <= set(captions(page))
    assert {"The pair", "Largest contact pressure", "Largest tension in the fillets of either gear"} <= set(
        captions(page)
    )
    assert sum(each.startswith("Transmission error on the wheel's base circle") for each in captions(page)) == 1
    assert any(each.startswith("Contact pressure") for each in captions(page))
    pictures = [attributes for tag, attributes in page.tags if tag == "img"]
    assert [picture["alt"] for picture in pictures if "png" in picture["src"][:20]] == [
        "Von Mises stress of both gears in mesh"
    ]


def test_every_chart_is_an_image_before_any_script_runs(report):
    """Each as an SVG with its axes' words."""
    page = seen(report)
    images = {
        attributes["alt"]: attributes["src"]
        for tag, attributes in page.tags
        if tag == "img" and "svg" in attributes["src"][:20]
    }
    assert list(images) == list(dict.fromkeys(captions(page))) and len(images) > 15
    drawn = base64.b64decode(images[DRAWN].partition(",")[2]).decode()
    assert "<svg" in drawn and "Normal force (N)" in drawn and "Time (mesh cycles since the start)" in drawn


def test_every_chart_is_one_that_plotly_knows(report):
    """plotly's own Python classes."""
    from plotly.graph_objects import Figure

    page = seen(report)
    charts = [Figure(json.loads(script)) for script in page.scripts[: page.plots]]
    assert len(charts) > 15 and all(chart.data for chart in charts)


def test_the_page_is_well_formed(report):
    """HTML: elements closed in order, each id once, each link to a section."""
    page = seen(report)
    assert page.faults == [] and len(page.names) == len(set(page.names))
    links = {attributes["href"] for tag, attributes in page.tags if tag == "a"}
    assert links == {f"#{name}" for name in page.sections}


def test_nothing_is_loaded_from_anywhere(report):
    """Addresses that a browser fetches are all `data:`."""
    page = seen(report)
    assert page.fetched and all(value.startswith("data:") for _, _, value in page.fetched)
    assert not re.search(r"url\(|@import", "".join(page.styles))
    own = page.scripts[-1]
    assert "Plotly.newPlot" in own and not re.search(r"fetch\(|XMLHttpRequest|import\(|https?://", own)


def test_a_scene_without_effects_has_neither_their_curves_nor_their_words(made):
    """House rule 9."""
    bare = made(coarse_text("shafts", "bearings", "inertia", "damping", "friction", recorded=1), "bare")
    assert main(["report", str(bare), "--quiet", "--no-stress"]) == 0
    page = seen(bare / "report.html")
    said = set(captions(page))
    assert not any("riction" in each or "centres" in each or "shaft's end" in each for each in said)
    assert "Friction loss" not in page.sections["summary"] and "Dynamic factor" not in page.sections["summary"]
    assert "lost to" not in page.sections["energy"] and "Natural frequencies" not in page.sections["solver"]
    assert "was not recorded" in page.sections["root-stress"] and "no-stress" in page.sections["stress"]
    assert "does not vary" in page.sections["spectra"]


def test_titles_and_scenes_are_shown_as_they_are_written(run, tmp_path):
    """HTML: neither a tag nor the end of the page's scripts can be made of a title."""
    nasty = "<script>alert('x')</script> </script><!-- & \"quoted\" `code` %{x} 𝄞"
    dataset = results.load(run / "run.nc")
    warned = dataset.assign_attrs(title=nasty, scene=f"# {nasty}\n" + dataset.attrs["scene"], warnings=f"first {nasty}")
    page = page_of(warned, tmp_path)
    assert page.faults == [] and list(page.sections) == SECTIONS
    assert f"# {nasty}" in page.sections["scene"] and "<script>alert('x')" in page.sections["warnings"]
    assert sum(tag == "script" for tag, _ in page.tags) == page.plots + 2
    assert not any("alert" in script for script in page.scripts)


@pytest.mark.parametrize("steps", [0, 1, 8])
def test_an_incomplete_run_says_so(run, tmp_path, steps):
    """The attribute `complete`; of fewer than two steps there is no curve."""
    whole = contact_times(results.load(run / "run.nc"))
    cut = whole.isel(time=slice(0, steps), contact_time=slice(0, steps)).assign_attrs(complete=0, stopped="interrupted")
    page = page_of(cut, tmp_path)
    text = (tmp_path / "report.html").read_text()
    assert "INCOMPLETE RUN. It was interrupted." in text and list(page.sections) == SECTIONS and page.faults == []
    assert any(each.startswith("Transmission error on") for each in captions(page)) == (steps == 8)
    assert "of what is stored" in page.sections["summary"] or steps == 0


def test_a_result_without_meaning_says_so_before_anything(run, tmp_path):
    """The run's own warning, above all sections."""
    page_of(results.load(run / "run.nc").assign_attrs(warnings="a word\nthe result has no meaning: jammed"), tmp_path)
    text = (tmp_path / "report.html").read_text()
    assert "NO MEANING: the result has no meaning: jammed." in text.partition('id="summary"')[0]


def measured_lines(dataset, error):
    whole = "bearings damping friction inertia shafts tooth_elasticity"
    for name, sections, compared in (("bare", "tooth_elasticity", ""), ("all", whole, "")):
        line = dict.fromkeys(CSV_COLUMNS, "1") | {
            "effects": name,
            "sections": sections,
            "remarks": "",
            "compared_with": compared,
        }
        line |= {
            "transmission_error_peak_to_peak_mm": str(float(error)),
            "change_of_transmission_error": "0.25",
            "change_of_peak_force": "",
        }
        yield line


def write_measured(directory, lines):
    with open(directory / "effects.csv", "w", newline="") as opened:
        writer = csv.DictWriter(opened, CSV_COLUMNS)
        writer.writeheader()
        writer.writerows(lines)
    (directory / "effects.png").write_bytes(b"a picture")


def test_effects_are_measured_when_asked_for(run, tmp_path, monkeypatch):
    """--effects writes what `gears effects` writes, before the page reads it."""
    dataset = results.load(run / "run.nc")
    error = dataset.attrs["peak_to_peak_transmission_error"] * dataset.attrs["base_radius_wheel"]
    asked = []
    measure = lambda scene, progress: asked.append(scene.text) or "measured"  # noqa: E731
    monkeypatch.setattr(work, "EFFECTS", replace(work.EFFECTS, measure=measure))

    def write(own, found, directory, name):
        assert (found, directory, name) == ("measured", tmp_path, "effects")
        write_measured(directory, measured_lines(dataset, error))
        return [directory / "effects.csv"]

    monkeypatch.setattr(work, "write_report", write)
    page = page_of(dataset, tmp_path, "--effects")
    assert asked == [dataset.attrs["scene"]] and "What each effect costs and changes" in page.sections["effects"]


def test_a_long_run_makes_a_small_page(run, tmp_path):
    """30,000 steps below 10 MB, the highest of them drawn."""
    dataset = (
        results.load(run / "run.nc")
        .drop_dims(["contact_time", "contact_node", "fillet_point", "fillet"], errors="ignore")
        .drop_vars("root_stress_maximum")
    )
    steps = 30_001
    long = dataset.isel(time=np.arange(steps) % dataset.sizes["time"])
    phase = np.arange(steps) / 100.0
    force = long["normal_force"].values.copy()
    force[17_333] = 123_456.0
    long = long.assign_coords(time=phase / 200.0, mesh_phase=("time", phase, dataset["mesh_phase"].attrs)).assign_attrs(
        shown_cycles=300
    )
    long["normal_force"] = ("time", force, dataset["normal_force"].attrs)
    page = page_of(long, tmp_path)
    assert (tmp_path / "report.html").stat().st_size < 10e6
    drawn = page.scripts[captions(page).index("Normal force of the mesh")]
    assert "123456.0" in drawn and drawn.count(",") < 20_000
    assert "The run has 30,001 steps" in page.sections["motion"]


def refusal(capsys, *arguments):
    assert main(["report", *map(str, arguments)]) == 2
    return capsys.readouterr().err


def test_wrong_calls_are_refused_before_anything_is_written(run, tmp_path, capsys):
    """Exit code 2: what was given and what is allowed."""
    assert "no such file or directory" in refusal(capsys, tmp_path / "nowhere")
    assert "neither run.nc nor study.nc" in refusal(capsys, tmp_path)
    assert "give --output such a name" in refusal(capsys, run, "--output", tmp_path / "page.pdf")
    assert "has stored mesh cycles 0 to 1" in refusal(capsys, run, "--at", "7", "--output", tmp_path)
    content = (run / "run.nc").read_bytes()
    (tmp_path / "run.nc").write_bytes(content[: len(content) // 2])
    assert "cannot be read as a result: it does not hold what was written into it" in refusal(capsys, tmp_path)
    (tmp_path / "run.nc").write_bytes(b"no NetCDF at all")
    assert "cannot be read as a result" in refusal(capsys, tmp_path)
    assert {file.name for file in tmp_path.iterdir()} == {"run.nc"}
