"""Layouts of reports for a customer."""

import datetime

import numpy as np
import pytest

from fenics_gears.errors import SceneError
from fenics_gears.extensions.report.layout import laid_out, load_layout
from fenics_gears.show.pages.page import Page, PageSection
from fenics_gears.show.pages.rendering import rendered

PAGE = Page("Run", "Scene", "", [PageSection(name, name.title(), []) for name in ("summary", "warnings", "geometry")])
# A transmission error of 100 urad is 5 um at 50 000 um a radian.
NUMBERS = {"peak_to_peak_transmission_error": 1e-4, "mesh_efficiency": 0.98, "largest_pair_force": 2100.0}
MICROMETRES = 50_000.0


def layout_of(folder, text):
    file = folder / "layout.toml"
    file.write_text(text, encoding="utf-8")
    return load_layout(file)


def rows_of(folder, text, numbers=NUMBERS):
    page = laid_out(PAGE, layout_of(folder, f"[limits]\n{text}"), numbers, MICROMETRES)
    (section,) = [each for each in page.sections if each.name == "limits"]
    return [[cell.text for cell in row] for row in section.blocks[1].rows], section.blocks[0]


@pytest.mark.parametrize(
    ("limit", "computed", "result"),
    [
        ('peak_to_peak_transmission_error = { at_most = "6 um" }', "5 um", "kept"),
        ('peak_to_peak_transmission_error = { at_most = "4 um" }', "5 um", "off by 25 %"),
        ('peak_to_peak_transmission_error = { at_most = "0.2 mrad" }', "100 urad", "kept"),
        ('mesh_efficiency = { at_least = "99 %" }', "0.98", "off by 1 %"),
        ("mesh_efficiency = { at_least = 0.97 }", "0.98", "kept"),
        ('largest_pair_force = { at_most = "2 kN" }', "2100 N", "off by 5 %"),
        ('peak_contact_pressure = { at_most = "1 GPa" }', "-", "not in this run"),
    ],
)
def test_limits_are_compared_in_their_units(tmp_path, limit, computed, result):
    """By hand."""
    ((_, _, found, said),), words = rows_of(tmp_path, limit)
    assert (found, said) == (computed, result)
    assert words.warns == (result != "kept")


def test_limits_of_a_train_are_kept_by_its_worst_mesh(tmp_path):
    """By hand: 100 and 200 urad are 5 and 4 um on wheels of 50 and 20 mm; the whole has no base circle."""
    numbers = {
        "peak_to_peak_transmission_error": np.array([1e-4, 2e-4]), "peak_to_peak_overall_transmission_error": 3e-4,
        "load_sharing_factor": 1.2,
    }  # fmt: skip
    text = (
        'peak_to_peak_transmission_error = { at_most = "4.5 um" }\n'
        'peak_to_peak_overall_transmission_error = { at_most = "0.4 mrad" }\nload_sharing_factor = { at_most = 1.1 }'
    )
    layout = layout_of(tmp_path, f"[limits]\n{text}")
    (section,) = [
        each for each in laid_out(PAGE, layout, numbers, np.array([5e4, 2e4])).sections if each.name == "limits"
    ]
    said = [[cell.text for cell in row][2:] for row in section.blocks[1].rows]
    assert said == [["5 um", "off by 11 %"], ["300 urad", "kept"], ["1.2", "off by 9.1 %"]]
    with pytest.raises(SceneError, match="is no limit of a number in rad"):
        layout_of(tmp_path, '[limits]\npeak_to_peak_overall_transmission_error = { at_most = "4 um" }')


def test_the_head_says_whose_report_it_is(tmp_path):
    """The layout; its logo is within the page, which loads nothing."""
    (tmp_path / "logo.svg").write_text("<svg/>", encoding="utf-8")
    words = 'title = "Stage 1"\nauthor = "A & B"\nnumber = "R-1"\ndate = "30 November"\nlogo = "logo.svg"\n'
    html = rendered(laid_out(PAGE, layout_of(tmp_path, words), NUMBERS, MICROMETRES))
    for part in ("<h1>Stage 1</h1>", "A &amp; B", "R-1", "30 November", "data:image/svg+xml;base64,PHN2Zy8+"):
        assert part in html
    today = laid_out(PAGE, layout_of(tmp_path, 'author = "A"'), NUMBERS, MICROMETRES).letterhead.rows[-1]
    assert today == ("date", f"{datetime.date.today():%Y-%m-%d}")


def test_sections_come_as_asked_for_and_gear_data_first(tmp_path):
    """The layout; without an order gear data and limits are on the first page."""
    text = 'sections = ["warnings", "summary"]'
    assert [each.name for each in laid_out(PAGE, layout_of(tmp_path, text), {}, 1.0).sections] == [
        "warnings",
        "summary",
    ]
    usual = laid_out(PAGE, layout_of(tmp_path, "[limits]\nmesh_efficiency = { at_least = 0.9 }"), NUMBERS, 1.0)
    assert [each.name for each in usual.sections] == ["geometry", "limits", "summary", "warnings"]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('autor = "A"', 'Did you mean "author"'),
        ('sections = "summary"', "is no list of names"),
        ("limits = 3", "is no section"),
        ("[limits]\nmesh_efficency = { at_least = 0.9 }", 'Did you mean "mesh_efficiency"'),
        ('[limits]\nlargest_pair_force = "2 kN"', 'is no limit of a number in N. Allowed: { at_most = "20 N" }'),
        ('[limits]\nlargest_pair_force = { at_most = "2 um" }', "is no limit of a number in N"),
        ("[limits]\nlargest_pair_force = { at_most = 2 }", "is no limit of a number in N"),
        ('logo = "logo.gif"', "is no picture"),
        ('logo = "none.png"', "there is no such file"),
    ],
)
def test_mistakes_in_a_layout_are_told(tmp_path, text, message):
    """Each says what is allowed."""
    with pytest.raises(SceneError, match=message):
        layout_of(tmp_path, text)


def test_a_section_that_a_page_has_not_is_refused(tmp_path):
    """The page's own sections."""
    with pytest.raises(SceneError, match='sumary is no section of this report. Did you mean "summary"'):
        laid_out(PAGE, layout_of(tmp_path, 'sections = ["sumary"]'), {}, 1.0)
