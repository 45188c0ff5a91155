"""Deviations of a gear's teeth from tables (CSV), as a measuring machine or a spreadsheet writes them. Not an effect by
itself."""

import csv
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import isfinite
from pathlib import Path

from fenics_gears.geometry.flank_errors import MeasuredCurve, MeasuredCurves
from fenics_gears.inputs import units
from fenics_gears.inputs.problem import did_you_mean, meant
from fenics_gears.inputs.written import as_written
from fenics_gears.system import user_file

TOOTH = "tooth"
DEVIATION = "deviation"
LENGTH = "a length"
ANGLE = "an angle"
# Where a point of a measured curve lies.
ALONG_PROFILE = {"roll_length": LENGTH, "roll_angle": ANGLE, "diameter": LENGTH}
ALONG_FACE = {"face_position": LENGTH}
FEWEST_POINTS = 3
_UNITS = {LENGTH: "um", ANGLE: "deg"}
_HEADING = re.compile(r"\s*([^\[\]()]*?)\s*(?:[\[(]\s*(.*?)\s*[\])])?\s*")
_LARGEST = 100.0


class FileProblem(ValueError):
    """What is wrong with a table: where, what, and what is allowed, in sentences that follow its field."""


@dataclass(frozen=True)
class _Row:
    """A line of a table: its place in the file, the tooth, and the other columns' numbers (mm or rad)."""

    place: str
    tooth: int
    values: tuple[float, ...]


def deviations_in(path: Path, names: Sequence[str]) -> dict[str, tuple[float, ...]]:
    """Each column's deviations, mm, in the order of the teeth, which are numbered from 1; by the column's name, one of
    `names`. Raises FileProblem.

    The first line names the columns: `tooth`, and deviations with their unit in brackets, or with a unit in every cell;
    they are parted by commas, semicolons or tabs. Empty lines and those that begin with # are passed over.
    """
    columns, rows = _table(path, dict.fromkeys(names, LENGTH), "tooth, pitch (um), profile_slope (um)")
    by_tooth: dict[int, tuple[float, ...]] = {}
    for row in rows:
        if row.tooth in by_tooth:
            raise FileProblem(f"{row.place}: has tooth {row.tooth} again. Allowed: each tooth once.")
        by_tooth[row.tooth] = tuple(_deviation(row.place, name, value) for name, value in zip(columns, row.values))
    missing = sorted(set(range(1, len(by_tooth) + 1)) - set(by_tooth))
    if missing:
        raise FileProblem(
            f"{path}: has {len(by_tooth)} teeth, but none of number {missing[0]}. Allowed: each tooth once, counted"
            " from 1."
        )
    return dict(zip(columns, zip(*(by_tooth[tooth] for tooth in sorted(by_tooth)))))


def curves_in(path: Path, along: Mapping[str, str]) -> MeasuredCurves:
    """Measured curves: a line for each point, in any order, with `tooth`, `deviation` and where the point lies, one of
    `along` (name to kind of quantity). Raises FileProblem."""
    example = f"tooth, {next(iter(along))} (mm), deviation (um)"
    columns, rows = _table(path, {**along, DEVIATION: LENGTH}, example)
    places = [name for name in columns if name in along]
    if len(columns) != 2 or len(places) != 1:
        lacking = "more than one such column" if places else "no column that says where a point lies"
        lacking = lacking if DEVIATION in columns else f"no column {DEVIATION}"
        raise FileProblem(
            f"{path}: has {lacking}. Allowed: a first line such as `{example}`, with one of {', '.join(along)}."
        )
    place = columns.index(places[0])
    height = columns.index(DEVIATION)
    points: dict[int, dict[float, float]] = {}
    for row in rows:
        own = points.setdefault(row.tooth, {})
        if row.values[place] in own:
            raise FileProblem(
                f"{row.place}: has a second point of tooth {row.tooth} at the same {places[0]}. Allowed: each place"
                " once for a tooth."
            )
        own[row.values[place]] = _deviation(row.place, DEVIATION, row.values[height])
    for tooth, own in points.items():
        if len(own) < FEWEST_POINTS:
            raise FileProblem(f"{path}: has {len(own)} points of tooth {tooth}. Allowed: at least {FEWEST_POINTS}.")
    return MeasuredCurves(
        places[0], tuple(MeasuredCurve(tooth, *zip(*sorted(points[tooth].items()))) for tooth in sorted(points))
    )


