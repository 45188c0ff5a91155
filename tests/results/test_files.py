"""The file of a result against another program's."""

import io

import numpy as np
import xarray as xr

from fenics_gears.results.files import write_netcdf


def several_kinds(steps: int) -> xr.Dataset:
    """A dataset with all kinds of values that results have: numbers with gaps, whole numbers, switches, texts, a dimension without values."""
    values = np.linspace(0.0, 1.0, 2 * steps).reshape(steps, 2)
    values[:1] = np.nan
    return xr.Dataset(
        {
            "force": (("time", "gear"), values, {"units": "N", "long_name": "force"}),
            "count": ("time", np.arange(steps, dtype=np.int32), {"units": "1"}),
            "open": (("time", "node"), np.zeros((steps, 3), dtype=bool)),
            "why": ("gear", np.array(["", "Größe µm"], dtype=object)),
            "single": ((), 2.5),
        },
        coords={"time": ("time", np.arange(steps) * 0.1, {"units": "mm"}), "gear": ["pinion", "wheel"], "phase": ("time", np.arange(steps) / 2.0)},
        attrs={"title": "größer", "number": 3.5, "steps": steps, "empty": ""},
    )


def test_a_file_is_read_as_if_another_program_had_written_it():
    """Authority: another program; xarray writes the same dataset by h5netcdf, and both files are read as the same, of no step too."""
    for steps in (0, 5):
        ours = several_kinds(steps)
        theirs = _by_h5netcdf(ours)
        content = io.BytesIO()
        write_netcdf(ours, content)
        with xr.open_dataset(content, engine="h5netcdf") as read, xr.open_dataset(theirs, engine="h5netcdf") as expected:
            assert read.load().identical(expected.load())
            assert read.identical(ours)


def _by_h5netcdf(dataset: xr.Dataset) -> io.BytesIO:
    import h5netcdf
    from xarray.backends import H5NetCDFStore

    content = io.BytesIO()
    with h5netcdf.File(content, "w") as file:
        dataset.dump_to_store(H5NetCDFStore(file))
    return io.BytesIO(content.getvalue())
