"""A result as a NetCDF-4 file: written whole or not at all, and refused when read back damaged."""

from __future__ import annotations

import io
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
import xarray as xr
from xarray.conventions import cf_encoder, encode_dataset_coordinates

from fenics_gears.errors import ComputationError
from fenics_gears.results.old_layout import upgraded
from fenics_gears.system.sealed import seal_of, unsealed


def save(result: xr.Dataset, path: str | Path) -> None:
    """Write a dataset as NetCDF-4 with a digest at its end; it appears under its name only when whole.

    Raises OSError where the disk is full or the directory cannot be written.
    """
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    aside = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        with open(aside, "w+b", buffering=0) as file:
            written = NeverFull(file)
            write_netcdf(result, written)
            if written.failure is not None:
                raise written.failure
            file.write(seal_of(file, file.seek(0, os.SEEK_END)))
            os.fsync(file.fileno())
        os.replace(aside, path)
    finally:
        aside.unlink(missing_ok=True)


class NeverFull:
    """A file for HDF5, which itself does not come back cleanly from a full disk: this goes on in memory then, and has the `failure`."""

    def __init__(self, file: BinaryIO):
        self._file = file
        self.failure: OSError | None = None

    def __getattr__(self, name: str):
        """Whatever cannot fail for want of room."""
        return getattr(self._file, name)

    def write(self, content) -> int:
        """Write all of it."""
        left, place = memoryview(content).cast("B"), self._file.tell()
        try:
            while left:
                left = left[self._file.write(left) :]
        except OSError as failure:
            self._go_on_in_memory(failure)
            self._file.seek(place)
            self._file.write(content)
        return len(content)

    def truncate(self, size: int | None = None) -> int:
        """Make it as long as that."""
        try:
            return self._file.truncate(size)
        except OSError as failure:
            self._go_on_in_memory(failure)
            return self._file.truncate(size)

    def _go_on_in_memory(self, failure: OSError) -> None:
        self.failure, place = failure, self._file.tell()
        self._file.seek(0)
        self._file = io.BytesIO(self._file.read())
        self._file.seek(place)


def write_netcdf(dataset: xr.Dataset, content) -> None:
    """Write a dataset into an empty open file as NetCDF-4, what has several dimensions compressed.

    Written by h5py, as the NetCDF-4 format specification
    (appendix "NetCDF-4 format" of the NetCDF user's guide) has dimensions and attributes in HDF5: h5netcdf takes five times as long for so many variables.
    """
    import h5py

    variables, attributes = cf_encoder(*encode_dataset_coordinates(dataset))
    with h5py.File(content, "w", track_order=True) as file:
        _write_attributes(file, attributes)
        written = {name: _write_variable(file, name, variable) for name, variable in variables.items()}
        scales = {name: written.get(name) or file.create_dataset(name, (size,), ">f4") for name, size in dataset.sizes.items()}
        for number, (name, scale) in enumerate(scales.items()):
            scale.make_scale(name if name in variables else f"This is a netCDF dimension but not a netCDF variable.{scale.size:10}")
            scale.attrs["_Netcdf4Dimid"] = np.int32(number)
        for name, values in written.items():
            for axis, dimension in enumerate(variables[name].dims):
                if name not in scales:
                    h5py.h5ds.attach_scale(values.id, scales[dimension].id, axis)


def _write_variable(file, name: str, variable: xr.Variable):
    """The HDF5 dataset of an encoded variable."""
    import h5py

    values = np.asarray(variable.data)
    if values.dtype.kind in "OU":
        values = values.astype(h5py.string_dtype())
    compressed = {"compression": "gzip", "compression_opts": 1, "shuffle": True} if values.ndim > 1 and values.size else {}
    written = file.create_dataset(name, data=values, fillvalue=variable.attrs.get("_FillValue"), track_order=True, **compressed)
    _write_attributes(written, variable.attrs)
    return written


def _write_attributes(place, attributes: Mapping[str, Any]) -> None:
    """As `place.attrs.update(attributes)`, single values, of which there are hundreds, by HDF5's own call: a third of the time."""
    import h5py

    string, scalar = h5py.string_dtype(), h5py.h5s.create(h5py.h5s.SCALAR)
    for name, value in attributes.items():
        array = np.array(value, dtype=string if isinstance(value, str) else None)
        if array.ndim or array.dtype.kind not in "Oif":
            place.attrs[name] = value
        else:
            h5py.h5a.create(place.id, name.encode(), h5py.h5t.py_create(array.dtype, logical=True), scalar).write(array)


def load(path: str | Path) -> xr.Dataset:
    """Read a saved result into memory, one of an earlier layout as results are now. Raises ComputationError when the file is no result of this program, or damaged."""
    result = read(path)
    if "transmission_error" not in result or "scene" not in result.attrs:
        raise ComputationError(f"{path}: holds no run of this program (no transmission_error, no scene text)")
    return upgraded(result)


def read(path: str | Path) -> xr.Dataset:
    """Read a saved dataset, whatever it holds, into memory. Raises ComputationError when it is damaged or not written by `save`."""
    try:
        with unsealed(Path(path)) as content, xr.open_dataset(content, engine="h5netcdf") as opened:
            return opened.load()
    except (OSError, ValueError) as failure:
        raise ComputationError(f"{path}: cannot be read as a result: {failure}") from failure
