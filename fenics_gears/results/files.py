"""A result as a NetCDF-4 file: written whole or not at all, and refused when read back damaged."""

from __future__ import annotations

import io
import os
from pathlib import Path

import xarray as xr

from fenics_gears.errors import ComputationError
from fenics_gears.results.old_layout import upgraded
from fenics_gears.system.sealed import seal, unsealed


def save(result: xr.Dataset, path: str | Path) -> None:
    """Write a dataset as NetCDF-4 with a digest at its end; it appears under its name only when whole.

    Raises OSError where the disk is full or the directory cannot be written.
    """
    path = Path(path)
    content = netcdf(result)
    path.parent.mkdir(parents=True, exist_ok=True)
    aside = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        with open(aside, "wb") as file:
            file.write(content)
            file.write(seal(content))
            file.flush()
            os.fsync(file.fileno())
        os.replace(aside, path)
    finally:
        aside.unlink(missing_ok=True)


def netcdf(dataset: xr.Dataset) -> memoryview:
    """A dataset as the bytes of a NetCDF-4 file, what has several dimensions compressed.

    Made in memory, since HDF5 itself does not come back cleanly from a full disk.
    """
    import h5netcdf
    from xarray.backends import H5NetCDFStore

    encoding = {name: {"zlib": True, "complevel": 1} for name, variable in dataset.data_vars.items() if variable.ndim > 1}
    content = io.BytesIO()
    with h5netcdf.File(content, "w") as file:
        dataset.dump_to_store(H5NetCDFStore(file), encoding=encoding)
    return content.getbuffer()


def load(path: str | Path) -> xr.Dataset:
    """Read a saved result into memory, one of an earlier layout as results are now. Raises ComputationError when the file is no result of this program, or damaged."""
    result = read(path)
    if "transmission_error" not in result or "scene" not in result.attrs:
        raise ComputationError(f"{path}: holds no run of this program (no transmission_error, no scene text)")
    return upgraded(result)


def read(path: str | Path) -> xr.Dataset:
    """Read a saved dataset, whatever it holds, into memory. Raises ComputationError when it is damaged or not written by `save`."""
    try:
        with xr.open_dataset(unsealed(Path(path)), engine="h5netcdf") as opened:
            return opened.load()
    except (OSError, ValueError) as failure:
        raise ComputationError(f"{path}: cannot be read as a result: {failure}") from failure
