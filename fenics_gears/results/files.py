"""A result as a NetCDF-4 file: written whole or not at all, and refused when read back damaged.

h5py writes and reads it as the format's specification has dimensions and attributes in HDF5 (appendix "NetCDF-4 format"
of the NetCDF user's guide). Datasets alike in all but values, such as the runs of a study, begin as copies of one file
without values. HDF5 takes longer to make fifty variables with attributes than to fill them.
"""

from __future__ import annotations

import functools
import io
import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, BinaryIO

import h5py
import numpy as np
import xarray as xr
from xarray.conventions import cf_encoder, encode_dataset_coordinates

from fenics_gears.errors import ComputationError
from fenics_gears.system.output import seal_of, unsealed, whole_file


def save(result: xr.Dataset, path: str | Path) -> None:
    """Write a dataset as NetCDF-4 with a digest at its end; it appears under its name only when whole.

    Raises OSError where the disk is full or the directory cannot be written.
    """
    with whole_file(Path(path), buffering=0) as file:
        written = FileNeverFull(file)
        write_netcdf(result, written)
        if written.failure is not None:
            raise written.failure
        file.write(seal_of(file, file.seek(0, os.SEEK_END)))


class FileNeverFull:
    """A file for HDF5, which does not come back cleanly from a full disk: this goes on in memory then, and has the
    `failure`."""

    def __init__(self, file: BinaryIO):
        self._file = file
        self.failure: OSError | None = None

    def __getattr__(self, name: str):
        return getattr(self._file, name)

    def write(self, content) -> int:
        """Write all of it."""
        left = memoryview(content).cast("B")
        place = self._file.tell()
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
        self.failure = failure
        place = self._file.tell()
        self._file.seek(0)
        self._file = io.BytesIO(self._file.read())
        self._file.seek(place)


def load(path: str | Path) -> xr.Dataset:
    """Read a saved result into memory. Raises ComputationError when the file is no result of this program, or damaged.

    >>> load("demos/lundvall2004.toml")  # doctest: +ELLIPSIS
    Traceback (most recent call last):
        ...
    fenics_gears.errors.ComputationError: demos/lundvall2004.toml: cannot be read as a result: ...
    """
    result = read(path)
    if "transmission_error" not in result or "scene" not in result.attrs:
        raise ComputationError(f"{path}: holds no run of this program (no transmission_error, no scene text)")
    # Imported here: writing a result does not need it.
    from .layout import mistake_in

    if mistake := mistake_in(result):
        raise ComputationError(f"{path}: is no whole result of this program: {mistake}. Run its scene again.")
    return result


def read(path: str | Path) -> xr.Dataset:
    """Read a saved dataset into memory. Raises ComputationError when it is damaged or not written by `save`."""
    try:
        with unsealed(Path(path)) as content:
            return read_netcdf(content)
    # HDF5 and xarray raise whatever they meet in a damaged file: RuntimeError, KeyError, AttributeError, TypeError.
    except Exception as failure:
        raise ComputationError(f"{path}: cannot be read as a result: {failure}") from failure


# Smaller arrays take longer to compress than the disk takes to hold them.
LEAST_COMPRESSED = 131_072  # bytes
# As many as HDF5 keeps unpacked of an array while it is read.
LARGEST_CHUNK = 1_048_576  # bytes
# Up to here a file is made in memory, which HDF5 does in a third of the time.
MOST_IN_MEMORY = 67_108_864  # bytes
OPEN_TO_WRITE = 1  # H5LT_FILE_IMAGE_OPEN_RW
TEXT = h5py.string_dtype()


def write_netcdf(dataset: xr.Dataset, content) -> None:
    """Write a dataset into an empty open file as NetCDF-4, large arrays of several dimensions compressed."""
    variables, attributes = cf_encoder(*encode_dataset_coordinates(dataset))
    values = {name: _as_stored(variable) for name, variable in variables.items()}
    layout = [
        (name, each.dtype.str, each.shape, variables[name].dims, variables[name].attrs) for name, each in values.items()
    ]
    without_values = _without_values(Layout.of(layout, dict(dataset.sizes)))
    if dataset.nbytes > MOST_IN_MEMORY:
        content.write(without_values)
        with h5py.File(content, "r+") as file:
            _fill(file, values, attributes)
        return
    with h5py.File(h5py.h5f.open_file_image(without_values, OPEN_TO_WRITE)) as file:
        _fill(file, values, attributes)
        file.flush()
        content.write(file.id.get_file_image())


def _as_stored(variable: xr.Variable) -> np.ndarray:
    """The values of an encoded variable, in the order of HDF5."""
    values = np.asarray(variable.data, order="C")
    return values.astype(TEXT) if values.dtype.kind in "OU" else values


@dataclass(frozen=True)
class Layout:
    """What a dataset has but its values: of each variable name, type, shape, dimensions and attributes, and the sizes
    of dimensions; equal in `words`, which tell apart whatever files would."""

    words: str
    variables: list[tuple] = field(compare=False)
    sizes: dict[str, int] = field(compare=False)

    @classmethod
    def of(cls, variables: list[tuple], sizes: dict[str, int]) -> Layout:
        typed = [
            (*each, [str(getattr(value, "dtype", type(value))) for value in each[-1].values()]) for each in variables
        ]
        return cls(repr((typed, sizes)), variables, sizes)


