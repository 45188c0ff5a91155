"""A swept field and its values, given as a list or as a range."""

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from fenics_gears.inputs import units
from fenics_gears.inputs.problem import did_you_mean
from fenics_gears.inputs.written import as_written, toml_value

from .fields import ABSENT, PRESENT, Path, is_section

RANGE_KEYS = ("start", "stop", "count", "step", "spacing")
SPACINGS = ("linear", "logarithmic")
MOST_VALUES = 100_000
LONGEST_LABEL = 60
# The dimension of all random fields together.
SAMPLE = "sample"
# "50 .. 500 N m in 10", "... in 10, logarithmic", "50 .. 500 N m by 50 N m".
RANGE_IN_WORDS = re.compile(
    r"(?P<start>.+?)\s*\.\.\s*(?P<stop>.+?)"
    r"(?:\s+in\s+(?P<count>\d+)(?P<spacing>\s*,?\s*logarithmic)?|\s+by\s+(?P<step>.+?))?"
)


class AxisError(ValueError):
    """A mistake in a swept field's values; the message continues the sentence "the value ..."."""


@dataclass(frozen=True)
class Axis:
    """A swept field: its path in the scene and its values as TOML has them. `name`: of the coordinate; `unit`: of its
    numbers, the one that the first value is written in, empty for bare numbers or texts. `random`: whether its values
    are samples of a distribution."""

    path: Path
    values: tuple[Any, ...]
    name: str
    unit: str = ""
    random: bool = False

    @property
    def dotted(self) -> str:
        return ".".join(self.path)

    def coordinate(self) -> np.ndarray:
        """The values as numbers in ``unit``, an absent one as NaN; as texts where not all are numbers."""
        numbers = [number_in(value, self.unit) for value in self.values]
        if all(number is not None for number in numbers):
            return np.array(numbers)
        return np.array([label(value) for value in self.values], dtype=object)


def label(value: Any) -> str:
    """A swept value in words: "absent", "200 Hz", "coefficient = 0.1"."""
    if isinstance(value, Mapping):
        return ", ".join(f"{name} = {toml_value(inner)}" for name, inner in value.items())
    if isinstance(value, list) and len(listed := toml_value(value)) <= LONGEST_LABEL:
        return listed
    return value if isinstance(value, str) else as_written(value)


def unit_of(values: tuple[Any, ...]) -> str:
    """Of the first of some values that has one; of a list, that of its entries."""
    listed = (each for value in values for each in (value if isinstance(value, list) else (value,)))
    return next((units.unit_of(each) for each in listed if isinstance(each, str) and units.unit_of(each)), "")


def values_of(path: Path, written: Any) -> tuple[Any, ...]:
    """The values of a swept field, listed or from a range. Raises AxisError."""
    if isinstance(written, Mapping):
        values = _range(written)
    elif isinstance(written, list):
        values = tuple(written)
    else:
        raise AxisError(
            "is one value, which belongs in [set]. Allowed: a list of values, or a range such as"
            " { start = ..., stop = ..., count = 20 }."
        )
    if not values:
        raise AxisError("is an empty list. Allowed: at least one value.")
    if len(values) > MOST_VALUES:
        raise AxisError(f"has {len(values)} values. Allowed: up to {MOST_VALUES}.")
    for value in values:
        _check(path, value)
    return values


def values_in_words(written: str) -> tuple[str, ...]:
    """The values that a word of the command line stands for: "437 N m" for one, "50 .. 500 N m in 10" for a range.
    Raises AxisError.

    >>> values_in_words("100 .. 300 N m by 100 N m")
    ('100 N m', '200 N m', '300 N m')
    """
    if ".." not in written:
        return (written.strip(),)
    match = RANGE_IN_WORDS.fullmatch(written.strip())
    if match is None or not (match["count"] or match["step"]):
        raise AxisError(
            'is a range without the number of its values. Allowed: such as "50 .. 500 N m in 10", "50 .. 500 N m in 10,'
            ' logarithmic", "50 .. 500 N m by 50 N m".'
        )
    unit = units.unit_of(match["stop"])
    ends = {
        name: match[name] if units.unit_of(match[name]) else f"{match[name]} {unit}"
        for name in ("start", "stop", "step")
        if match[name]
    }
    counted = {"count": int(match["count"]), "spacing": SPACINGS[bool(match["spacing"])]} if match["count"] else {}
    return tuple(map(str, _range({**ends, **counted})))


def _check(path: Path, value: Any) -> None:
    if not is_section(path) or isinstance(value, Mapping) or value in (ABSENT, PRESENT):
        return
    hint = did_you_mean(value, (ABSENT, PRESENT)) if isinstance(value, str) else ""
    raise AxisError(
        f'holds {as_written(value)}, but [{".".join(path)}] is a section.{hint} Allowed: "{ABSENT}" (without the'
        f' section), "{PRESENT}" (as the scene has it), or a table of its fields, such as {{ ... = ... }}.'
    )


