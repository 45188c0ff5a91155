"""Curves and the map of contact pressure show the dataset's own values."""

import math

import numpy as np
import pytest
from matplotlib.collections import QuadMesh
from tests.show.synthetic import made_up_run, right_scale, words

from fenics_gears.results import by_pair
from fenics_gears.show.panels import tick_labels, ticks
from fenics_gears.show.plots import run_figures
from fenics_gears.show.pressure import MOST_COLUMNS, node_edges, pressure_field
from fenics_gears.show.run import ShownRun


def transmission_error(run):
    return run_figures(run)["transmission_error.png"]


def mesh_forces(run):
    return run_figures(run).get("mesh_forces.png")


def load_sharing(run):
    return run_figures(run).get("load_sharing.png")


def curve(axes, which=-1):
    """Data of one of the panel's curves; lines across the panel are none."""
    lines = [line for line in axes.get_lines() if len(np.asarray(line.get_xdata())) > 2]
    return np.asarray(lines[which].get_xdata()), np.asarray(lines[which].get_ydata())


def test_transmission_error_and_the_wheels_sideways_motion():
    """Exact prefixes; the length axis is rb2 T_E (model.md, section 4)."""
    run = made_up_run()
    above, below = transmission_error(run).get_axes()
    for axes, name, values in [
        (above, "Transmission error (µm)", run["transmission_error"].values * 50e3),
        (below, "Displacement (µm)", run["centre_y"].values[:, 1] * 1e3),
    ]:
        x, y = curve(axes)
        assert name in words(axes)
        np.testing.assert_array_equal(x, run["mesh_phase"].values)
        np.testing.assert_allclose(y, values, rtol=1e-14, atol=0)
    assert below.get_xlabel() == "Time (mesh cycles since the start)"
    angles = right_scale(above)
    # 1 µm on a base radius of 50 mm is 20 µrad.
    assert "Angle of the wheel (µrad)" in words(above) and len(angles) > 3
    assert all(angle == pytest.approx(20.0 * length, rel=1e-12) for angle, length in angles)


def test_a_motion_of_rounding_errors_is_shown_as_none():
    """Contact is solved to 1e-4 um; what is smaller is no curve."""
    run = made_up_run()
    run["centre_y"][:] = run["centre_y"].values * 1e-12
    low, high = transmission_error(run).get_axes()[1].get_ylim()
    assert high - low >= 0.1 and low < 0 < high


def test_without_friction_the_shaft_is_shown_along_the_line_of_action():
    """model.md, claim 1: the motion off the line of action is zero."""
    run = made_up_run()
    run["centre_x"] = (2.0 * run["centre_y"]).assign_attrs(units="mm")
    for friction, name, title in ((True, "centre_y", "off"), (False, "centre_x", "along")):
        shown = run if friction else run.drop_vars("friction_force")
        below = transmission_error(shown).get_axes()[1]
        assert below.get_title(loc="left") == f"Displacement of the wheel's shaft {title} the line of action"
        np.testing.assert_allclose(curve(below)[1], run[name].values[:, 1] * 1e3, rtol=1e-14)


def test_a_long_run_shows_its_last_cycles_and_all_of_them_cycle_by_cycle():
    """The last four mesh cycles; below, least and largest value of each of the twelve."""
    run = made_up_run(steps=241, cycles=12.0)
    assert [axes.get_xlim() for axes in transmission_error(run).get_axes()] == [(36.0, 40.0)] * 2
    growing = run["transmission_error"] * (1.0 + 0.1 * (run["mesh_phase"] - 28.0))
    run["transmission_error"] = growing.assign_attrs(units="rad")
    last = transmission_error(run).get_axes()[-1]
    low, high, _ = (line.get_ydata() for line in last.get_lines())
    cycles = [growing.values[20 * each : 20 * each + 21] * 50e3 for each in range(12)]
    np.testing.assert_allclose(low, [each.min() for each in cycles], rtol=1e-12)
    np.testing.assert_allclose(high, [each.max() for each in cycles], rtol=1e-12)
    assert last.get_title(loc="left") == "Transmission error over all 12 mesh cycles"


