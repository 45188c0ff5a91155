"""The report in a browser without a network."""

import numpy as np
import pytest
from matplotlib.image import imread
from tests.extensions.report.browser import CHROMIUM, Browser
from tests.extensions.report.pages import seen

from fenics_gears.commands.cli import main

pytestmark = [pytest.mark.nightly, pytest.mark.skipif(CHROMIUM is None, reason="no chromium")]

PLOTS = "[...document.querySelectorAll('.curves')]"
LINKED = f"{PLOTS}.filter(plot => plot.dataset.linked === 'time')"


@pytest.fixture
def browser(tmp_path):
    with Browser(tmp_path / "profile") as browser:
        yield browser


def check_alone(browser, page):
    """Nothing but the page was fetched; nothing was said in the console; nothing sticks out sideways."""
    assert [each for each in browser.requests if not each.startswith("data:")] == [page.as_uri()]
    assert browser.console == []
    assert browser.value("document.documentElement.scrollWidth <= document.documentElement.clientWidth")


def draw_all(browser):
    """Scroll until every plot has been drawn; how many those are."""
    count = browser.value(f"{PLOTS}.length")
    for place in range(count):
        browser.value(f"{PLOTS}[{place}].scrollIntoView({{behavior: 'instant'}})")
        browser.wait(f"{PLOTS}[{place}].querySelector('svg.main-svg .cartesianlayer path') !== null")
    return count


def test_a_run_is_drawn_and_zoomed_without_a_network(browser, report):
    """Plots are drawn when the window comes to them; those over time are zoomed together."""
    browser.open(report, 1300, 900)
    drawn = browser.value(f"{PLOTS}.filter(plot => plot.querySelector('svg')).length")
    assert draw_all(browser) == seen(report).plots > 15 > drawn
    ends = f"{LINKED}.map(plot => plot.layout.xaxis.range[1])"
    whole = browser.value(ends)
    first, last = browser.value(f"{LINKED}[0].layout.xaxis.range")
    middle = 0.5 * (first + last)
    browser.value(
        f"Plotly.relayout({LINKED}[0], {{'xaxis.range[0]': {first}, 'xaxis.range[1]': {middle}}}).then(() => true)"
    )
    browser.wait(f"{ends}.every(end => end === {middle})")
    browser.value(f"Plotly.relayout({LINKED}[1], {{'xaxis.autorange': true}}).then(() => true)")
    browser.wait(f"{ends}.every(end => end === {last})")
    assert len(whole) > 10 and set(whole) == {last}
    check_alone(browser, report)


def test_a_plot_that_is_drawn_later_has_the_zoom_of_the_others(browser, report):
    """Plots that the window has not come to are zoomed when they are drawn."""
    browser.open(report, 1300, 900)
    browser.value(f"{LINKED}[0].scrollIntoView({{behavior: 'instant'}})")
    browser.wait(f"{LINKED}[0].querySelector('svg.main-svg') !== null")
    first, last = browser.value(f"{LINKED}[0].layout.xaxis.range")
    assert not browser.value(f"Boolean({LINKED}.at(-1).querySelector('svg'))")
    browser.value(
        f"Plotly.relayout({LINKED}[0], {{'xaxis.range': [{first}, {0.5 * (first + last)}]}}).then(() => true)"
    )
    browser.value(f"{LINKED}.at(-1).scrollIntoView({{behavior: 'instant'}})")
    browser.wait(f"{LINKED}.at(-1).querySelector('svg.main-svg') !== null")
    assert browser.value(f"{LINKED}.at(-1).layout.xaxis.range[1]") == 0.5 * (first + last)


def test_all_charts_are_there_to_be_printed(browser, report):
    """Each is an image, also one that was drawn for the screen, none below another; folded parts are opened."""
    browser.open(report, 1300, 900)
    browser.wait(f"{PLOTS}[0].querySelector('svg.main-svg') !== null")
    browser._call("Emulation.setEmulatedMedia", media="print")
    browser.value("dispatchEvent(new Event('beforeprint'))")
    image = "[...figure.querySelectorAll('img')]"
    charts = f"{PLOTS}.map(plot => plot.closest('figure'))"
    whole = f"{image}.length === 1 && {image}[0].complete && {image}[0].getBoundingClientRect().height > 100"
    browser.wait(f"{charts}.every(figure => {whole})")
    ends = "figure.getBoundingClientRect().bottom - figure.querySelector('img').getBoundingClientRect().bottom"
    assert browser.value(f"Math.min(...{charts}.map(figure => {ends}))") >= 0
    assert browser.value(
        f"{PLOTS}.every(plot => !plot.querySelector('svg') || plot.getBoundingClientRect().height === 0)"
    )
    assert browser.value("[...document.querySelectorAll('details')].every(each => each.open)")
    assert browser.console == []


@pytest.mark.parametrize("width", [1300, 400])
def test_a_run_on_a_screen(browser, report, tmp_path, width):
    """On a desk and on a telephone the page is neither blank nor black."""
    browser.open(report, width, 900)
    draw_all(browser)
    height = min(browser.value("document.documentElement.scrollHeight"), 6000)
    browser.open(report, width, height)
    draw_all(browser)
    browser.value("scrollTo({top: 0, behavior: 'instant'})")
    picture = tmp_path / "screen.png"
    browser.photograph(picture)
    pixels = imread(picture)[..., :3]
    assert pixels.shape[:2] == (height, width)
    inked = (pixels.min(axis=2) < 0.9).mean(axis=1)
    assert 0.01 < inked.mean() < 0.5 and all(part.max() > 0.05 for part in np.array_split(inked, 10))
    assert browser.console == [] and browser.value(
        "document.documentElement.scrollWidth <= document.documentElement.clientWidth"
    )


def test_a_study_is_sorted_by_a_click(browser, study, tmp_path):
    """The second click sorts the other way round."""
    page = tmp_path / "study.html"
    assert main(["report", str(study), "--quiet", "--output", str(page)]) == 0
    browser.open(page, 1300, 900)
    column = browser.value(
        "[...document.querySelector('.sortable').tHead.rows[0].cells].findIndex(each =>"
        " each.textContent.startsWith('T_EPP'))"
    )
    sorted_values = f"""(() => {{
        const table = document.querySelector('.sortable');
        table.tHead.rows[0].cells[{column}].querySelector('button').click();
        return [...table.tBodies[0].rows].map(row => Number(row.cells[{column}].dataset.value));
    }})()"""
    up, down = browser.value(sorted_values), browser.value(sorted_values)
    assert up == sorted(up) and down == up[::-1] and len(set(up)) == 6
    draw_all(browser)
    check_alone(browser, page)
