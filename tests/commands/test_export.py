"""`gears export`."""

import numpy as np
import pandas
import pytest
import xarray as xr

from fenics_gears import results
from fenics_gears.commands.cli import main


@pytest.fixture
def run(tmp_path):
    steps = 7
    numbers = np.random.default_rng(1)

    def variable(dims, unit):
        sizes = {"time": steps, "gear": 2, "slot": 3}
        return (
            dims,
            numbers.normal(size=[sizes[dim] for dim in dims]) * 10.0 ** numbers.integers(-9, 9),
            {"units": unit, "long_name": "anything"},
        )

    dataset = xr.Dataset(
        {
            "transmission_error": variable(("time",), "rad"),
            "rotation": variable(("time", "gear"), "rad"),
            "pair_normal_force": variable(("time", "slot"), "N"),
            "pair_number": (("time", "slot"), np.zeros((steps, 3), int), {"units": "1", "number_at_phase_0": 1}),
            "newton_iterations": (("time",), np.arange(steps), {"units": "1"}),
        },
        {
            "time": ("time", 0.1 + 1e-5 * np.arange(steps), {"units": "s"}),
            "mesh_phase": ("time", np.linspace(0, 1, steps), {"units": "1"}),
            "gear": ["pinion", "wheel"],
        },
        {"complete": 1, "scene": "title = 'synthetic'"},
    )
    results.save(dataset, tmp_path / "run.nc")
    return tmp_path, dataset


def test_table_is_the_result(run, capsys):
    """Read by pandas, to the digits that are written."""
    directory, dataset = run
    assert main(["export", str(directory)]) == 0 and capsys.readouterr().out.strip() == str(directory / "curves.csv")
    table = pandas.read_csv(directory / "curves.csv")
    heads = [
        "time [s]",
        "mesh_phase",
        "transmission_error [rad]",
        "rotation pinion [rad]",
        "rotation wheel [rad]",
        "newton_iterations",
    ]
    assert list(table.columns) == heads and len(table) == dataset.sizes["time"]
    expected = [
        dataset.time,
        dataset.mesh_phase,
        dataset.transmission_error,
        *dataset.rotation.transpose("gear", "time"),
        dataset.newton_iterations,
    ]
    np.testing.assert_allclose(table.to_numpy().T, np.array([each.values for each in expected]), rtol=1e-11, atol=0)


def test_wrong_calls_write_nothing(run, tmp_path, capsys):
    """Exit code 2 and what to do."""
    directory, _ = run
    before = sorted(directory.iterdir())
    assert main(["export", str(directory), "-o", str(directory / "curves.xlsx")]) == 2
    assert "a .csv file" in capsys.readouterr().err
    (directory / "broken.nc").write_bytes((directory / "run.nc").read_bytes()[:500])
    assert main(["export", str(directory / "broken.nc")]) == 2 and main(["export", str(directory / "none")]) == 2
    (directory / "broken.nc").unlink()
    assert sorted(directory.iterdir()) == before
