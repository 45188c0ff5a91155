"""Results kept on disk under the hash of all their inputs; beyond a limit of size the longest unused go first.

An entry is one immutable file, made and removed by a single call of the file system. That is safe on the file systems
of clusters too, where the locks of a database, as in `diskcache`, do not hold.
"""

from __future__ import annotations

import hashlib
import io
import json
import logging
import os
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass, field, fields
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np

from fenics_gears.system.memory import size_in_bytes
from fenics_gears.system.output import remove_left_over, seal, unsealed, whole_file

LOGGER = logging.getLogger(__name__)
DIRECTORY_VARIABLE = "FENICS_GEARS_CACHE"
FORMAT = "fenics_gears cache 2"
SIZE_VARIABLE = "FENICS_GEARS_CACHE_SIZE"
DEFAULT_SIZE = "2 GB"


def content_key(inputs: dict) -> str:
    """Hash of inputs made of numbers, strings, lists, dicts and dataclasses, the same on every machine."""
    return hashlib.sha256(as_json(inputs).encode()).hexdigest()


def as_json(inputs: Any) -> str:
    """Such inputs in the words of which their key is the hash."""
    return json.dumps(inputs, sort_keys=True, separators=(",", ":"), allow_nan=False, default=_fields_of)


def _fields_of(data: Any) -> dict[str, Any]:
    return {each.name: getattr(data, each.name) for each in fields(data)}


def user_cache() -> Cache:
    """The cache in the directory named by FENICS_GEARS_CACHE, else in the user's cache directory, of at most
    FENICS_GEARS_CACHE_SIZE. Raises SceneError for a size that cannot be read."""
    directory = os.environ.get(DIRECTORY_VARIABLE)
    if not directory:
        from platformdirs import user_cache_dir

        directory = user_cache_dir("fenics_gears")
    limit = os.environ.get(SIZE_VARIABLE) or DEFAULT_SIZE
    return Cache(Path(directory), size_in_bytes(limit, SIZE_VARIABLE, DEFAULT_SIZE))


def kept(
    cache: Cache | None, inputs: dict, compute: Callable[[], tuple[dict, dict]]
) -> tuple[dict[str, np.ndarray], dict]:
    """Arrays that follow from inputs, and the times (s) that they took: from the cache, else by ``compute()`` and then
    stored."""
    clock = perf_counter()
    arrays = None if cache is None else cache.load(key := content_key(inputs))
    if arrays is not None:
        spent = {"time_mesh": 0.0, "time_compile": 0.0, "time_condense": perf_counter() - clock}
        return arrays, {"from_cache": True, **spent}
    arrays, timings = compute()
    if cache is not None:
        cache.store(key, arrays)
    return arrays, {"from_cache": False, **timings}


@dataclass(frozen=True)
class Entry:
    """A file of the cache: its size in bytes, and when it was last stored or read, s since the epoch."""

    path: Path
    size: int
    used: float


@dataclass(frozen=True)
class Cache:
    """Named arrays by key, one HDF5 file each. It never raises: what cannot be read or kept is computed again.

    limit: bytes of all entries together, None for no limit. The entry stored last stays, whatever its size.
    """

    directory: Path
    limit: float | None = None

    def path(self, key: str) -> Path:
        """File of an entry."""
        return Path(self.directory) / f"{key}.h5"

    def load(self, key: str) -> dict[str, np.ndarray] | None:
        """Arrays kept under a key; None, with a warning if the entry is damaged, where there are none."""
        import h5py

        path = self.path(key)
        try:
            if not path.exists():
                return None
            with unsealed(path) as content, h5py.File(content, "r") as file:
                if tuple(file.attrs.get(name) for name in ("format", "key")) != (FORMAT, key):
                    raise ValueError("it was stored under another name, or by another version")
                arrays = {name: np.asarray(file[name]) for name in file}
            _mark_as_used(path)
            return arrays
        except (OSError, ValueError) as error:
            LOGGER.warning("cache entry %s is not usable and is computed again: %s", path, error)
            return None

    def store(self, key: str, arrays: dict[str, np.ndarray]) -> None:
        """Keep arrays under a key; the file appears under its name only when it is complete."""
        self._write(key, _file_content(key, arrays))

    def _write(self, key: str, content: bytes) -> None:
        try:
            with whole_file(self.path(key)) as file:
                file.write(content)
                file.write(seal(content))
            self._keep_within_limit(self.path(key))
        except OSError as error:
            LOGGER.warning("cache: nothing is kept in %s: %s", self.directory, error)

    def entries(self) -> list[Entry]:
        """The complete entries, the longest unused first."""
        entries = []
        for path in Path(self.directory).glob("*.h5"):
            try:
                if path.is_file():
                    entries.append(Entry(path, (status := path.stat()).st_size, status.st_mtime))
            except OSError:
                # Another run has removed it meanwhile.
                continue
        return sorted(entries, key=lambda entry: entry.used)

    def clear(self) -> list[Entry]:
        """Remove all complete entries and what killed runs left; returns the removed entries."""
        entries = self.entries()
        for entry in entries:
            _remove(entry.path)
        remove_left_over(self.directory)
        return entries

    def _keep_within_limit(self, stored: Path) -> None:
        if self.limit is None:
            return
        remove_left_over(self.directory)
        entries = self.entries()
        size = sum(entry.size for entry in entries)
        for entry in entries:
            if size <= self.limit:
                return
            # A run that has the file open reads on; another run may remove it at the same time.
            if entry.path != stored:
                _remove(entry.path)
                size -= entry.size


@dataclass(frozen=True)
class _WritingMeanwhile(Cache):
    """See `writing_meanwhile`. Entries are written and read in the order in which that was asked for."""

    thread: ThreadPoolExecutor = field(kw_only=True)

    def load(self, key: str) -> dict[str, np.ndarray] | None:
        return self.thread.submit(super().load, key).result()

    def _write(self, key: str, content: bytes) -> None:
        self.thread.submit(super()._write, key, content)


@contextmanager
def writing_meanwhile(cache: Cache) -> Iterator[Cache]:
    """The cache, its entries written by a thread while the block goes on: a body's takes a quarter of a second. At the
    end of the block all are written."""
    with ThreadPoolExecutor(1) as thread:
        yield _WritingMeanwhile(cache.directory, cache.limit, thread=thread)


def _mark_as_used(path: Path) -> None:
    # The time of change, since many file systems do not keep that of access.
    try:
        os.utime(path)
    except OSError:
        # A cache that belongs to somebody else, or has just lost the entry.
        LOGGER.debug("cache: the time of use of %s could not be written", path)


def _file_content(key: str, arrays: dict[str, np.ndarray]) -> bytes:
    """The HDF5 file as bytes: made in memory, since HDF5 does not come back cleanly from a full disk."""
    import h5py

    content = io.BytesIO()
    with h5py.File(content, "w") as file:
        for name, values in arrays.items():
            file[name] = values
        file.attrs.update({"format": FORMAT, "key": key})
    return content.getvalue()


def _remove(path: Path) -> None:
    try:
        path.unlink(missing_ok=True)
    except OSError as error:
        LOGGER.warning("cache: %s could not be removed: %s", path, error)
