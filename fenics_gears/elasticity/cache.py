"""Results kept on disk under the hash of all that they depend on."""

from __future__ import annotations

import hashlib
import io
import json
import logging
import os
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fenics_gears.sealed import seal, unsealed

LOGGER = logging.getLogger(__name__)
DIRECTORY_VARIABLE = "FENICS_GEARS_CACHE"
FORMAT = "fenics_gears cache 2"


def content_key(inputs: dict) -> str:
    """Hash of inputs made of numbers, strings, lists and dicts; equal inputs have equal keys on every machine."""
    text = json.dumps(inputs, sort_keys=True, separators=(",", ":"), allow_nan=False)
    return hashlib.sha256(text.encode()).hexdigest()


def user_cache() -> Cache:
    """The cache in the directory named by FENICS_GEARS_CACHE, else in the user's cache directory."""
    directory = os.environ.get(DIRECTORY_VARIABLE)
    if not directory:
        from platformdirs import user_cache_dir

        directory = user_cache_dir("fenics_gears")
    return Cache(Path(directory))


@dataclass(frozen=True)
class Cache:
    """Named arrays by key, one HDF5 file each. It never raises: what cannot be read or kept is computed again."""

    directory: Path

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
            with h5py.File(unsealed(path), "r") as file:
                if tuple(file.attrs.get(name) for name in ("format", "key")) != (FORMAT, key):
                    raise ValueError("it was stored under another name, or by another version")
                return {name: np.asarray(file[name]) for name in file}
        except (OSError, ValueError) as error:
            LOGGER.warning("cache entry %s is not usable and is computed again: %s", path, error)
            return None

    def store(self, key: str, arrays: dict[str, np.ndarray]) -> None:
        """Keep arrays under a key; the file appears under its name only when it is complete."""
        aside = None
        try:
            content = _file_content(key, arrays)
            Path(self.directory).mkdir(parents=True, exist_ok=True)
            # A name of its own for each writer, so that two runs cannot write into one file.
            with tempfile.NamedTemporaryFile(
                prefix=f"{key}.", suffix=".part", dir=self.directory, delete=False
            ) as file:
                aside = Path(file.name)
                file.write(content)
                file.write(seal(content))
                file.flush()
                os.fsync(file.fileno())
            os.replace(aside, self.path(key))
        except OSError as error:
            LOGGER.warning("cache: nothing is kept in %s: %s", self.directory, error)
            if aside is not None:
                _remove(aside)
        except BaseException:
            # Ctrl-C between the two names.
            if aside is not None:
                _remove(aside)
            raise


def _file_content(key: str, arrays: dict[str, np.ndarray]) -> bytes:
    """The HDF5 file as bytes: made in memory, since HDF5 itself does not come back cleanly from a full disk."""
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
