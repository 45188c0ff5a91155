"""Random values of a swept field, such as tolerances: a distribution, from which a study takes samples. The same seed
gives the same values, whatever else is swept."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from fenics_gears.inputs.allowed import AllowedList
from fenics_gears.inputs.problem import did_you_mean
from fenics_gears.inputs.written import as_written

from .axis import MOST_VALUES, AxisError, ends
from .fields import Path, allowed_at, is_section

# Of each distribution the quantities that say it.
DISTRIBUTIONS = {"normal": ("mean", "deviation"), "uniform": ("start", "stop")}
OTHERS = ("distribution", "count", "seed", "entries")
ALLOWED = (
    'Allowed: such as { distribution = "normal", mean = "0 um", deviation = "10 um", count = 1000, seed = 1 }, or'
    ' "uniform" with start and stop; entries = 3 of a field that is a list, [3, 22] of pitches of three gears'
)
MOST_ENTRIES = 1000
MOST_SEED = 2**63 - 1


def is_random(written: Any) -> bool:
    """Whether what is written below [sweep] is a distribution."""
    return isinstance(written, Mapping) and "distribution" in written


def sampled(path: Path, table: Mapping[str, Any]) -> tuple[Any, ...]:
    """So many values of a field from a distribution, as TOML has them; of a list each has all entries. From pitch
    errors the mean of each gear is taken off, so that they close. Raises AxisError.

    >>> sampled(("load", "wheel_torque"), {
    ...     "distribution": "uniform", "start": "1 N m", "stop": "2 N m", "count": 2, "seed": 1})
    ('1.8589061184 N m', '1.4276334012 N m')
    """
    kind = table["distribution"]
    if kind not in DISTRIBUTIONS:
        hint = did_you_mean(kind, tuple(DISTRIBUTIONS)) if isinstance(kind, str) else ""
        raise AxisError(f'has the distribution {as_written(kind)}.{hint} Allowed: "normal", "uniform".')
    named = DISTRIBUTIONS[kind]
    for name in table:
        if name not in (*named, *OTHERS):
            hint = did_you_mean(name, (*named, *OTHERS))
            raise AxisError(f'has "{name}", which a {kind} distribution has not.{hint} {ALLOWED}.')
    for name in named:
        if name not in table:
            raise AxisError(f"has no {name}. {ALLOWED}.")
    if is_section(path):
        raise AxisError(f"is a distribution of a section. {ALLOWED}, of one of its fields.")
    (first, second), unit = ends({name: table[name] for name in named})
    if kind == "normal" and second <= 0.0:
        raise AxisError(f"has the deviation {as_written(table['deviation'])}. Allowed: above zero.")
    if kind == "uniform" and first >= second:
        raise AxisError("has a start that is not below its stop.")
    count = _whole(table, "count", 2, MOST_VALUES)
    seed = _whole(table, "seed", 0, MOST_SEED)
    allowed = allowed_at(path)[0]
    listed = isinstance(allowed, AllowedList)
    if not listed and "entries" in table:
        raise AxisError("has entries, but the field is no list. Leave them out.")
    closed = isinstance(allowed, AllowedList) and allowed.closed
    shape = _entries(table, closed) if listed else (1,)
    # Fields of one seed are independent of each other.
    source = np.random.default_rng([seed, *".".join(path).encode()])
    draw = source.normal if kind == "normal" else source.uniform
    drawn = draw(first, second, (count, *shape))
    if closed:
        drawn -= drawn.mean(axis=-1, keepdims=True)
    values = [[_written(number, unit) for number in row] for row in drawn.reshape(count, -1).tolist()]
    return tuple(row if listed else row[0] for row in values)


def _entries(table: Mapping[str, Any], closed: bool) -> tuple[int, ...]:
    """How many entries a list has, of pitch errors perhaps those of several gears. Raises AxisError."""
    written = table.get("entries")
    if not (closed and isinstance(written, list) and len(written) == 2):
        return (_whole(table, "entries", 1, MOST_ENTRIES),)
    gears, teeth = (_whole({"entries": each}, "entries", 1, MOST_ENTRIES) for each in written)
    return gears, _whole({"entries": gears * teeth}, "entries", 1, MOST_ENTRIES) // gears


def _whole(table: Mapping[str, Any], name: str, lowest: int, highest: int) -> int:
    """A whole number of a distribution. Raises AxisError."""
    if name not in table:
        raise AxisError(f"has no {name}. {ALLOWED}.")
    value = table[name]
    if isinstance(value, bool) or not isinstance(value, int) or not lowest <= value <= highest:
        raise AxisError(f"has {name} = {as_written(value)}. Allowed: a whole number from {lowest} to {highest}.")
    return value


def _written(number: float, unit: str) -> str | float:
    return f"{number:.12g} {unit}" if unit else float(f"{number:.15g}")
