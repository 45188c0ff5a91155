"""What curves, spectra and the drawing of a report are made of."""

import sys
from math import asin, cos, pi, radians, sin

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.path import Path
from scipy.spatial import cKDTree
from tests.helical import wide_pair
from tests.show.synthetic import made_up_run

from fenics_gears.show.chart import Chart, Curve
from fenics_gears.show.panels import thinned
from fenics_gears.show.report.curves import spectra
from fenics_gears.show.report.energy import energy
from fenics_gears.show.report.overview import summary
from fenics_gears.show.report.page import Page, PageSection
from fenics_gears.show.report.pair_drawing import _on_line, gear_outline
from fenics_gears.show.report.rendering import plotly_library, rendered
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


def ramp_of(paper_scene, cycles):
    text = f'{paper_scene.text}\n[speed_ramp]\nend_frequency = "50 Hz"\n'
    return made_up_run(scene=text, cycles=cycles, steps=int(20 * cycles) + 1)


def test_a_ramp_points_to_orders_cycle_by_cycle_only_where_they_are_drawn(paper_scene, tmp_path):
    """From eight stored mesh cycles on."""
    for cycles in (2.0, 9.0):
        section = spectra(ShownRun(ramp_of(paper_scene, cycles), tmp_path / "run.nc"))
        drawn = [block.caption for block in section.blocks if "cycle by cycle" in getattr(block, "caption", "")]
        assert ("See the orders cycle by cycle." in section.blocks[0].text) == bool(drawn) == (cycles > 8.0)


def tiles_of(dataset, tmp_path):
    (tiles,) = summary(ShownRun(dataset, tmp_path / "run.nc")).blocks
    return {tile.label: tile for tile in tiles.tiles}


def test_the_largest_mesh_force_is_compared_with_the_force_along_the_same_normal(paper_scene, tmp_path):
    """Statics: F_bn = T_2/(r_b2 cos(beta_b)), of a helical pair too."""
    for scene, helix in ((paper_scene.text, 0.0), (wide_pair().text, 15.0)):
        run = made_up_run(scene=scene)
        pair = ShownRun(run).pair
        run["normal_force"] = 0.0 * run["normal_force"] + ShownRun(run).scene.load.wheel_torque / (
            pair.wheel.base_radius * cos(asin(sin(radians(helix)) * cos(radians(20.0))))
        )
        assert tiles_of(run, tmp_path)["Largest mesh force"].note.startswith("1.000 times")


def test_the_account_names_the_side_that_drives_and_keeps_signs(paper_scene, tmp_path):
    """Conservation of energy: a wheel that drives does the larger work."""
    dataset = made_up_run(scene=paper_scene.text)
    work = {
        "work_input": -96.0,
        "work_output": -100.0,
        "work_friction": 3.0,
        "work_contact_changes": -1.0,
        "energy": 0.0,
        "energy_defect": 0.0,
    }
    for name, last in work.items():
        dataset[name] = ("time", np.linspace(0.0, 1e3 * last, dataset.sizes["time"]), {"units": "N mm"})

    def rows():
        facts = energy(ShownRun(dataset, tmp_path / "run.nc")).blocks[0]
        return {label: f"{value} {unit}" for label, value, unit in facts.rows}

    wheel = rows()
    assert wheel["work of the drive, the wheel's shaft"] == "100 N m"
    assert wheel["work done on the load, the pinion's shaft"] == "96 N m (96 % of the drive's work)"
    assert wheel["lost to friction"] == "3 N m (3 % of the drive's work)"
    assert wheel["put in by the time stepping where contact changes"] == "-1 N m (-1 % of the drive's work)"
    for name, last in {"work_input": 100.0, "work_output": 96.0}.items():
        dataset[name] = ("time", np.linspace(0.0, 1e3 * last, dataset.sizes["time"]), {"units": "N mm"})
    assert rows()["work of the drive, the pinion's shaft"] == "100 N m"


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
