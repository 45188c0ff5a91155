"""A result on disk: NetCDF-4, written whole or not at all."""

from __future__ import annotations

import os
from pathlib import Path

import xarray as xr

from fenics_gears.errors import ComputationError


def save(result: xr.Dataset, path: str | Path) -> None:
    """Write a dataset as NetCDF-4; it appears under its name only when whole."""
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    aside = path.with_name(f".{path.name}.{os.getpid()}.part")
    encoding = {
        name: {"zlib": True, "complevel": 1} for name, variable in result.data_vars.items() if variable.ndim > 1
    }
    try:
        result.to_netcdf(aside, engine="h5netcdf", encoding=encoding)
        os.replace(aside, path)
    finally:
        aside.unlink(missing_ok=True)


def load(path: str | Path) -> xr.Dataset:
    """Read a saved result into memory. Raises ComputationError when the file is no result of this program."""
    try:
        with xr.open_dataset(path, engine="h5netcdf") as opened:
            result = opened.load()
    except (OSError, ValueError) as failure:
        raise ComputationError(f"{path}: cannot be read as a result: {failure}") from failure
    if "transmission_error" not in result or "scene" not in result.attrs:
        raise ComputationError(f"{path}: holds no run of this program (no transmission_error, no scene text)")
    return result
