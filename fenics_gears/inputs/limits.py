"""Limits of a number of a result, as a user writes them: ``{ at_most = "20 um" }``, and ``at_least`` likewise."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from .units import QuantityError, quantity

ENDS = ("at_most", "at_least")


@dataclass(frozen=True)
class Limit:
    """An end of the range of a number: which of `ENDS`, as it is written, and its value in `unit`."""

    end: str
    written: str
    value: float
    unit: str


def limits_of(table: Any, *units: str) -> list[Limit] | None:
    """The limits of a table, each in that of the units which it fits; None where it is no table of limits in these.

    >>> limits_of({"at_most": "0.02 mm"}, "rad", "um")
    [Limit(end='at_most', written='0.02 mm', value=20.0, unit='um')]
    >>> limits_of({"at_least": "97 %"}, "1")[0].value
    0.97
    """
    if not isinstance(table, Mapping) or not table or set(table) - set(ENDS):
        return None
    found = [_limit(end, written, units) for end, written in table.items()]
    return None if None in found else found


def what_is_allowed(*units: str) -> str:
    """In words, how a limit of a number in these units is written."""
    example = "1.2" if units == ("1",) else f'"20 {units[-1]}"'
    return f"is no limit of a number in {units[0]}. Allowed: {{ at_most = {example} }}, and at_least likewise."


def _limit(end: str, written: Any, units: tuple[str, ...]) -> Limit | None:
    if units == ("1",) and isinstance(written, int | float) and not isinstance(written, bool):
        return Limit(end, f"{float(written):g}", float(written), "1") if math.isfinite(written) else None
    try:
        value, kind = quantity(str(written))
    except QuantityError:
        return None
    for unit in units:
        size, own = (1.0, "a percentage") if unit == "1" else quantity(f"1 {unit}")
        if own == kind and math.isfinite(value):
            return Limit(end, str(written), value / size, unit)
    return None
