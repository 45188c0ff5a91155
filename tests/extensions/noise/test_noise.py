"""Noise figures of made-up runs whose orders are known."""

import numpy as np
import pytest
import scipy.signal
import xarray as xr

from fenics_gears import ComputationError
from fenics_gears.commands.cli import main
from fenics_gears.extensions.noise.charts import noise_charts
from fenics_gears.extensions.noise.figures import noise_figures
from fenics_gears.results import save
from fenics_gears.results.spectrum import FLAT_TOP, HANN

STEPS, PERIOD, RADIUS = 40, 48, 50.0


def made_up(scene, cycles, error, force=None, speed=None) -> xr.Dataset:
    """A result with these curves over the mesh phase: um, N, Hz."""
    phase = np.arange(round(cycles * STEPS) + 1) / STEPS
    variables = {
        "transmission_error": ("time", error(phase) * 1e-3 / RADIUS, {"units": "rad"}),
        "normal_force": ("time", 9e3 + (0.0 * phase if force is None else force(phase)), {"units": "N"}),
    }
    if speed is not None:
        variables["mesh_frequency"] = ("time", speed(phase), {"units": "Hz"})
    attributes = {"scene": scene.text, "base_radius_wheel": RADIUS, "title": "made up", "complete": 1}
    return xr.Dataset(
        variables, {"time": ("time", phase / 200.0, {"units": "s"}), "mesh_phase": ("time", phase)}, attributes
    )


def cosine(order, amplitude=1.0):
    return lambda phase: amplitude * np.cos(2.0 * np.pi * order * phase + 0.4)


@pytest.mark.parametrize("window", [None, HANN, FLAT_TOP])
def test_mesh_orders_have_their_levels(paper_scene, window):
    """Exact: 10 um are 20 dB re 1 um, 50 N 33.98 dB re 1 N, in any window."""
    found = noise_figures(made_up(paper_scene, 20, cosine(2.0, 10.0), cosine(3.0, 50.0)), window)
    assert (
        found["transmission_error_level"].attrs["units"] == "dB re 1 um"
        and found["mesh_force_level"].attrs["units"] == "dB re 1 N"
    )
    at = {
        name: float(found[f"{name}_level"].sel(order=order, method="nearest"))
        for name, order in (("transmission_error", 2.0), ("mesh_force", 3.0))
    }
    assert at == {
        "transmission_error": pytest.approx(20.0, abs=1e-5),
        "mesh_force": pytest.approx(20.0 * np.log10(50.0), abs=1e-5),
    }


def test_run_out_of_the_pinion_shows_as_sidebands(paper_scene):
    """Exact: an amplitude modulation of depth m by the pinion's turn has m^2/2 of the energy of its line."""
    depth, mesh = 0.2, cosine(1.0, 4.0)
    found = noise_figures(
        made_up(paper_scene, PERIOD, lambda phase: mesh(phase) * (1.0 + depth * cosine(1.0 / 16.0)(phase)))
    )
    assert float(found["transmission_error_sideband_ratio"].sel(harmonic=1)) == pytest.approx(0.5 * depth**2, rel=1e-6)
    assert float(found["transmission_error_sideband_energy"].sel(harmonic=1, gear="pinion")) == pytest.approx(
        0.5 * depth**2 * 16.0, rel=1e-6
    )
    assert float(found["transmission_error_sideband_energy"].sel(harmonic=1, gear="wheel")) < 1e-12
    decibels = 10.0 * np.log10(0.5 * depth**2)
    assert any(f"{decibels:+.1f}\u00a0dB at order 1" in chart.caption for chart in noise_charts(found))
    assert "mesh_force_level" not in found


def test_sidebands_of_a_mesh_order_that_is_round_off_have_no_ratio(paper_scene):
    """Definition: a force that varies once a turn of the wheel, as by the load of a quasi-static run."""
    found = noise_figures(made_up(paper_scene, PERIOD, cosine(1.0, 4.0), cosine(1.0 / 24.0, 300.0)))
    assert found["mesh_force_sideband_ratio"].isnull().all()
    assert found["transmission_error_sideband_ratio"].sel(harmonic=1).notnull()
    assert "sidebands" not in noise_charts(found)[1].caption


def test_a_short_record_has_mesh_orders_but_no_sidebands(paper_scene):
    """Definition: two mesh cycles hold nothing that comes once a turn."""
    found = noise_figures(made_up(paper_scene, 2, cosine(1.0)))
    assert "transmission_error_sideband_ratio" not in found
    assert float(found["transmission_error_amplitude"].sel(order=1.0)) == pytest.approx(1.0, rel=1e-9)
    for cycles, window, needed in ((0.5, None, 1), (2, HANN, 4), (9, FLAT_TOP, 10)):
        with pytest.raises(ComputationError, match=f"{cycles} settled mesh cycles are stored; .* needs {needed}"):
            noise_figures(made_up(paper_scene, cycles, cosine(1.0)), window)


def test_orders_of_a_ramp_are_those_that_scipy_finds(paper_scene):
    """Another program: scipy.signal.stft; and the amplitude that was put in."""
    cycles = 100
    run = made_up(
        paper_scene,
        cycles,
        lambda phase: (1.0 + phase / cycles) * cosine(2.0)(phase),
        cosine(1.0, 7.0),
        lambda phase: 100.0 + phase,
    )
    found = noise_figures(run)
    amplitudes = found["transmission_error_amplitude"].sel(order=2).values
    middle = found["mesh_frequency"].values - 100.0
    np.testing.assert_allclose(amplitudes, 1.0 + middle / cycles, rtol=2e-3)
    np.testing.assert_allclose(found["mesh_force_level"].sel(order=1), 20.0 * np.log10(7.0), atol=1e-6)
    values = run["transmission_error"].values * RADIUS * 1e3
    orders, _, scipys = scipy.signal.stft(values, STEPS, "flattop", 10 * STEPS, 5 * STEPS, boundary=None, padded=False)
    np.testing.assert_allclose(
        amplitudes, 2.0 * np.abs(scipys[np.argmin(np.abs(orders - 2.0))])[: len(amplitudes)], rtol=1e-5
    )


def test_the_command_writes_them(paper_scene, tmp_path, capsys):
    """The files, and the charts' axes."""
    run = made_up(paper_scene, PERIOD, cosine(1.0, 4.0), cosine(1.0, 30.0))
    save(run, tmp_path / "run.nc")
    assert main(["plot", str(tmp_path), "--spectrum", "flat-top"]) == 0
    names = {line.rpartition("/")[2] for line in capsys.readouterr().out.split()}
    assert {"noise.nc", "noise.png", "noise_over_order.csv"} <= names
    assert [chart.y_title for chart in noise_charts(noise_figures(run))] == [
        "Level of the amplitude (dB re 1 µm)",
        "Level of the amplitude (dB re 1 N)",
    ]
    ramp = noise_figures(made_up(paper_scene, 40, cosine(1.0, 4.0), cosine(1.0, 30.0), lambda phase: 100.0 + phase))
    assert [len(chart.curves) for chart in noise_charts(ramp)] == [5, 5]