def _table(path: Path, kinds: Mapping[str, str], example: str) -> tuple[list[str], list[_Row]]:
    """Names of the columns but `tooth`, and all rows; `kinds`: what each column may be and the kind of its quantity."""
    lines = _lines(path)
    if len(lines) < 2:
        raise FileProblem(
            f"{path}: has no teeth. Allowed: a first line such as `{example}` and a line for each"
            f" {'tooth' if DEVIATION not in kinds else 'point'}."
        )
    number, heading = lines[0]
    separator = next((each for each in ";\t" if each in heading), ",")
    columns = _columns(f"{path}:{number}", _cells(f"{path}:{number}", heading, separator), kinds, example)
    measured = [name for name in columns if name != TOOTH]
    rows = []
    for number, line in lines[1:]:
        place = f"{path}:{number}"
        cells = _cells(place, line, separator)
        if len(cells) != len(columns):
            hint = " The decimal sign is a point." if separator == "," and re.search(r"\d,\d", line) else ""
            raise FileProblem(
                f"{place}: has {len(cells)} columns, the first line {len(columns)}.{hint} Allowed: as many."
            )
        given = dict(zip(columns, cells))
        values = tuple(_number(place, name, columns[name], given[name], kinds[name]) for name in measured)
        rows.append(_Row(place, _tooth(place, given[TOOTH]), values))
    return measured, rows


def _lines(path: Path) -> list[tuple[int, str]]:
    try:
        text = user_file.text_of(path, user_file.LARGEST_TABLE)
    except user_file.Missing as problem:
        raise FileProblem(f"{path}: {problem}. It is looked for from the scene file's folder on.") from None
    except user_file.Unreadable as problem:
        raise FileProblem(f"{path}: {problem}. Allowed: a table of text (CSV), not a workbook.") from None
    return [
        (number, line)
        for number, line in enumerate(text.splitlines(), 1)
        if line.strip() and not line.lstrip().startswith("#")
    ]


def _cells(place: str, line: str, separator: str) -> list[str]:
    try:
        return next(csv.reader([line], delimiter=separator, skipinitialspace=True))
    except csv.Error as error:
        allowed = "Allowed: cells parted by commas, semicolons or tabs."
        raise FileProblem(f"{place}: is no line of a table: {error}. {allowed}") from None


def _columns(place: str, headings: Sequence[str], kinds: Mapping[str, str], example: str) -> dict[str, str]:
    """Name and unit of every column; no unit where the cells have their own."""
    columns: dict[str, str] = {}
    known = (TOOTH, *kinds)
    for heading in headings:
        match = _HEADING.fullmatch(heading)
        name, unit = (match[1], match[2] or "") if match else (heading.strip(), "")
        if name not in known:
            synonym = meant(("flank_errors", "pinion"), name, tuple(kinds))
            hint = f' Did you mean "{synonym}"?' if synonym else did_you_mean(name, known)
            raise FileProblem(
                f"{place}: has the column {as_written(name)}, which is none of a gear's deviations.{hint} Allowed:"
                f" {', '.join(known)}."
            )
        if name in columns:
            raise FileProblem(f"{place}: has the column {name} twice. Allowed: each once.")
        if unit and _kind(f"1 {unit}") != kinds.get(name):
            wanted = kinds[name] if name in kinds else "a count, which has none"
            raise FileProblem(
                f'{place}: has the column {name} in "{unit}", which is no unit of'
                f" {wanted.removeprefix('a ').removeprefix('an ')}. Allowed: such as {name} ({_UNITS.get(wanted, '')})."
            )
        columns[name] = unit
    if TOOTH not in columns or len(columns) < 2:
        lacking = "no column tooth" if TOOTH not in columns else "no deviations"
        raise FileProblem(f"{place}: has {lacking}. Allowed: a first line such as `{example}`.")
    return columns


def _tooth(place: str, cell: str) -> int:
    text = cell.strip()
    if not (text.isascii() and text.isdigit()) or not 0 < int(text[:6]) <= 1000:
        raise FileProblem(f"{place}: has the tooth {as_written(text)}. Allowed: whole numbers from 1 on, as they mesh.")
    return int(text)


def _number(place: str, name: str, unit: str, cell: str, wanted: str) -> float:
    text = cell.strip()
    try:
        number, kind = units.quantity(f"{text} {unit}" if unit else text)
    except units.QuantityError as error:
        raise FileProblem(f"{place}: {name} = {as_written(text)} {error} Allowed: a number, such as 3.5.") from None
    if kind != wanted:
        raise FileProblem(
            f"{place}: {name} = {as_written(text)} is {kind}, not {wanted}. Allowed: a unit in the first line, such as"
            f" {name} ({_UNITS[wanted]}), or in each cell."
        )
    if not isfinite(number):
        raise FileProblem(f"{place}: {name} = {as_written(text)} is no number. Allowed: a number, such as 3.5.")
    return number


def _deviation(place: str, name: str, value: float) -> float:
    if abs(value) > _LARGEST:
        raise FileProblem(
            f"{place}: {name} = {value:g} mm is no deviation. Allowed: from -{_LARGEST:g} to {_LARGEST:g} mm."
        )
    return value


def _kind(text: str) -> str:
    try:
        return units.quantity(text)[1]
    except units.QuantityError:
        return ""
