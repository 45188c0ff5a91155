"""The map of contact pressure, a raster of flank and time."""

import math

import numpy as np
import pytest
from matplotlib.collections import QuadMesh
from tests.show.synthetic import made_up_run, right_scale, words

from fenics_gears.show.plots import run_figures
from fenics_gears.show.pressure import MOST_COLUMNS, node_edges, pressure_field
from fenics_gears.show.run import Run


def contact_pressure(run):
    return run_figures(run).get("contact_pressure.png")


def mesh(figure):
    return next(each for each in figure.get_axes()[0].collections if isinstance(each, QuadMesh))


def field_of(run):
    """The raster of a run's drive flanks, and what it is of."""
    pressure, place, phase, _ = Run(run).fields("")
    return pressure_field(pressure, place, phase, pressure.max()), pressure, place, phase


@pytest.mark.parametrize("steps", [21, 2000])
def test_every_node_under_pressure_is_in_the_raster(steps):
    """The cell at a node's place has its pressure, or a higher one that falls into it; no cell has another."""
    field, pressure, place, phase = field_of(made_up_run(steps=steps))
    assert field.values.shape[1] <= MOST_COLUMNS and field.x[0] == phase[0] and field.x[-1] == phase[-1]
    step, slot, node = np.nonzero(pressure > 0.0)
    rows = np.searchsorted(field.y, place[step, slot, node]) - 1
    columns = np.clip(np.searchsorted(field.x, phase[step] + 1e-9) - 1, 0, field.values.shape[1] - 1)
    assert (field.values[rows, columns] >= pressure[step, slot, node] - 1e-9).all()
    assert np.nanmax(field.values) == pressure.max()
    assert np.isin(field.values[np.isfinite(field.values)], pressure).all()


@pytest.mark.parametrize("falling", [False, True])
def test_cells_tile_uneven_nodes_without_gap_or_overlap(falling):
    """Half-way points; the ends mirror."""
    rolls, edges = np.array([1.0, 1.2, 1.6, 2.4, 4.0]), np.array([0.9, 1.1, 1.4, 2.0, 3.2, 4.8])
    low, high = node_edges(rolls[::-1] if falling else rolls)
    np.testing.assert_allclose(np.sort(low), edges[:-1], rtol=1e-13)
    np.testing.assert_allclose(np.sort(high), edges[1:], rtol=1e-13)


def test_a_peak_far_above_all_others_is_said_and_leaves_the_scale_alone():
    """By construction: 9000 MPa among cells below 1700 MPa; the peak away from edges decides."""
    run = made_up_run(steps=101)
    there = np.flatnonzero(run["contact_pressure"].values[50, :, 2] > 0.0)[0]
    run["contact_pressure"][50, there, 2] = 9000.0
    figure = contact_pressure(run)
    assert mesh(figure).norm.vmax < 1700.0
    assert mesh(contact_pressure(run.assign_attrs(peak_contact_pressure=1400.0))).norm.vmax == pytest.approx(1540.0)
    assert figure.get_axes()[0].get_title(loc="left").endswith("beyond the colours up to 9000 MPa at mesh cycle 29.00")


def test_pitch_point_and_the_wheels_axis(paper_scene):
    """Exact: either roll angle is tan(alpha_w), 22.44 deg."""
    (axes, _) = contact_pressure(made_up_run(scene=paper_scene.text)).get_axes()
    line = next(each for each in axes.get_lines() if each.get_label() == "pitch point")
    roll = float(line.get_ydata()[0])
    assert roll == pytest.approx(math.degrees(math.tan(math.radians(22.44))), abs=0.01)
    angles = right_scale(axes)
    # Along the line of action the wheel's roll angle falls by z1/z2 of what the pinion's rises.
    assert "Roll angle on the wheel's flank (deg)" in words(axes) and len(angles) > 3
    assert all(wheel == pytest.approx(roll - (pinion - roll) * 16 / 24, abs=1e-9) for wheel, pinion in angles)


def test_no_contact_at_all_and_no_pressure_variable():
    """hard_cases.md, 18: an empty flank; no variable, no picture."""
    run = made_up_run()
    run["contact_pressure"][:] = 0.0
    assert mesh(contact_pressure(run)).get_array().count() == 0
    assert contact_pressure(run.drop_vars("contact_pressure")) is None


def test_pressure_on_the_coast_flanks_has_a_panel_of_its_own():
    """A pair that the wheel drives presses on its coast flanks only, another one on both in turn."""
    run = made_up_run()
    zero = run["contact_pressure"] * 0.0
    run["coast_contact_roll_angle"] = run["contact_roll_angle"]
    coasting = run.assign(
        coast_contact_pressure=run["contact_pressure"],
        contact_pressure=zero.assign_attrs(run["contact_pressure"].attrs),
    )
    figure = contact_pressure(coasting)
    np.testing.assert_array_equal(
        mesh(figure).get_array().compressed(), mesh(contact_pressure(run)).get_array().compressed()
    )
    assert figure.get_axes()[0].get_title(loc="left") == "Contact pressure of single nodes on the coast flanks"
    both = contact_pressure(run.assign(coast_contact_pressure=run["contact_pressure"]))
    assert [axes.get_title(loc="left").split()[-2] for axes in both.get_axes()[:2]] == ["drive", "coast"]
