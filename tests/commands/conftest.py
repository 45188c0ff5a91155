"""A module in the place of the simulation."""

import sys
import types
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from tests.programs import DEMO

from fenics_gears.commands.work import kept_run


def small_result(complete=1):
    steps = ("time",)
    return xr.Dataset(
        {"transmission_error": (steps, np.array([0.0, 1e-4, 2e-4])), "newton_iterations": (steps, np.array([2, 3, 4]))},
        {"time": np.arange(3.0), "mesh_phase": (steps, np.arange(3.0) / 2.0)},
        attrs={
            "complete": complete,
            "scene": DEMO.read_text(),
            "mean_transmission_error": 5e-5,
            "peak_to_peak_transmission_error": 2e-4,
            "base_radius_wheel": 50.0,
            "time_mesh": 1.25,
            "time_march": 2.5,
        },
    )


@pytest.fixture
def simulation(monkeypatch, tmp_path):
    """Its ``outcome`` is kept and goes through ``afterwards``, or is raised; the test runs in an empty directory."""
    monkeypatch.chdir(tmp_path)
    stand_in = types.SimpleNamespace()
    stand_in.outcome, stand_in.calls = small_result(), []
    stand_in.afterwards = lambda result: result

    def simulate(scene, *, progress=None, job=None, journal=None, keep=None):
        stand_in.calls.append(scene)
        progress.stage("march")
        progress.update(1, 3)
        if isinstance(stand_in.outcome, BaseException):
            raise stand_in.outcome
        keep(stand_in.outcome)
        return stand_in.afterwards(stand_in.outcome)

    plots = types.ModuleType("fenics_gears.show.plots")

    def draw_run(dataset, directory):
        picture = Path(directory) / "transmission_error.png"
        picture.write_bytes(b"picture")
        return [picture]

    plots.draw_run = draw_run
    stand_in.simulate = simulate
    monkeypatch.setattr(kept_run, "simulate", lambda *given, **options: stand_in.simulate(*given, **options))
    monkeypatch.setitem(sys.modules, "fenics_gears.show.plots", plots)
    return stand_in


def files(directory):
    return sorted(str(each.relative_to(directory)) for each in Path(directory).rglob("*") if each.is_file())
