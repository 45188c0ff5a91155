"""The README's picture and table of what accuracy costs, from the numbers that are saved."""

import pytest
from tests.benchmarks.accuracy_of_paper import PAGE, PICTURES, scenes
from tests.benchmarks.accuracy_overview import TITLES, Overview, Point, overview, overview_picture, table_lines
from tests.benchmarks.accuracy_saved import saved_report

from fenics_gears.studies.accuracy.table import in_one_sentence

OWN = Point("the scene's own", 0.03, 0.5, True, "steps per mesh cycle", False)
PLAIN = Point("the program's defaults", 0.02, 0.7, False, "steps per mesh cycle", False)
FINE = Point("P2 0.1 mm, 9 nodes, 40 steps, body x4", 0.004, 2.0, True, "flank element size", False)
MODEL = Point("rigid teeth", 1.0, 0.1, False, "the model", True)


def made_up(floor):
    return Overview(
        (MODEL, FINE, OWN, PLAIN), floor, {"processor": "a machine", "load": "0.1", "threads": "1", "versions": "0"}
    )


def test_costs_are_those_of_the_quickest_that_reaches_a_target():
    """Authority: by hand; a cheaper model pays nothing, and what the reference cannot tell is not claimed."""
    sure = made_up(1e-4)
    assert (
        sure.defaults == PLAIN
        and sure.cheapest(0.05) == OWN
        and sure.cheapest(0.01) == FINE
        and sure.cheapest(0.001) is None
    )
    (row,) = table_lines({"200_hz_friction": sure})[2:]
    assert (
        "2 s (P2 0.1 mm, 9 nodes, 40 steps)" in row
        and "3 % in 0.5 s" in row
        and "2 % in 0.7 s" in row
        and "not reached" in row
    )
    (row,) = table_lines({"200_hz_friction": made_up(0.008)})[2:]
    assert "unknown: the reference is uncertain by 0.8 %" in row


@pytest.mark.parametrize("name", TITLES)
def test_what_is_saved_is_read(name):
    """Authority: identity; the committed numbers of every scene that the README tells of."""
    assert name in scenes()
    found = overview(PICTURES / f"accuracy_{name}.csv")
    assert found.own.time > 0.0 and sum(each.model for each in found.points) == 3
    assert [each.time for each in found.front] == sorted(each.time for each in found.front)


def test_the_picture_has_a_panel_for_each_scene():
    """Authority: issue 6; quasi-static and at 200 Hz, with friction and without."""
    figure = overview_picture({name: made_up(1e-3) for name in TITLES})
    assert [axes.get_title(loc="left") for axes in figure.axes] == list(TITLES.values())


@pytest.mark.parametrize("name", TITLES)
def test_a_saved_report_says_what_the_page_says(name):
    """Identity: the page's sentence, the errors charged and the front, which were written with the CSV, follow from it
    again."""
    file = PICTURES / f"accuracy_{name}.csv"
    report = saved_report(scenes()[name], file)
    assert f"**{in_one_sentence(report)}**" in PAGE.read_text(encoding="utf-8")
    saved = overview(file)
    assert {each.name: each.total_error for each in (*report.settings, *report.models)} == pytest.approx(
        {each.name: each.error for each in saved.points}
    )
    assert [each.name for each in report.front] == [each.name for each in saved.front]
