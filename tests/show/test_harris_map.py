"""The Harris map."""

import numpy as np
import pytest
import xarray as xr

from fenics_gears import ComputationError
from fenics_gears.show.chart import WORDS
from fenics_gears.show.drawing import picture
from fenics_gears.show.harris_map import harris_map
from fenics_gears.show.plots import save_figures

LOADS = [50.0, 100.0, 200.0, 437.0]


def errors(cycles=2.0, start=0.0, unit="um") -> xr.DataArray:
    phase = start + np.linspace(0.0, cycles, round(40 * cycles) + 1)
    values = np.array([0.04 * load * (1.0 + 0.2 * np.cos(2.0 * np.pi * phase)) for load in LOADS])
    return xr.DataArray(
        values,
        {"load": ("load", LOADS, {"units": "N m"}), "mesh_phase": phase},
        ("load", "mesh_phase"),
        "transmission_error",
        {"units": unit},
    )


def drawn(chart) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    return {curve.name: (curve.x, curve.y) for curve in chart.curves if curve.mode != WORDS}


@pytest.mark.parametrize("cycles, start", [(2.0, 0.0), (2.0, 38.0), (1.0, 5.0), (3.0, 0.0)])
def test_two_mesh_cycles_of_every_load_are_drawn(cycles, start):
    """A periodic error, whatever part of it was recorded."""
    curves = drawn(harris_map(errors(cycles, start)))
    assert list(curves) == ["50 N m", "100 N m", "200 N m", "437 N m"]
    for load, (phase, values) in zip(LOADS, curves.values()):
        np.testing.assert_allclose(phase, np.linspace(0.0, 2.0, 81), atol=1e-12)
        np.testing.assert_allclose(values, 0.04 * load * (1.0 + 0.2 * np.cos(2.0 * np.pi * phase)), rtol=1e-12)


def test_an_angle_of_the_wheel_is_a_length_on_its_base_circle():
    """Base radius times angle."""
    angle = (errors() / 54.2e3).assign_attrs(units="rad").to_dataset().assign_attrs(base_radius_wheel=54.2)
    for (_, length), (_, same) in zip(drawn(harris_map(errors())).values(), drawn(harris_map(angle)).values()):
        np.testing.assert_allclose(same, length, rtol=1e-12)


def test_loads_stand_at_their_curves_and_apart(tmp_path):
    """The names' least distance."""
    close = errors().assign_coords(load=("load", [50.0, 50.1, 50.2, 437.0], {"units": "N m"}))
    close[1:3] = close[0]
    chart = harris_map(close)
    (names,) = (curve for curve in chart.curves if curve.mode == WORDS)
    assert list(names.words) == ["50 N m", "50.1 N m", "50.2 N m", "437 N m"]
    assert (np.diff(names.y) > 0.0).all()
    assert save_figures({"map.png": picture("Harris map", [chart])}, tmp_path)[0].stat().st_size > 10_000


def test_what_is_no_map_is_refused():
    """Authority: the message names what is there."""
    with pytest.raises(ComputationError, match="needs the dimensions load and mesh_phase.*wheel_torque, mesh_phase"):
        harris_map(errors().rename(load="wheel_torque"))
    with pytest.raises(ComputationError, match='"rad"'):
        harris_map(errors(unit="rad"))
