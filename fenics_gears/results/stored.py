"""A saved result of which only what is asked for is read: of each of a study's cases a twentieth."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from functools import cached_property
from typing import Any, BinaryIO

import h5py
import numpy as np


class StoredResult:
    """A result in an open file: `attrs`, and variables by name, which have `values` and `attrs`; each is read when it
    is asked for."""

    def __init__(self, root: h5py.h5g.GroupID):
        self._root = root
        self.attrs = Attributes(root)

    def __contains__(self, name: str) -> bool:
        return name.encode() in self._root

    def __getitem__(self, name: str) -> StoredVariable:
        return StoredVariable(h5py.h5d.open(self._root, name.encode()))


class StoredVariable:
    """A variable of numbers in an open file, an array where one is wanted."""

    def __init__(self, held: h5py.h5d.DatasetID):
        self._held = held
        self.attrs = Attributes(held)

    @cached_property
    def values(self) -> np.ndarray:
        return _read(self._held, h5py.h5s.ALL, h5py.h5s.ALL)

    def __array__(self, kind: Any = None) -> np.ndarray:
        return np.asarray(self.values, kind)


class Attributes(Mapping[str, Any]):
    """Numbers and texts at a place in an open file."""

    def __init__(self, place: h5py.h5g.GroupID | h5py.h5d.DatasetID):
        self._place = place

    def __getitem__(self, name: str) -> Any:
        # HDF5's own call, which raises KeyError too: hundreds of attributes take a third of the time.
        array = _read(h5py.h5a.open(self._place, name.encode()))
        value = array[0] if array.shape == (1,) else array[()]
        return value.decode() if isinstance(value, bytes) else value

    def __contains__(self, name: object) -> bool:
        return h5py.h5a.exists(self._place, str(name).encode())

    def __iter__(self) -> Iterator[str]:
        return (h5py.h5a.open(self._place, index=i).name.decode() for i in range(len(self)))

    def __len__(self) -> int:
        return h5py.h5a.get_num_attrs(self._place)


def _read(held: h5py.h5d.DatasetID | h5py.h5a.AttrID, *spaces: Any) -> np.ndarray:
    array = np.empty(held.shape, held.dtype)
    held.read(*spaces, array)
    return array


@contextmanager
def stored(content: BinaryIO) -> Iterator[StoredResult]:
    """The result in an open NetCDF-4 file."""
    with h5py.File(content) as file:
        yield StoredResult(file["/"].id)
