"""Values of REXS attributes with their units, as numbers and as a scene writes them."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

from fenics_gears.scene import units
from fenics_gears.scene.rexs.model import Attribute, Component

# REXS's own spellings, as scenes write them. A frequency of REXS counts turns: where a speed is asked for, and only there, "1 / min" is one.
SPELLINGS = {"none": "", "°": "deg", "mum": "um", "mus": "us", "kg / dm^3": "g / cm^3", "%": "%"}
TURNS = {"1 / min": "rpm", "1 / s": "rev / s", "Hz": "rev / s"}
SPEED = "rpm"
_WHOLE, _NUMBER = re.compile(r"[+-]?\d{1,15}(\.0*)?"), re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")


class ValueProblem(ValueError):
    """A value that cannot be used, in whole sentences that name component and attribute."""


@dataclass(frozen=True)
class Value:
    """A number in N, mm, s, rad; how a scene writes it (TOML); where it is from; whether the file does not say it."""

    number: float
    written: str
    origin: str
    assumed: bool = False


def place(component: Component, name: str) -> str:
    """How a message begins: the component and the attribute."""
    return f"{component}: {name}"


def quantity_of(component: Component, name: str, unit: str) -> Value:
    """The value of an attribute that has a quantity of the kind of ``unit``. Raises ValueProblem."""
    attribute = _scalar(component, name)
    said = f"{place(component, name)} = {attribute.text} {attribute.unit}".rstrip()
    spelt = _scene_unit(attribute.unit, unit)
    if not spelt:
        raise ValueProblem(f"{said} has no unit. Allowed: a unit of the kind of {unit}.")
    try:
        number, kind = units.quantity(f"{attribute.text} {spelt}")
    except units.QuantityError as error:
        raise ValueProblem(f"{said} {error} Allowed: a number with a unit of the kind of {unit}.") from None
    wanted = units.quantity(f"1 {unit}")[1]
    if kind != wanted:
        raise ValueProblem(f"{said} is {kind}, not {wanted}. Allowed: a unit of the kind of {unit}.")
    if not math.isfinite(number):
        raise ValueProblem(f"{said} is not a finite number.")
    return Value(number, f'"{attribute.text} {spelt}"', _origin(component, name))


def number_of(component: Component, name: str) -> Value:
    """The value of an attribute without unit, which may be given in per cent. Raises ValueProblem."""
    attribute = _scalar(component, name)
    said = f"{place(component, name)} = {attribute.text} {attribute.unit}".rstrip()
    unit = SPELLINGS.get(attribute.unit, attribute.unit)
    if unit not in ("", "%"):
        raise ValueProblem(f'{said} has the unit "{attribute.unit}". Allowed: "none" or "%".')
    if not _NUMBER.fullmatch(attribute.text) or not math.isfinite(float(attribute.text)):
        raise ValueProblem(f"{said} is not a finite number.")
    number = float(attribute.text) * (0.01 if unit == "%" else 1.0)
    return Value(number, bare(number), _origin(component, name))


def whole_number_of(component: Component, name: str) -> Value:
    """The value of an attribute that counts. Raises ValueProblem."""
    attribute = _scalar(component, name)
    if unit := SPELLINGS.get(attribute.unit, attribute.unit):
        raise ValueProblem(f"{place(component, name)} = {attribute.text} {unit} is not a whole number without unit.")
    if not _WHOLE.fullmatch(attribute.text):
        raise ValueProblem(f"{place(component, name)} = {attribute.text} is not a whole number.")
    number = int(attribute.text.partition(".")[0])
    return Value(number, str(number), _origin(component, name))


def word_of(component: Component, name: str) -> str:
    """The text of an attribute that is a choice or true or false. Raises ValueProblem."""
    return _scalar(component, name).text


def unquoted(value: Value) -> str:
    """A value as messages write it."""
    return value.written.strip('"')


def bare(number: float) -> str:
    """A number as TOML writes it."""
    return repr(float(number))


def computed(number: float, factor: float, unit: str, origin: str, *, assumed: bool = False) -> Value:
    """A value that follows from others; ``factor``: how many N, mm, s, rad the unit is."""
    return Value(number, f'"{number / factor:.12g} {unit}"', origin, assumed)


def _origin(component: Component, name: str) -> str:
    return f"{name} of component {component.identifier}"


def _scalar(component: Component, name: str) -> Attribute:
    attribute = component.attributes[name]
    if attribute.text is None:
        raise ValueProblem(f"{place(component, name)} is an array. Allowed: one value.")
    return attribute


def _scene_unit(written: str, wanted: str) -> str:
    if wanted == SPEED and written in TURNS:
        return TURNS[written]
    return SPELLINGS.get(written, written)