def test_mesh_forces():
    """The dataset; N mm become N m."""
    run = made_up_run()
    normal, friction, torques = mesh_forces(run).get_axes()
    np.testing.assert_array_equal(curve(normal)[1], run["normal_force"].values)
    np.testing.assert_array_equal(curve(friction)[1], run["friction_force"].values)
    for which, gear in enumerate(("pinion", "wheel")):
        np.testing.assert_allclose(
            curve(torques, which)[1], run["reaction_couple"].sel(gear=gear).values * 1e-3, rtol=1e-14
        )
    for axes, title in ((normal, "Normal force (N)"), (friction, "Friction force (N)"), (torques, "Torque (N m)")):
        assert title in words(axes)
    assert [text.get_text() for text in torques.get_legend().get_texts()] == ["pinion", "wheel"]


def test_load_sharing():
    """Each pair's force while it carries; their sum is the mesh's."""
    run = made_up_run()
    (axes,) = load_sharing(run).get_axes()
    lines = {line.get_label(): line for line in axes.get_lines()}
    np.testing.assert_allclose(lines.pop("all pairs").get_ydata(), run["normal_force"].values, rtol=1e-14)
    pairs = by_pair(run["pair_normal_force"], absent=0.0)
    carrying = [int(n) for n in pairs["pair"].values if np.any(pairs.sel(pair=n).values != 0)]
    assert list(lines) == [f"pair {number}" for number in carrying]
    for number in carrying:
        force, shown = pairs.sel(pair=number).values, lines[f"pair {number}"]
        x, y = shown.get_data()
        known = np.isfinite(y)
        np.testing.assert_array_equal(y[known], np.interp(x[known], run["mesh_phase"].values, force))
        np.testing.assert_array_equal(np.sort(y[known & (y != 0)]), np.sort(force[force != 0]))
    colours = [line.get_color() for line in lines.values()]
    assert all(first != second for first, second in zip(colours, colours[1:]))
    assert "Force (N)" in words(axes)


@pytest.mark.parametrize(("ends", "logarithmic", "expected"), [
    ((-6.2, 5.1), False, ["−5.0", "−2.5", "0.0", "2.5", "5.0"]),
    ((7990.0, 10010.0), False, ["8000", "8500", "9000", "9500", "10000"]),
    ((0.0, 3.1e-7), False, ["0", "1e−07", "2e−07", "3e−07"]),
    ((27.99999, 28.00001), False, ["27.999990", "27.999995", "28.000000", "28.000005", "28.000010"]),
    ((0.002, 30.0), True, ["0.01", "0.1", "1", "10"]),
    ((20.0, 150.0), True, ["20", "50", "100"]),
])  # fmt: skip
def test_ticks_are_round_numbers_written_with_the_decimals_they_need(ends, logarithmic, expected):
    """Arithmetic: multiples of 1, 2, 2.5 or 5 times a power of ten."""
    places = ticks(ends, 5.0, logarithmic)
    assert tick_labels(places, logarithmic) == expected
    np.testing.assert_allclose([float(each.replace("−", "-")) for each in expected], places, atol=1e-9 * np.ptp(ends))


def test_ticks_that_differ_by_round_off_are_one_number():
    """The promise; a result that a study does not change but for round-off has a picture."""
    assert tick_labels(np.array([1.0, 1.0 + 1e-13, 1.0 + 2e-13])) == ["1", "1", "1"]


def contact_pressure(run):
    return run_figures(run).get("contact_pressure.png")


def mesh(figure):
    return next(each for each in figure.get_axes()[0].collections if isinstance(each, QuadMesh))


def field_of(run):
    """The raster of a run's drive flanks, and what it is of."""
    pressure, place, phase, _ = ShownRun(run).fields("")
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
    said = "9000 MPa at mesh cycle 29.00, off the scale"
    assert figure.get_axes()[0].get_title(loc="left").endswith(said)


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
    assert figure.get_axes()[0].get_title(loc="left") == "Contact pressure at each contact node on the coast flanks"
    both = contact_pressure(run.assign(coast_contact_pressure=run["contact_pressure"]))
    assert [axes.get_title(loc="left").split()[-2] for axes in both.get_axes()[:2]] == ["drive", "coast"]
