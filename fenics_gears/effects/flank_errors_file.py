"""Deviations of a gear's teeth from a table (CSV), as a measuring machine or a spreadsheet writes it. Not an effect by itself."""

from __future__ import annotations

import csv
import re
from collections.abc import Sequence
from math import isfinite
from pathlib import Path

from fenics_gears.inputs import units
from fenics_gears.inputs.names import did_you_mean
from fenics_gears.inputs.synonyms import meant
from fenics_gears.inputs.written import as_written

TOOTH = "tooth"
EXAMPLE = "tooth, pitch (um), profile_slope (um)"
_HEADING = re.compile(r"\s*([^\[\]()]*?)\s*(?:[\[(]\s*(.*?)\s*[\])])?\s*")
_LARGEST = 100.0


class FileProblem(ValueError):
    """What is wrong with a table: where, what, and what is allowed, in sentences that follow the field that names the file."""


def deviations_in(path: Path, names: Sequence[str]) -> dict[str, tuple[float, ...]]:
    """Each column's deviations, mm, in the order of the teeth, which are numbered from 1; by the column's name, one of `names`.

    The first line names the columns: `tooth`, and deviations with their unit in brackets, or with a unit in every cell. Columns are parted by
    commas, semicolons or tabs; empty lines and those that begin with # are passed over. Raises FileProblem.
    """
    lines = _lines(path)
    if len(lines) < 2:
        raise FileProblem(f"{path}: has no teeth. Allowed: a first line such as `{EXAMPLE}` and a line for each tooth.")
    number, heading = lines[0]
    separator = next((each for each in ";\t" if each in heading), ",")
    columns = _columns(f"{path}:{number}", next(csv.reader([heading], delimiter=separator)), names)
    found: dict[int, list[float]] = {}
    for number, line in lines[1:]:
        place, cells = f"{path}:{number}", next(csv.reader([line], delimiter=separator, skipinitialspace=True))
        if len(cells) != len(columns):
            hint = " The decimal sign is a point." if separator == "," and re.search(r"\d,\d", line) else ""
            raise FileProblem(f"{place}: has {len(cells)} columns, the first line {len(columns)}.{hint} Allowed: as many.")
        tooth, values = 0, []
        for (name, unit), cell in zip(columns, cells):
            if name == TOOTH:
                tooth = _tooth(place, cell, found)
            else:
                values.append(_deviation(place, name, unit, cell))
        found[tooth] = values
    missing = sorted(set(range(1, len(found) + 1)) - set(found))
    if missing:
        raise FileProblem(f"{path}: has {len(found)} teeth, but none of number {missing[0]}. Allowed: each tooth once, counted from 1.")
    rows = [found[tooth] for tooth in sorted(found)]
    return dict(zip((name for name, _ in columns if name != TOOTH), zip(*rows)))


def _lines(path: Path) -> list[tuple[int, str]]:
    """Numbered lines that say something."""
    try:
        text = path.read_text(encoding="utf-8-sig")
    except FileNotFoundError:
        raise FileProblem(f"{path}: there is no such file. It is looked for from the scene file's folder on.") from None
    except UnicodeDecodeError:
        raise FileProblem(f"{path}: is not a text in UTF-8. Allowed: a table of text (CSV), not a workbook.") from None
    except (OSError, ValueError) as error:
        raise FileProblem(f"{path}: cannot be read: {getattr(error, 'strerror', None) or error}.") from None
    return [(number, line) for number, line in enumerate(text.splitlines(), 1) if line.strip() and not line.lstrip().startswith("#")]


def _columns(place: str, headings: Sequence[str], names: Sequence[str]) -> list[tuple[str, str]]:
    """Name and unit of every column; no unit where the cells have their own."""
    columns = []
    for heading in headings:
        match = _HEADING.fullmatch(heading)
        name, unit = (match[1], match[2] or "") if match else (heading.strip(), "")
        known = (TOOTH, *names)
        if name not in known:
            synonym = meant(("flank_errors", "pinion"), name, names)
            hint = f' Did you mean "{synonym}"?' if synonym else did_you_mean(name, known)
            raise FileProblem(f"{place}: has the column {as_written(name)}, which is none of a gear's deviations.{hint} Allowed: {', '.join(known)}.")
        if name in (each for each, _ in columns):
            raise FileProblem(f"{place}: has the column {name} twice. Allowed: each once.")
        if unit and _kind(f"1 {unit}") != "a length":
            raise FileProblem(f'{place}: has the column {name} in "{unit}", which is no unit of length. Allowed: such as {name} (um).')
        columns.append((name, unit))
    given = [name for name, _ in columns]
    if TOOTH not in given or len(given) < 2:
        lacking = "no column tooth" if TOOTH not in given else "no deviations"
        raise FileProblem(f"{place}: has {lacking}. Allowed: a first line such as `{EXAMPLE}`.")
    return columns


def _tooth(place: str, cell: str, found: dict[int, list[float]]) -> int:
    text = cell.strip()
    if not (text.isascii() and text.isdigit()) or not 0 < int(text[:6]) <= 1000:
        raise FileProblem(f"{place}: has the tooth {as_written(text)}. Allowed: a whole number from 1 on, in the order in which teeth mesh.")
    if int(text) in found:
        raise FileProblem(f"{place}: has tooth {text} again. Allowed: each tooth once.")
    return int(text)


def _deviation(place: str, name: str, unit: str, cell: str) -> float:
    """A deviation in mm."""
    text = cell.strip()
    try:
        number, kind = units.quantity(f"{text} {unit}" if unit else text)
    except units.QuantityError as error:
        raise FileProblem(f"{place}: {name} = {as_written(text)} {error} Allowed: a number, such as 3.5.") from None
    if kind != "a length":
        message = f"is {kind}, not a length. Allowed: a unit in the first line, such as {name} (um), and bare numbers below it; or a unit in each cell."
        raise FileProblem(f"{place}: {name} = {as_written(text)} {message}")
    if not isfinite(number) or abs(number) > _LARGEST:
        raise FileProblem(f"{place}: {name} = {as_written(text)} is no deviation of a tooth. Allowed: from -{_LARGEST:g} mm to {_LARGEST:g} mm.")
    return number


def _kind(text: str) -> str:
    try:
        return units.quantity(text)[1]
    except units.QuantityError:
        return ""
