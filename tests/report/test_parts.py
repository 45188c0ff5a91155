"""What curves, spectra and the drawing of a report are made of."""

from math import pi

import numpy as np
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.path import Path
from scipy.spatial import cKDTree
from tests.show.synthetic import made_up_run

from fenics_gears.show.report.forces import shared_curves
from fenics_gears.show.report.pair_drawing import _on_line, gear_outline
from fenics_gears.show.report.run import Run
from fenics_gears.show.report.spectra import spectrum
from fenics_gears.show.report.thinning import thinned


@given(st.lists(st.floats(-1e6, 1e6) | st.just(float("nan")), min_size=1, max_size=400), st.sampled_from([10, 40]))
def test_thinned_curves_keep_peaks_ends_and_gaps(values, most):
    """Authority: the whole curve: its extremes, its ends, and a gap in each slice that has one; places in order, and few."""
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


def run_of(scene_text, values, phase, tmp_path):
    """A run with nothing but a curve."""
    dataset = xr.Dataset(
        {"transmission_error": ("time", values, {"units": "rad"})},
        {"mesh_phase": ("time", phase)},
        {"scene": scene_text, "base_radius_wheel": 50.0},
    )
    return Run(dataset, tmp_path / "run.nc")


def test_mesh_orders_have_the_amplitudes_of_the_harmonics(paper_scene, tmp_path):
    """Authority: Fourier: a sum of cosines has their amplitudes at their orders, and nothing between."""
    phase = np.linspace(28.0, 31.0, 301)
    values = 5.0 + 3.0 * np.cos(2 * pi * phase + 1.0) + 0.25 * np.sin(6 * pi * phase)
    found = spectrum(run_of(paper_scene.text, values, phase, tmp_path), values)
    amplitude = dict(zip(np.round(found.lines.orders, 6), found.lines.amplitudes))
    assert np.isclose(amplitude[1.0], 3.0) and np.isclose(amplitude[3.0], 0.25) and amplitude[2.0] < 1e-12
    assert set(found.origins[found.lines.amplitudes > 1e-9]) == {"mesh"} and "3 whole mesh cycles" in found.record


def test_turns_of_the_gears_stand_apart_in_a_hunting_tooth_period(paper_scene, tmp_path):
    """Authority: 16 and 24 teeth: 48 mesh cycles, in which the pinion turns 3 times and the wheel twice."""
    phase = np.linspace(0.0, 48.0, 48 * 20 + 1)
    values = np.cos(2 * pi * phase) + 0.5 * np.cos(2 * pi * phase / 16) + 0.25 * np.cos(2 * pi * phase / 24)
    found = spectrum(run_of(paper_scene.text, values, phase, tmp_path), values)
    there = {origin: (round(order * 48), round(size, 9)) for origin, order, size in zip(found.origins, *found_lines(found)) if size > 1e-9}
    assert there == {"mesh": (48, 1.0), "turn of the pinion": (3, 0.5), "turn of the wheel": (2, 0.25)}


def found_lines(found):
    """Orders and amplitudes of a spectrum."""
    return found.lines.orders, found.lines.amplitudes


def test_the_drawn_gears_touch_at_the_pitch_point_and_nowhere_overlap(paper_pair):
    """Authority: at the phase that is drawn a tooth pair touches at the pitch point; rigid involutes with backlash do not overlap.
    Outlines are chords of 14 points a flank, so a few thousandths of a millimetre off."""
    phase = (paper_pair.pitch_point - paper_pair.path_start) / paper_pair.base_pitch
    outlines = [gear_outline(paper_pair, gear, phase) for gear in (0, 1)]
    pitch = _on_line(paper_pair, [paper_pair.pitch_point])[0]
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
    """Points along an outline, closer than a hundredth of a millimetre."""
    steps = np.linspace(0.0, 1.0, 400)[:, None]
    return (points[:-1, None] + steps * np.diff(points, axis=0)[:, None]).reshape(-1, 2)


def test_many_pairs_share_curves_without_touching_each_other():
    """Authority: the pairs' forces themselves: each is on exactly one curve, and what curves show together is all of it."""
    run = made_up_run(steps=401, cycles=20.0)
    numbers, forces = run["pair"].values, run["pair_normal_force"].values
    curves = shared_curves(numbers, forces)
    assert 2 <= len(curves) <= 6
    total = np.nansum([values for _, values, _ in curves], axis=0)
    np.testing.assert_allclose(total, forces.sum(axis=1))
    few = shared_curves(numbers[:3], forces[:, :3])
    assert [name for name, _, _ in few] == ["pair 27", "pair 28", "pair 29"]
    assert all(np.isnan(values).any() for _, values, _ in few)