def number_in(value: Any, unit: str) -> float | None:
    """A value as a number of units, NaN for an absent one; None for what is no number."""
    if value == ABSENT:
        return math.nan
    try:
        if isinstance(value, str):
            return units.quantity(value)[0] / factor_of(unit)
        # A whole number may have more digits than a float can hold.
        return float(value) if isinstance(value, (int, float)) and not isinstance(value, bool) else None
    except (units.QuantityError, OverflowError):
        return None


def factor_of(unit: str) -> float:
    """What a number in this unit is multiplied by to be in N, mm, s and rad."""
    return units.quantity(f"1 {unit}")[0]


def _range(table: Mapping[str, Any]) -> tuple[Any, ...]:
    """The values of { start, stop, count } or { start, stop, step }."""
    for name in table:
        if name not in RANGE_KEYS:
            raise AxisError(
                f'has "{name}", which no range has.{did_you_mean(name, RANGE_KEYS)} Allowed: start, stop, and count or'
                " step; spacing."
            )
    for name in ("start", "stop"):
        if name not in table:
            raise AxisError(f"has no {name}. Allowed: start, stop, and count or step.")
    if ("count" in table) == ("step" in table):
        raise AxisError("needs one of count and step.")
    spacing = table.get("spacing", "linear")
    if spacing not in SPACINGS:
        hint = did_you_mean(spacing, SPACINGS) if isinstance(spacing, str) else ""
        raise AxisError(f'has the spacing {as_written(spacing)}.{hint} Allowed: "linear", "logarithmic".')
    (start, stop, *step), unit = ends({name: table[name] for name in ("start", "stop", "step") if name in table})
    if step:
        numbers = _stepped(start, stop, step[0], spacing)
    else:
        numbers = _counted(start, stop, table["count"], spacing)
    if unit:
        return tuple(f"{number:.12g} {unit}" for number in numbers)
    whole = isinstance(table["start"], int) and isinstance(table["stop"], int) and np.all(numbers == np.round(numbers))
    return tuple(int(number) if whole else float(f"{number:.15g}") for number in numbers)


def ends(given: Mapping[str, Any]) -> tuple[list[float], str]:
    """Quantities, such as start and stop, as numbers in the unit of the first one, and that unit. Raises AxisError."""
    if all(isinstance(value, (int, float)) and not isinstance(value, bool) for value in given.values()):
        unit = ""
        bare = [number_in(value, "") for value in given.values()]
        numbers = [math.inf if number is None else number for number in bare]
    else:
        for name, value in given.items():
            if not isinstance(value, str):
                wrong = f"has {name} = {as_written(value)} next to a text with a unit"
                raise AxisError(f"{wrong}. Allowed: all with units, or all bare numbers.")
        try:
            quantities = [units.quantity(value) for value in given.values()]
        except units.QuantityError as error:
            raise AxisError(f"has an end that {error}") from None
        kinds = dict.fromkeys(kind for _, kind in quantities)
        if len(kinds) > 1:
            raise AxisError(f"mixes {' and '.join(kinds)}.")
        unit = units.unit_of(next(iter(given.values())))
        numbers = [number / factor_of(unit) for number, _ in quantities]
    if not all(map(math.isfinite, numbers)):
        raise AxisError("has an end that is not a finite number.")
    return numbers, unit


def _counted(start: float, stop: float, count: Any, spacing: str) -> np.ndarray:
    if isinstance(count, bool) or not isinstance(count, int) or not 2 <= count <= MOST_VALUES:
        raise AxisError(f"has count = {as_written(count)}. Allowed: a whole number from 2 to {MOST_VALUES}.")
    if start == stop:
        raise AxisError("starts where it stops.")
    if spacing == "linear":
        return np.linspace(start, stop, count)
    if start <= 0 or stop <= 0:
        raise AxisError("is logarithmic; start and stop must be above zero.")
    return np.geomspace(start, stop, count)


def _stepped(start: float, stop: float, step: float, spacing: str) -> np.ndarray:
    if spacing != "linear":
        raise AxisError("is logarithmic with a step. Allowed: a count instead.")
    if step == 0 or (stop - start) / step <= 0:
        raise AxisError("has a step that does not lead from start to stop.")
    steps = (stop - start) / step
    if steps > MOST_VALUES:
        raise AxisError(f"has {steps:.3g} values. Allowed: up to {MOST_VALUES}.")
    # The stop is reached even if round-off puts it beyond the last step.
    return start + step * np.arange(math.floor(steps * (1 + 1e-12) + 1e-9) + 1)
