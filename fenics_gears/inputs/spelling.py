"""From values in N, mm, s, rad back to a section of a scene file that reads as the same values, bit for bit: the way
back of ``inputs.fields``."""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import MISSING, Field, fields
from typing import Any

from pydantic import BaseModel

from fenics_gears.inputs import units
from fenics_gears.inputs.fields import Allowed, AllowedList, allowed_in, section_within

# A number is written with the fewest of so many digits that read as the same number.
DIGITS = (3, 6, 9, 12, 15, 16, 17)


def section_tree(values: Any, section: type[BaseModel], leaving: Collection[str] = ()) -> dict[str, Any]:
    """A section whose fields have the names of the dataclass's, as ``effects.effect.same_names`` reads it.

    What is None, or what the dataclass has unless told, is left out, and so are the fields ``leaving``.
    """
    found: dict[str, Any] = {}
    for each in fields(values):
        value, schema = getattr(values, each.name), section.model_fields.get(each.name)
        if (
            schema is None
            or each.name in leaving
            or value is None
            or (value == _default(each) and not schema.is_required())
        ):
            continue
        inner = section_within(section, each.name)
        found[each.name] = (
            section_tree(value, inner) if inner is not None else spelled(value, allowed_in(section, each.name))
        )
    return found


def field_of(section: type[BaseModel], name: str, value: Any) -> Any:
    """A value of a section's field as a scene file has it."""
    return spelled(value, allowed_in(section, name))


def spelled(value: Any, allowed: Allowed) -> Any:
    """A value as a scene file has it: a quantity in the field's usual unit where that gives it bit for bit, else in N,
    mm, s, rad."""
    if isinstance(allowed, AllowedList):
        return [
            float(each) if allowed.kind is None else quantity_text(each, allowed.kind, allowed.unit) for each in value
        ]
    return value if allowed.kind is None else quantity_text(value, allowed.kind, allowed.unit)


def quantity_text(value: float, kind: str, usual: str) -> str:
    """A quantity of a kind with its unit, the usual one if that will do.

    >>> quantity_text(437000.0, "a torque", "N m")
    '437 N m'
    >>> quantity_text(0.031, "a length", "um"), quantity_text(0.031, "a length", "mm")
    ('31 um', '0.031 mm')
    """
    own = units.own_unit(kind)
    for unit in (usual, own):
        quotient = float(value) / units.quantity(f"1 {unit}")[0]
        # The quotient and then the product with the factor are rounded: a number beside it may be the one.
        for number in (quotient, math.nextafter(quotient, math.inf), math.nextafter(quotient, -math.inf)):
            for digits in DIGITS:
                text = f"{number:.{digits}g} {unit}"
                if units.quantity(text)[0] == value:
                    return text
    return f"{quotient!r} {own}"


def _default(each: Field) -> Any:
    return each.default if each.default_factory is MISSING else each.default_factory()
