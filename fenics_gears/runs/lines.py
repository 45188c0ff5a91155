"""The runs of an optimisation on disk: a line of JSON for each, in a file of its own for each process, so that a kill
loses no finished run.

A line is written at once when its run has ended. One that a kill or a full disk cut short is none: it is not read, and
the next one begins below it.
"""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from fenics_gears.errors import ComputationError
from fenics_gears.numbers_version import NUMBERS_VERSION
from fenics_gears.system.job import communicator

FOLDER, ENDING = "runs", ".jsonl"


def append(directory: Path, line: Mapping[str, Any]) -> None:
    """Add a line to this process's file. Raises ComputationError where it cannot be written."""
    world = communicator()
    file = directory / f"{0 if world is None else world.rank}{ENDING}"
    try:
        with open(file, "ab+", buffering=0) as out:
            torn = out.seek(0, os.SEEK_END) and (out.seek(-1, os.SEEK_END), out.read(1))[1] != b"\n"
            out.write(
                (b"\n" if torn else b"")
                + json.dumps({"numbers_version": NUMBERS_VERSION, **line}, ensure_ascii=False).encode()
                + b"\n"
            )
    except OSError as error:
        raise ComputationError(f"{file}: a run could not be kept: {error.strerror or error}") from error


def kept(directory: Path) -> tuple[dict[str, dict[str, Any]], int]:
    """All whole lines by their `key`, and how many more there are of versions of the program with other numbers."""
    found, others = {}, 0
    for file in sorted(directory.glob(f"*{ENDING}")):
        for text in file.read_bytes().split(b"\n"):
            try:
                line = json.loads(text)
                if line.get("numbers_version") == NUMBERS_VERSION:
                    found[line["key"]] = line
                else:
                    others += 1
            except (ValueError, KeyError, TypeError, AttributeError):
                continue
    return found, others
