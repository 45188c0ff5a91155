"""A result as a NetCDF-4 file: written whole or not at all, and refused when read back damaged."""

from __future__ import annotations

import io
import os
from collections.abc import Collection
from pathlib import Path
from typing import BinaryIO

import xarray as xr

from fenics_gears.errors import ComputationError
from fenics_gears.system.sealed import seal_of, unsealed


def save(result: xr.Dataset, path: str | Path) -> None:
    """Write a dataset as NetCDF-4 with a digest at its end; it appears under its name only when whole.

    Raises OSError where the disk is full or the directory cannot be written.
    """
    from fenics_gears.results.netcdf import write_netcdf

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
    """A file for HDF5, which itself does not come back cleanly from a full disk: this goes on in memory then, and has
    the `failure`."""

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


def load(path: str | Path) -> xr.Dataset:
    """Read a saved result into memory. Raises ComputationError when the
    file is no result of this program, or damaged.

    >>> load("demos/lundvall2004.toml")  # doctest: +ELLIPSIS
    Traceback (most recent call last):
        ...
    fenics_gears.errors.ComputationError: demos/lundvall2004.toml: cannot be read as a result: ...
    """
    result = read(path)
    if "transmission_error" not in result or "scene" not in result.attrs:
        raise ComputationError(f"{path}: holds no run of this program (no transmission_error, no scene text)")
    # The contents' layout, imported here: writing a result does not need it.
    from fenics_gears.results.layout import mistake_in

    if mistake := mistake_in(result):
        raise ComputationError(f"{path}: is no whole result of this program: {mistake}. Run its scene again.")
    return result


def read(path: str | Path, names: Collection[str] | None = None) -> xr.Dataset:
    """Read a saved dataset, whatever it holds, into memory, or only its variables of these names. Raises
    ComputationError when it is damaged or not written by `save`."""
    from fenics_gears.results.netcdf import read_netcdf

    try:
        with unsealed(Path(path)) as content:
            return read_netcdf(content, names)
    # HDF5 and xarray raise whatever they meet in a damaged file: RuntimeError, KeyError, AttributeError, TypeError.
    except Exception as failure:
        raise ComputationError(f"{path}: cannot be read as a result: {failure}") from failure
