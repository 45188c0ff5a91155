"""The map of contact pressure: cells that tile the flank, at the place and with the pressure of their nodes."""

import math

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import PolyCollection
from tests.show.synthetic import made_up_run

from fenics_gears.show.pressure_map import contact_pressure, pressure_cells


def patches(figure):
    return next(each for each in figure.get_axes()[0].collections if isinstance(each, PolyCollection))


def test_every_node_under_pressure_is_a_cell_around_it():
    """Authority: the dataset. One cell a closed node, its pressure in MPa, its place inside the cell."""
    run = made_up_run()
    cells = pressure_cells(run)
    pressure = run["contact_pressure"].values
    step, pair, node = np.nonzero(pressure > 0)
    np.testing.assert_array_equal(cells.pressure, pressure[step, pair, node])
    np.testing.assert_array_equal(cells.pair, run["contact_pair_number"].values[step, pair])
    roll = np.degrees(run["contact_roll_angle"].values)[step, pair, node]
    phase = run["mesh_phase"].values[step]
    for axis, place in ((0, phase), (1, roll)):
        low, high = cells.corners[:, :, axis].min(axis=1), cells.corners[:, :, axis].max(axis=1)
        assert np.all(low <= place + 1e-12) and np.all(place <= high + 1e-12) and np.all(high > low)


@pytest.mark.parametrize("falling", [False, True])
def test_cells_tile_uneven_nodes_without_gap_or_overlap(falling):
    """Authority: half-way points. Edges of neighbouring nodes are shared, whichever way the nodes are counted; the ends mirror."""
    rolls = np.array([1.0, 1.2, 1.6, 2.4, 4.0])
    edges = np.array([0.9, 1.1, 1.4, 2.0, 3.2, 4.8])
    if falling:
        rolls = rolls[::-1]
    run = made_up_run(steps=3)
    run["contact_roll_angle"][:] = np.radians(rolls)
    run["contact_pressure"][:] = 1000.0
    cells = pressure_cells(run)
    assert len(cells.pressure) == run["contact_pressure"].size
    first = cells.corners[:5]
    low, high = np.sort(first[:, :, 1].min(axis=1)), np.sort(first[:, :, 1].max(axis=1))
    np.testing.assert_allclose(low, edges[:-1], rtol=1e-13)
    np.testing.assert_allclose(high, edges[1:], rtol=1e-13)
    phases = np.unique(cells.corners[:, :, 0])
    np.testing.assert_allclose(phases, [28.0, 28.5, 29.5, 30.0], rtol=1e-15)


def test_nodes_beyond_the_flank_have_no_cell_and_bound_none():
    """Authority: the dataset's NaN, where a pair has fewer nodes; the last node before it keeps its own cell."""
    run = made_up_run(steps=3)
    run["contact_roll_angle"][:] = np.radians([10.0, 10.4, 10.8, np.nan, np.nan])
    run["contact_pressure"][:] = [900.0, 1000.0, 1100.0, 0.0, 0.0]
    cells = pressure_cells(run)
    last = cells.corners[cells.pressure == 1100.0][0]
    assert last[:, 1].min() == pytest.approx(10.6) and last[:, 1].max() == pytest.approx(11.0)


def test_labels_and_units():
    """Authority: design.md, units on every axis."""
    figure = contact_pressure(made_up_run())
    flank, bar = figure.get_axes()
    assert flank.get_ylabel() == "Roll angle on the pinion's flank (deg)"
    assert flank.get_xlabel() == "Time (mesh cycles since the start)"
    assert bar.get_ylabel() == "Contact pressure (MPa)"


def test_the_map_holds_the_datasets_pressures():
    """Authority: the dataset; MPa stay MPa."""
    run = made_up_run()
    pressure = run["contact_pressure"].values
    drawn = patches(contact_pressure(run))
    np.testing.assert_array_equal(np.sort(drawn.get_array()), np.sort(pressure[pressure > 0]))
    assert drawn.norm.vmin == 0.0 and drawn.norm.vmax == pressure.max()


def test_a_peak_far_above_all_others_is_said_and_leaves_the_scale_alone():
    """Authority: by construction one cell of 9000 MPa among cells below 1700 MPa."""
    run = made_up_run(steps=101)
    run["contact_pressure"][50, 1, 2] = 9000.0
    figure = contact_pressure(run)
    assert patches(figure).norm.vmax < 1700.0
    assert figure.get_axes()[0].get_title(loc="left") == "Beyond the colour scale: up to 9000 MPa (mesh cycle 29.00)"


def test_pitch_point_and_the_wheels_axis(paper_scene):
    """Authority: at the pitch point either roll angle is tan(alpha_w) (exact); the paper's alpha_w is 22.44 deg."""
    (axes, _) = contact_pressure(made_up_run(scene=paper_scene.text)).get_axes()
    (line,) = axes.get_lines()
    roll = float(line.get_ydata()[0])
    assert roll == pytest.approx(math.degrees(math.tan(math.radians(22.44))), abs=0.01)
    (wheel,) = axes.child_axes
    assert wheel.get_ylabel() == "Roll angle on the wheel's flank (deg)"
    FigureCanvasAgg(axes.figure).draw()
    for further in (0.0, 6.0):
        # Along the line of action the wheel's roll angle falls by z1/z2 of what the pinion's rises.
        height = axes.transData.transform((28.0, roll + further))[1]
        assert wheel.transData.transform((0.0, roll - further * 16 / 24))[1] == pytest.approx(height, rel=1e-9)


def test_without_a_readable_scene_the_map_is_there_without_the_pitch_point():
    """Authority: a result of another version still has its picture."""
    (axes, _) = contact_pressure(made_up_run(scene="gears = 'of another version'")).get_axes()
    assert list(axes.get_lines()) == [] and axes.child_axes == []


def test_no_contact_at_all_and_no_pressure_variable():
    """Authority: free flight has no pressure (hard_cases.md, 18): an empty flank, no failure; no variable, no picture."""
    run = made_up_run()
    run["contact_pressure"][:] = 0.0
    assert len(patches(contact_pressure(run)).get_paths()) == 0
    assert contact_pressure(run.drop_vars("contact_pressure")) is None


def test_pressure_on_the_coast_flanks_has_a_panel_of_its_own():
    """Authority: the dataset. A pair that the wheel drives presses on its coast flanks only, another one on both in turn."""
    run = made_up_run()
    zero = run["contact_pressure"] * 0.0
    run["coast_contact_roll_angle"] = run["contact_roll_angle"]
    coasting = run.assign(coast_contact_pressure=run["contact_pressure"], contact_pressure=zero.assign_attrs(run["contact_pressure"].attrs))
    figure = contact_pressure(coasting)
    np.testing.assert_array_equal(patches(figure).get_array(), pressure_cells(run).pressure)
    assert figure.get_axes()[0].get_title(loc="left").startswith("Coast flanks")
    both = contact_pressure(run.assign(coast_contact_pressure=run["contact_pressure"]))
    assert [axes.get_title(loc="left").split(".")[0] for axes in both.get_axes()[:2]] == ["Drive flanks", "Coast flanks"]
