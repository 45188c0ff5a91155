"""Pictures over the face, of a short coarse run."""

from types import SimpleNamespace

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.image import imread
from tests.helical import wide_pair
from tests.over_face import MORE, helical_run, root_stress_run
from tests.show.synthetic import made_up_run

from fenics_gears.show import FACE_PICTURE_FILES, face_picture, stress_heading
from fenics_gears.show.contact_pattern import contact_patterns, pattern
from fenics_gears.show.line_load import line_loads
from fenics_gears.show.plots import draw_run
from fenics_gears.show.run import ShownRun
from fenics_gears.show.stress_picture import charts_of, still
from fenics_gears.simulation.run_stresses import RunStresses


@pytest.fixture(scope="module")
def run():
    return ShownRun(helical_run(), stress=False)


def test_pictures_of_the_face_are_written_beside_the_others(tmp_path):
    """Each shows more than its ground; a plane run has none of them."""
    files = {file.name: file for file in draw_run(helical_run(), tmp_path)}
    rigid = FACE_PICTURE_FILES[:2]
    assert set(rigid) < set(files) and "contact_pressure.png" in files and "shafts.png" not in files
    for name in rigid:
        picture = imread(files[name])
        assert picture.shape[1] == 1500 and np.mean(picture[..., :3].min(axis=2) < 0.9) > 0.05
    assert not set(FACE_PICTURE_FILES) & {file.name for file in draw_run(made_up_run(), tmp_path / "plane")}


@pytest.mark.parametrize("length", [90, 250, 600])
def test_words_above_a_stress_picture_end_within_it(monkeypatch, length):
    """However many conditions a scene has, no line leaves the picture or reaches into its panels."""
    monkeypatch.setattr(stress_heading, "conditions", lambda scene: ("tip relief, " * length)[:length])
    figure = Figure(figsize=(16.0, 9.0))
    FigureCanvasAgg(figure)
    dataset = helical_run()
    stress_heading.heading(figure, SimpleNamespace(mesh_phase=0.25, time=1e-3), dataset)
    boxes = [words.get_window_extent() for words in figure.texts]
    assert max(box.x1 for box in boxes) < figure.bbox.width and min(box.y0 for box in boxes) > 0.89 * figure.bbox.height
    assert "mesh phase 0.250" in figure.texts[1].get_text()


def test_pattern_shows_the_largest_pressure_where_it_is(run):
    """The result's fields: cells hold the largest averaged pressure, at the diameter of its node. Five nodes
    weigh -1, 4, 10, 4, -1: what alternates goes, cubics stay. Two at either end are as they are."""
    raw, rolls = (run.dataset[f"contact_{name}"].values for name in ("pressure", "roll_angle"))
    padded = np.pad(rolls, [(0, 0)] * (rolls.ndim - 1) + [(0, 2)], constant_values=np.nan)
    pressure = raw.copy()
    for node in range(2, raw.shape[-1] - 2):
        mean = raw[..., node - 2 : node + 3] @ np.array([-1.0, 4.0, 10.0, 4.0, -1.0]) / 16.0
        pressure[..., node] = np.where(np.isnan(padded[..., node + 2]), raw[..., node], mean)
    field = contact_patterns(run)[0].field
    assert np.nanmax(field.values, axis=0) == pytest.approx(pressure.max(axis=(0, 1, 3)))
    for number in range(pressure.shape[2]):
        own = pressure[:, :, number]
        diameter = 2.0 * run.pair.pinion.radius(rolls[:, :, number].flat[own.argmax()])
        cell = np.clip(np.searchsorted(field.y, diameter) - 1, 0, len(field.y) - 2)
        assert field.values[cell, number] == pytest.approx(own.max())


def test_between_steps_the_pattern_goes_on_as_the_peak_does():
    """Exact: a travelling pressure whose peak rises linearly leaves that line; where two pairs follow each other
    nothing is between."""
    places = np.linspace(0.2, 0.6, 9)
    rolls = places[:, None, None, None] + np.linspace(-0.01, 0.01, 5)
    pressure = np.broadcast_to(1000.0 * places[:, None, None, None] * [0.0, 0.7, 1.0, 0.7, 0.0], rolls.shape)
    field = pattern(
        pressure, rolls, np.ones((9, 1)), (0.0, 0.8), lambda roll: 30.0 * roll, np.array([-1.0, 1.0]), 1000.0
    )
    middles = 0.5 * (field.y[1:] + field.y[:-1])
    inside = (middles > 60.0 * 0.2) & (middles < 60.0 * 0.6)
    # To a row of the raster, 4 MPa here.
    assert field.values[inside, 0] == pytest.approx(1000.0 * middles[inside] / 60.0, abs=4.01)
    apart = pattern(
        pressure,
        rolls,
        np.arange(9)[:, None] // 5 + 1,
        (0.0, 0.8),
        lambda roll: 30.0 * roll,
        np.array([-1.0, 1.0]),
        1000.0,
    )
    assert np.isnan(apart.values[np.searchsorted(field.y, 60.0 * 0.425) - 1, 0])


@pytest.mark.parametrize("side", ["", pytest.param("coast_", marks=pytest.mark.nightly)])
def test_line_loads_add_up_to_the_forces(run, side):
    """Identity: the normal force of mesh and pair; contact ends where the lines are."""
    run = ShownRun(root_stress_run(coast=True)[1], stress=False) if side else run
    mesh, pair, _ = line_loads(run)
    widths = np.diff(mesh.field.y)
    assert np.nansum(mesh.field.values * widths[:, None], axis=0) == pytest.approx(
        run.dataset[f"{side}normal_force"].values, rel=1e-9
    )
    assert np.nanmax(np.nansum(pair.field.values * widths[:, None], axis=0)) >= run.dataset[
        f"pair_{side}normal_force"
    ].values.max() * (1 - 1e-9)
    start, _, end = pair.curves
    for number, loads in enumerate(np.nan_to_num(pair.field.values)):
        z = 0.5 * (pair.field.y[number] + pair.field.y[number + 1])
        touched = pair.field.x[:-1][loads > 0.0]
        ends = (np.interp(z, start.y, start.x), np.interp(z, end.y, end.x))
        assert (touched[0], touched[-1]) == pytest.approx(ends, abs=2.5 / 12)


def test_gears_in_space_are_coloured_where_they_touch(monkeypatch):
    """The camera looks at the pitch point; nothing but the lines of contact is red; the words have the largest
    values."""
    pytest.importorskip("pyvista")
    monkeypatch.setattr(face_picture, "PIXELS", 60)
    result = helical_run()
    with RunStresses(result, wide_pair(MORE)) as runs:
        mesh = runs.at(3)
    figure = still(mesh, result)
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    colours = np.asarray(canvas.buffer_rgba())[..., :3] / 255.0
    for left in (0.385, 0.66):
        panel = colours[130:790, round(1600 * left) : round(1600 * (left + 0.265))]
        places = np.argwhere(panel[..., 0] - panel[..., 2] > 0.35) / panel.shape[:2]
        assert len(places) > 200 and np.ptp(places[:, 1]) > 0.3 and np.abs(places[:, 0] - 0.5).max() < 0.25
    (chart,) = charts_of(mesh)[1]
    said = " ".join(text.get_text() for text in figure.texts)
    assert all(f"{curve.name} {curve.y.max():.0f} MPa at z" in said for curve in chart.curves)
