"""The report on a study."""

import json
import shutil

import numpy as np
import pytest
import xarray as xr
from tests.extensions.report.pages import seen

from fenics_gears.commands.cli import main
from fenics_gears.show.cases import Cases
from fenics_gears.show.study_charts import over_parameter
from fenics_gears.studies.combine import load_combined, save_study

pytestmark = pytest.mark.usefixtures("without_stills")
SECTIONS = [
    "summary",
    "failures",
    "warnings",
    "results",
    "outstanding",
    "cases",
    "effort",
    "versions",
    "study",
    "scene",
]


def page_of(directory, *options):
    assert main(["report", str(directory), "--quiet", *options]) == 0
    return seen(directory / "report.html")


def figures(page):
    names = [attributes["aria-label"] for tag, attributes in page.tags if attributes.get("class") == "curves"]
    return dict(zip(names, map(json.loads, page.scripts)))


def test_cases_and_curves_are_those_of_the_file(study):
    """The study's own dataset, read by xarray alone."""
    page = page_of(study)
    with xr.open_dataset(study / "study.nc", engine="h5netcdf") as opened:
        dataset = opened.load()
    assert page.faults == [] and list(page.sections) == SECTIONS and "Three speeds <i>" in page.sections["study"]
    assert all(value.startswith("data:") for _, _, value in page.fetched)
    radius = xr.open_dataset(study / dataset["case_file"].values.ravel()[0], engine="h5netcdf").attrs[
        "base_radius_wheel"
    ]
    drawn = figures(page)["Transmission error, peak to peak, against mesh frequency"]
    for trace, friction, words in zip(drawn["data"], ("absent", "present"), ("without friction", "with friction")):
        assert trace["name"] == words and trace["x"] == [100, 200, 300]
        expected = dataset["peak_to_peak_transmission_error"].sel(friction=friction).values * radius * 1e3
        np.testing.assert_allclose(trace["y"], expected, rtol=1e-6)
    rows = [attributes for tag, attributes in page.tags if tag == "td" and "data-value" in attributes]
    forces = dataset["max_normal_force"].values.ravel()
    assert all(any(attributes["data-value"] == str(float(force)) for attributes in rows) for force in forces)
    assert page.sections["failures"].strip().endswith("None.")


def test_cases_lead_to_their_files_and_to_their_reports(study, tmp_path):
    """To the report where there is one, else to the file; from wherever the page is."""
    copy = tmp_path / "with a space" / "out"
    shutil.copytree(study, copy)
    files = sorted((copy / "cases").glob("*.nc"))
    assert main(["report", str(files[0]), "--quiet", "--no-stress"]) == 0
    assert files[0].with_suffix(".html").is_file()
    for output, start in ((copy / "report.html", "cases"), (tmp_path / "report.html", "with%20a%20space/out/cases")):
        assert main(["report", str(copy), "--quiet", "--output", str(output)]) == 0
        links = [attributes["href"] for tag, attributes in seen(output).tags if tag == "a"]
        assert f"{start}/{files[0].stem}.html" in links and f"{start}/{files[1].name}" in links


def changed(study, directory, change):
    dataset = load_combined(study / "study.nc")
    change(dataset)
    save_study(dataset, directory)
    return directory


def test_failed_and_missing_cases_are_named(study, tmp_path):
    """`failed` and `failure` of the dataset; else not computed yet."""

    def fail(dataset):
        for name in ("peak_to_peak_transmission_error", "mean_transmission_error", "max_normal_force", "wall_time"):
            dataset[name][0, 0] = np.nan
            dataset[name][2, 1] = np.nan
        # Texts of one length, as some xarrays read them, would cut a longer one off.
        dataset["failure"] = dataset["failure"].astype(object)
        dataset["failed"][0, 0], dataset["failure"][0, 0] = 1, "no <equilibrium> & no end"
        for place in ((0, 0), (2, 1)):
            dataset["case_file"][place] = ""
            dataset["warnings"][place] = ""

    page = page_of(changed(study, tmp_path, fail))
    assert (
        "no <equilibrium> & no end" in page.sections["failures"]
        and "mesh frequency 100 Hz, without friction" in page.sections["failures"]
    )
    assert "of 6 cases 1 failed, 1 not computed yet" in (tmp_path / "report.html").read_text()
    assert "missing" in page.sections["cases"] and page.faults == []
    curves = figures(page)["Transmission error, peak to peak, against mesh frequency"]["data"]
    assert curves[0]["y"][0] is None and curves[1]["y"][2] is None


def made_up(**axes):
    shape = tuple(map(len, axes.values()))
    coordinates = {
        name: (name, np.asarray(values), {"long_name": f"load.{name}", "units": "N"}) for name, values in axes.items()
    }
    place = sum(np.meshgrid(*(np.arange(float(length)) for length in shape), indexing="ij"), 1.0)
    names = ("peak_to_peak_transmission_error", "mean_transmission_error", "max_normal_force")
    values = {name: (tuple(axes), place) for name in names}
    texts = {name: (tuple(axes), np.full(shape, "", dtype=object)) for name in ("case_file", "warnings", "failure")}
    return xr.Dataset(values | texts | {"failed": (tuple(axes), np.zeros(shape, dtype=int))}, coordinates)


def drawn(tmp_path, **axes):
    cases = Cases(made_up(**axes), tmp_path / "study.nc", tmp_path / "report.html")
    return over_parameter(cases, *cases.measures["max_normal_force"])


def test_many_lines_become_a_map_or_a_choice(tmp_path):
    """A legend of dozens cannot be read: two fields of numbers become a map, of more some are drawn, and it is said."""
    few = drawn(tmp_path, torque=[1.0, 2.0, 3.0], offset=[4.0, 5.0])
    assert [curve.name for curve in few.curves] == ["offset 4 N", "offset 5 N"] and not few.logarithmic
    chart = drawn(tmp_path, torque=np.geomspace(1.0, 1000.0, 20), offset=np.arange(15.0))
    assert chart.logarithmic == "x" and chart.field.values.shape == (15, 20) and chart.field.values[14, 19] == 34.0
    # Cells end half-way between the values, by factors where these are factors.
    assert (
        chart.field.x[1] ** 2 == pytest.approx(np.prod(np.geomspace(1.0, 1000.0, 20)[:2])) and chart.field.y[1] == 0.5
    )
    many = drawn(
        tmp_path, torque=[1.0, 2.0, 3.0, 4.0], offset=np.arange(3.0), width=np.arange(3.0), height=np.arange(3.0)
    )
    assert len(many.curves) == 12 and "12 of 27 combinations" in many.note


def test_damaged_and_missing_files_are_said(study, tmp_path, capsys):
    """The digest at the file's end; nothing is written."""
    content = bytearray((study / "study.nc").read_bytes())
    content[len(content) // 2] ^= 1
    (tmp_path / "study.nc").write_bytes(content)
    assert main(["report", str(tmp_path)]) == 2
    assert "does not hold what was written into it" in capsys.readouterr().err
    (tmp_path / "study.nc").unlink()
    (tmp_path / "cases").mkdir()
    assert main(["report", str(tmp_path)]) == 2
    assert "run the study again" in capsys.readouterr().err
    assert [file.name for file in tmp_path.iterdir()] == ["cases"]
