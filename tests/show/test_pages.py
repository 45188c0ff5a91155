"""What pages and pictures of runs are made of: thinned curves, gears in mesh, a page without plotly."""

import sys
from math import pi

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.path import Path
from scipy.spatial import cKDTree
from tests.show.synthetic import made_up_run

from fenics_gears.show.chart import Chart, Curve
from fenics_gears.show.pages.page import Page, PageSection
from fenics_gears.show.pages.rendering import plotly_library, rendered
from fenics_gears.show.pair_drawing import _on_line, gear_outline
from fenics_gears.show.panels import thinned
from fenics_gears.show.run import ShownRun


@given(st.lists(st.floats(-1e6, 1e6) | st.just(float("nan")), min_size=1, max_size=400), st.sampled_from([10, 40]))
def test_thinned_curves_keep_peaks_ends_and_gaps(values, most):
    """The whole curve: its extremes, its ends, and a gap in each slice that has one."""
    values = np.array(values)
    places = thinned(values, most)
    assert places[0] == 0 and places[-1] == len(values) - 1 and (np.diff(places) > 0).all()
    assert len(places) <= 1.5 * most + 2
    if np.isfinite(values).any():
        assert np.nanmin(values[places]) == np.nanmin(values) and np.nanmax(values[places]) == np.nanmax(values)
    if len(values) <= most:
        assert len(places) == len(values)
    width = -(-len(values) // (most // 2))
    for start in range(0, len(values) if len(values) > most else 0, width):
        inside = places[(places >= start) & (places < start + width)]
        assert np.isnan(values[inside]).any() == np.isnan(values[start : start + width]).any()


@pytest.mark.parametrize("coast", [False, True])
def test_the_drawn_gears_touch_at_the_pitch_point_and_nowhere_overlap(paper_pair, coast):
    """Rigid involutes with backlash; outlines are chords, a few thousandths of a millimetre off."""
    phase = (paper_pair.pitch_point - paper_pair.path_start) / paper_pair.base_pitch
    outlines = [gear_outline(paper_pair, gear, phase, coast) for gear in (0, 1)]
    pitch = _on_line(paper_pair, [paper_pair.pitch_point], coast)[0]
    for points, gear, centre in zip(
        outlines, (paper_pair.pinion, paper_pair.wheel), (np.zeros(2), np.array([0.0, -paper_pair.centre_distance]))
    ):
        radius = np.linalg.norm(points - centre, axis=1)
        np.testing.assert_allclose([radius.min(), radius.max()], [gear.root_radius, gear.tip_radius], rtol=1e-9)
        turned = np.unwrap(np.arctan2(*(points - centre).T[::-1]))
        assert np.isclose(abs(turned[-1] - turned[0]), 2 * pi)
        dense = points[:-1, None] + np.linspace(0, 1, 20)[:, None] * np.diff(points, axis=0)[:, None]
        assert np.linalg.norm(dense.reshape(-1, 2) - pitch, axis=1).min() < 0.06
    inside = outlines[0][Path(outlines[1]).contains_points(outlines[0])]
    assert not len(inside) or cKDTree(densely(outlines[1])).query(inside)[0].max() < 0.02


def densely(points):
    steps = np.linspace(0.0, 1.0, 400)[:, None]
    return (points[:-1, None] + steps * np.diff(points, axis=0)[:, None]).reshape(-1, 2)


def test_pairs_of_a_long_run_have_curves_where_they_are_seen():
    """What the curves show together is the mesh's force."""
    run = ShownRun(made_up_run(steps=401, cycles=20.0))
    curves = run.of_pairs("pair_normal_force", "N")
    assert 4 <= len(curves) <= 7 and len({number for *_, number in curves}) == len(curves)
    total = np.nansum([values for _, values, _ in curves], axis=0)
    np.testing.assert_allclose(total[run.in_window], run.dataset["normal_force"].values[run.in_window])
    assert not total[~run.in_window][:-1].any()


def test_without_plotly_charts_stay_images_and_the_page_says_what_to_install(monkeypatch):
    """The extra of pyproject.toml."""
    chart = Chart("A line", [Curve("one", np.arange(2.0), np.arange(2.0))], "x", "y")
    page = Page("Report", "A title", "", [PageSection("charts", "Charts", [chart])])
    assert 'id="library"' in rendered(page) and "[report]" not in rendered(page)
    plotly_library.cache_clear()
    monkeypatch.setitem(sys.modules, "plotly.offline", None)
    try:
        text = rendered(page)
    finally:
        plotly_library.cache_clear()
    assert 'id="library"' not in text and "pip install 'fenics_gears[report]'" in text
    assert "data:image/svg+xml;base64," in text
