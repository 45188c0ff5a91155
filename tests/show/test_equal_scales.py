"""Charts with the same scale along both axes."""

from matplotlib.figure import Figure

from fenics_gears.show.chart import Chart
from fenics_gears.show.drawing import _set_ends


def test_a_range_of_a_chart_with_equal_scales_may_be_widened(caplog):
    """One of two ranges has to be; where both are fixed matplotlib 3.10 says so, for each of a report's drawings."""
    figure = Figure(figsize=(4.0, 4.0))
    axes = figure.add_subplot()
    axes.plot([0.0, 1.0], [0.0, 3.0])
    _set_ends(axes, Chart("Gears", [], "x (mm)", "y (mm)", "", 400, equal=True, x_range=(0.0, 1.0), y_range=(0.0, 3.0)))
    axes.apply_aspect()
    assert axes.get_autoscalex_on() and axes.get_autoscaley_on() and not caplog.records
    (left, right), (bottom, top) = axes.get_xlim(), axes.get_ylim()
    assert left <= 0.0 < 1.0 <= right and bottom <= 0.0 < 3.0 <= top