@functools.lru_cache(maxsize=4)
def _without_values(layout: Layout) -> bytes:
    """A file that has all of a dataset but its values and its own attributes."""
    content = io.BytesIO()
    sizes = layout.sizes
    dims = {name: dims for name, _, _, dims, _ in layout.variables}
    with h5py.File(content, "w", track_order=True) as file:
        written = {name: _made(file, name, kind, shape, labels) for name, kind, shape, _, labels in layout.variables}
        scales = {name: written.get(name) or file.create_dataset(name, (size,), ">f4") for name, size in sizes.items()}
        for number, (name, scale) in enumerate(scales.items()):
            scale.make_scale(
                name if name in dims else f"This is a netCDF dimension but not a netCDF variable.{scale.size:10}"
            )
            scale.attrs["_Netcdf4Dimid"] = np.int32(number)
        for name, made in written.items():
            for axis, dimension in enumerate(dims[name]):
                if name not in scales:
                    h5py.h5ds.attach_scale(made.id, scales[dimension].id, axis)
    return content.getvalue()


def _made(file: h5py.File, name: str, kind: str, shape: tuple[int, ...], labels: Mapping[str, Any]) -> h5py.Dataset:
    type_of_values = TEXT if kind == "|O" else np.dtype(kind)
    packed: dict[str, Any] = {}
    if len(shape) > 1 and (size := type_of_values.itemsize * int(np.prod(shape))) > LEAST_COMPRESSED:
        rows = max(1, min(shape[0], LARGEST_CHUNK * shape[0] // size))
        packed = {"chunks": (rows, *shape[1:]), "compression": "gzip", "compression_opts": 1, "shuffle": True}
    made = file.create_dataset(
        name, shape, type_of_values, fillvalue=labels.get("_FillValue"), track_order=True, **packed
    )
    _write_attributes(made, labels)
    return made


def _fill(file: h5py.File, values: Mapping[str, np.ndarray], attributes: Mapping[str, Any]) -> None:
    _write_attributes(file, attributes)
    for name, each in values.items():
        if each.size:
            h5py.h5d.open(file.id, name.encode()).write(h5py.h5s.ALL, h5py.h5s.ALL, each)


def _write_attributes(place, attributes: Mapping[str, Any]) -> None:
    """As `place.attrs.update(attributes)`, single values, of which there are hundreds, by HDF5's own call: a third of
    the time."""
    scalar = h5py.h5s.create(h5py.h5s.SCALAR)
    for name, value in attributes.items():
        array = np.array(value, dtype=TEXT if isinstance(value, str) else None)
        if array.ndim or array.dtype.kind not in "Oif":
            place.attrs[name] = value
        else:
            h5py.h5a.create(place.id, name.encode(), h5py.h5t.py_create(array.dtype, logical=True), scalar).write(array)


# What the format keeps in attributes of its own.
OF_THE_FORMAT = {
    "CLASS", "NAME", "DIMENSION_LIST", "REFERENCE_LIST", "_Netcdf4Dimid", "_Netcdf4Coordinates", "_NCProperties",
    "_nc3_strict",
}  # fmt: skip
NO_VARIABLE = "This is a netCDF dimension but not a netCDF variable"


def read_netcdf(content) -> xr.Dataset:
    """The dataset in an open NetCDF-4 file, in memory: as `xarray.open_dataset`, in a third of the time."""
    variables = {}
    with h5py.File(content) as file:
        # As a group the root has its names in the order in which they were written.
        for name in file["/"]:
            held = file[name]
            attributes = dict(held.attrs)
            if _text(attributes.get("NAME", "")).startswith(NO_VARIABLE):
                continue
            dims = (name,)[: held.ndim] if "CLASS" in attributes else ()
            if "DIMENSION_LIST" in attributes:
                dims = tuple(h5py.h5r.get_name(each[0], file.id)[1:].decode() for each in attributes["DIMENSION_LIST"])
            values = held.asstr()[()] if held.dtype.kind == "O" else held[()]
            variables[name] = _decoded(dims, values, _labels(attributes))
        attributes = _labels(dict(file["/"].attrs))
    coordinates = set(attributes.pop("coordinates", "").split())
    for each in variables.values():
        named = each.attrs.get("coordinates", "").split()
        if named and all(name in variables for name in named):
            each.encoding["coordinates"] = each.attrs.pop("coordinates")
            coordinates.update(named)
    return xr.Dataset(variables, attrs=attributes).set_coords(coordinates & variables.keys())


def _decoded(dims: tuple[str, ...], values: np.ndarray, labels: dict[str, Any]) -> xr.Variable:
    """A variable by the conventions that `write_netcdf` follows: what is missing is not a number, and switches are
    whole numbers."""
    encoding: dict[str, Any] = {"dtype": values.dtype}
    if "_FillValue" in labels:
        encoding["_FillValue"] = labels.pop("_FillValue")
    if labels.get("dtype") == "bool":
        values = values.astype(labels.pop("dtype"))
    return xr.Variable(dims, values, labels, encoding)


def _labels(attributes: Mapping[str, Any]) -> dict[str, Any]:
    return {
        name: value[0] if np.shape(value) == (1,) else value
        for name, value in attributes.items()
        if name not in OF_THE_FORMAT
    }


def _text(value: Any) -> str:
    return value.decode() if isinstance(value, bytes) else str(value)
