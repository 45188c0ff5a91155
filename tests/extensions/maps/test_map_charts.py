"""Charts of a map."""

import numpy as np
import pytest
import xarray as xr

from fenics_gears.extensions.maps.charts import DECIBELS, campbell, map_pictures, waterfall
from fenics_gears.show.chart import MARKERS, WORDS

SPEEDS, ORDERS = [100.0, 200.0, 300.0, 400.0], np.arange(1, 21) / 2.0


def made_up(natural=((600.0, 2500.0), (600.0, 2500.0)), damping=0.1, motion=("", "pinion tilts")) -> xr.Dataset:
    amplitudes = np.where(ORDERS % 1.0 == 0.0, 8.0 / ORDERS**2, 1e-9) * np.ones((2, 4, 1))
    return xr.Dataset(
        {
            "natural_frequency": (("load", "mode"), np.array(natural)),
            "damping_ratio": (("load", "mode"), np.full((2, 2), damping)),
            "excited": ("mode", [1, 1]),
            "motion": ("mode", np.array(motion, dtype=object)),
            "transmission_error_amplitude": (("load", "mesh_frequency", "order"), amplitudes),
            "mesh_force_amplitude": (("load", "mesh_frequency", "order"), 0.0 * amplitudes),
            "peak_to_peak_transmission_error": ("load", [1.0, 2.0]),
            "dynamic_factor_by_force": (("load", "mesh_frequency"), np.ones((2, 4))),
        },
        {
            "load": ("load", [100.0, 200.0], {"units": "N m", "long_name": "torque on the wheel"}),
            "mesh_frequency": SPEEDS,
            "pinion_speed": ("mesh_frequency", 60.0 * np.array(SPEEDS) / 16.0),
            "order": ORDERS,
        },
    )


def test_resonances_are_where_orders_meet_natural_frequencies():
    """Arithmetic: the n-th order meets 600 Hz at 600/n Hz; 2500 Hz lies above five times 400 Hz."""
    chart = campbell(made_up())
    (met,) = (curve for curve in chart.curves if curve.mode == MARKERS)
    assert met.x.tolist() == [300.0, 200.0, 150.0, 120.0] and set(met.y) == {600.0}
    assert [word for curve in chart.curves if curve.mode == WORDS for word in curve.words] == [
        *(f"{order} ×" for order in range(1, 6)),
        "600 Hz",
    ]
    assert not [curve for curve in campbell(made_up(damping=0.8)).curves if curve.mode == MARKERS]


def test_a_natural_frequency_that_depends_on_the_load_is_a_band():
    """Definition: from that of the one load to that of the other."""
    chart = campbell(made_up(((600.0, 1000.0), (660.0, 1001.0))))
    bands = [curve.y for curve in chart.curves if np.ndim(curve.y) == 2]
    assert len(bands) == 1 and bands[0].tolist() == [[600.0, 600.0], [660.0, 660.0]]
    assert [word for curve in chart.curves if curve.mode == WORDS for word in curve.words][-2:] == [
        "600 to 660 Hz",
        "1000 Hz, pinion tilts",
    ]


def test_a_waterfall_has_its_lines_at_multiples_of_the_speed():
    """Definition: at order times mesh frequency, one of 20 dB less half as high where 40 dB are shown."""
    (chart,) = waterfall(made_up().sel(load=100.0))
    line = next(curve for curve in chart.curves if curve.name == "300 Hz")
    heights = {x: y for x, y in zip(line.x, line.y) if y > 300.0}
    assert list(heights) == pytest.approx([300.0, 600.0, 900.0, 1200.0, 1500.0, 1800.0])
    first, second = heights[300.0] - 300.0, heights[600.0] - 300.0
    assert second / first == pytest.approx(1.0 - 20.0 * np.log10(4.0) / DECIBELS)


def test_a_map_has_the_pictures_that_it_has_data_for():
    """Rule 9 of the house: no speeds, no pictures of speeds."""
    assert set(map_pictures(made_up())) == {
        "over_load.png",
        "over_speed.png",
        "campbell.png",
        "waterfall_100_N_m.png",
        "waterfall_200_N_m.png",
    }
    assert set(map_pictures(made_up()[["peak_to_peak_transmission_error"]])) == {"over_load.png"}
