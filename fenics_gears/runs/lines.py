"""Runs as lines of JSON, in a file for each process, so that a kill loses no finished run.

A line is written as soon as its run has ended. One that was cut short is not read, and the next one begins below it.
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fenics_gears.errors import ComputationError, GearsError
from fenics_gears.numbers_version import NUMBERS_VERSION
from fenics_gears.results.dataset import RunResult
from fenics_gears.system.job import communicator

from .run import Run
from .runs import Failure, failure_of

if TYPE_CHECKING:
    from fenics_gears.results.together import NumbersOfRun

ENDING = ".jsonl"
Line = dict[str, Any]


@dataclass(frozen=True)
class FolderOfLines:
    """A folder of lines, each made by `line_of` of a run and its result, with at least the `numbers` that are `asked`
    for. `failure` says why there are none, also where the result has no meaning."""

    directory: Path
    line_of: Callable[[Run, RunResult | NumbersOfRun], Line]
    asked: tuple[str, ...]

    def known(self, runs: Iterable[Run]) -> dict[str, Line | Failure]:
        """All whole lines with what is asked for by their keys, whichever runs are."""
        asked = {*self.asked}
        lines = kept(self.directory)[0].items()
        return {key: _known(line) for key, line in lines if "failure" in line or asked <= line["numbers"].keys()}

    def keep(self, run: Run, result: RunResult | NumbersOfRun) -> Line | Failure:
        line = {"key": run.key, **self.line_of(run, result)}
        append(self.directory, line)
        return _known(line)

    def seconds(self, known: Line) -> list[float]:
        return known["seconds"]

    def keep_failure(self, run: Run, error: Exception) -> Failure:
        """Write why the run failed. What is no error of this program is not kept, so that it is tried again."""
        if not isinstance(error, GearsError) or isinstance(error, NotKept):
            raise error
        append(self.directory, {"key": run.key, "failure": str(error)})
        return failure_of(error)


def _known(line: Line) -> Line | Failure:
    return Failure(line["failure"]) if "failure" in line else line


class NotKept(ComputationError):
    """A line that could not be written."""


def append(directory: Path, line: Mapping[str, Any]) -> None:
    """Add a line to this process's file. Raises NotKept where it cannot be written."""
    world = communicator()
    file = directory / f"{0 if world is None else world.rank}{ENDING}"
    try:
        with open(file, "ab+", buffering=0) as out:
            torn = out.seek(0, os.SEEK_END) and (out.seek(-1, os.SEEK_END), out.read(1))[1] != b"\n"
            text = json.dumps({"numbers_version": NUMBERS_VERSION, **line}, ensure_ascii=False)
            out.write((b"\n" if torn else b"") + text.encode() + b"\n")
    except OSError as error:
        raise NotKept(f"{file}: a run could not be kept: {error.strerror or error}") from error


def kept(directory: Path) -> tuple[dict[str, Line], int]:
    """All whole lines by their `key`, and how many more there are of versions of the program with other numbers."""
    lines: dict[str, Line] = {}
    others = 0
    for file in sorted(directory.glob(f"*{ENDING}")):
        for text in file.read_bytes().split(b"\n"):
            try:
                line = json.loads(text)
                if line.get("numbers_version") == NUMBERS_VERSION:
                    numbers = lines.get(line["key"], {}).get("numbers", {}) | line.get("numbers", {})
                    lines[line["key"]] = line | ({"numbers": numbers} if numbers else {})
                else:
                    others += 1
            except (ValueError, KeyError, TypeError, AttributeError):
                continue
    return lines, others
