"""The index of a study's folder, `study.json`: of which scene and which numbers its results are, and which file holds
which case."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fenics_gears.numbers_version import NUMBERS_VERSION
from fenics_gears.system.console import printable
from fenics_gears.system.output import write_whole

if TYPE_CHECKING:
    from .study import Study

INDEX = "study.json"


def directory_of(path: Path, output: Path | None) -> Path:
    """Where the study of a file is written: `output`, or `results/<name of the study file>`."""
    return output or Path("results") / printable(path.stem)


def seems_complete(path: Path, directory: Path) -> bool:
    """Whether the study of a file had all its cases when it last ran, and the file has not changed since. Only names
    and times of files are read, so this is a guess that has to be checked."""
    try:
        changed = path.stat().st_mtime > (directory / INDEX).stat().st_mtime
        listed = _read(directory)
        there = {file.name for file in (directory / "cases").iterdir()}
    except OSError:
        return False
    names = listed.get("cases", {})
    same = not changed and listed.get("numbers_version") == NUMBERS_VERSION
    return same and bool(names) and all(f"{name}.nc" in there for name in names)


def changed_since(study: Study, directory: Path) -> str:
    """A sentence where the study was last run here by a version of the program with other numbers, or with another base
    scene; else empty. Writes the index with the present ones."""
    listed = _read(directory)
    before = listed.get("base_scene")
    index = {
        "title": study.title,
        "base_scene": study.base_key,
        "numbers_version": NUMBERS_VERSION,
        "cases": {case.name: case.values for case in study.cases},
    }
    text = json.dumps(index, indent=1, ensure_ascii=False)
    write_whole(directory / INDEX, lambda aside: aside.write_text(text, encoding="utf-8"))
    if before is None or before == study.base_key:
        return ""
    if listed.get("numbers_version") != NUMBERS_VERSION:
        return "Results that are here of a version of the program with other numbers are not used."
    return "The base scene has changed since the last time."


def _read(directory: Path) -> dict[str, Any]:
    """What the index says; nothing where there is none."""
    try:
        index = json.loads((directory / INDEX).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    return index if isinstance(index, dict) else {}
