"""The directory a run writes to: every file is written aside and then renamed, so that a final name never holds half a file."""

from __future__ import annotations

import contextlib
import os
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

from fenics_gears.errors import ComputationError, SceneError


def check_writable(directory: Path) -> None:
    """Refuse before the computation a directory in which no result could be written; creates nothing.

    Raises SceneError.
    """
    existing = next(parent for parent in (directory.absolute(), *directory.absolute().parents) if parent.exists())
    if not existing.is_dir():
        raise SceneError(f"{existing} is a file; the result needs a directory. Choose another one with --output DIR.")
    if not os.access(existing, os.W_OK | os.X_OK):
        raise SceneError(f"{existing} cannot be written to. Choose another directory with --output DIR.")


@contextlib.contextmanager
def written_aside(directory: Path, written: list[Path]) -> Iterator[Path]:
    """A directory to write files into; at the end they move to ``directory``, and their final names are added to ``written``.

    Files that exist under these names are replaced. What was written before an exception is not moved.
    Raises ComputationError where the disk is full or the directory cannot be written.
    """
    try:
        directory.mkdir(parents=True, exist_ok=True)
        # Beside the final names, because a rename is atomic only within a file system.
        with tempfile.TemporaryDirectory(prefix=".unfinished-", dir=directory) as aside:
            yield Path(aside)
            for file in sorted(Path(aside).iterdir()):
                os.replace(file, directory / file.name)
                written.append(directory / file.name)
    except OSError as error:
        raise ComputationError(f"{directory}: the result could not be written: {error.strerror or error}") from error


def write_whole(file: Path, write: Callable[[Path], object]) -> Path:
    """Write a file, and what belongs beside it, by `write(path)`: its name holds the whole file or none. Raises as `written_aside` does."""
    with written_aside(file.parent, []) as aside:
        write(aside / file.name)
    return file
