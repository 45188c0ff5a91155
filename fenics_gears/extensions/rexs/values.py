"""Values of REXS attributes with their units, as numbers and as a scene writes them."""

import base64
import math
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from math import isclose

import numpy as np

from fenics_gears import units

from .model import Attribute, Component

# REXS's own spellings, as scenes write them. A frequency of REXS counts turns: where a speed is asked for, and only
# there, "1 / min" is one.
SPELLINGS = {"none": "", "1": "", "-": "", "°": "deg", "mum": "um", "mus": "us"}
# By their letters without blanks.
TURNS = {"1/min": "rpm", "min^-1": "rpm", "1/s": "rev / s", "s^-1": "rev / s", "Hz": "rev / s"}
# Kinds of values that are no quantity: a number, a whole number, and a length that a scene has in modules.
NUMBER = ""
COUNT = "whole number"
MODULES = "in modules"
SPEED = "rpm"
# Arrays in binary form: little-endian, in base64, from REXS 1.3 on.
CODES = {"float32": "<f4", "float64": "<f8", "int32": "<i4"}
# Values that a program rounded before it wrote them in two places differ by less, relatively.
SAME = 1e-6
# Components that are named one by one.
MOST_NAMED = 10
_WHOLE = re.compile(r"[+-]?\d{1,15}(\.0*)?")
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")
_OF_COMPONENTS = re.compile(r"(\w+) of components? (\d+(?:, \d+)*)")


class ValueProblem(ValueError):
    """A value that cannot be used, in whole sentences that name component and attribute."""


@dataclass(frozen=True)
class Value:
    """A number in N, mm, s, rad; how a scene writes it (TOML); where it is from; whether the file does not say it."""

    number: float
    written: str
    origin: str
    assumed: bool = False

    @property
    def words(self) -> str:
        return self.written.strip('"')


def place(component: Component, name: str) -> str:
    """How a message begins: the component and the attribute."""
    return f"{component}: {name}"


def value_of(component: Component, name: str, unit: str, module: Value | None = None) -> Value:
    """The value of an attribute: a quantity of the kind of ``unit``, or one of the kinds above; ``module``: for lengths
    in modules. Raises ValueProblem."""
    if unit == MODULES:
        length = value_of(component, name, "mm")
        return bare(length.number / module.number, f"{length.origin}, over the module")
    text = word_of(component, name)
    written = component.attributes[name].unit
    spelt = TURNS.get(written.replace(" ", ""), written) if unit == SPEED else written
    spelt = SPELLINGS.get(spelt, spelt)
    said = f"{place(component, name)} = {text} {written}".rstrip()
    origin = f"{name} of component {component.id}"
    if unit == COUNT:
        whole = text.partition(".")[0]
        if spelt:
            raise ValueProblem(f"{said} is not a whole number without unit.")
        if not _WHOLE.fullmatch(text):
            raise ValueProblem(f"{place(component, name)} = {text} is not a whole number.")
        return Value(int(whole), whole, origin)
    if unit == NUMBER:
        if spelt not in ("", "%"):
            raise ValueProblem(f'{said} has the unit "{written}". Allowed: "none" or "%".')
        if not _NUMBER.fullmatch(text) or not math.isfinite(float(text)):
            raise ValueProblem(f"{said} is not a finite number.")
        return bare(float(text) * (0.01 if spelt else 1.0), origin)
    return Value(_quantity(said, text, spelt, unit), f'"{text} {spelt}"', origin)


def _quantity(said: str, text: str, spelt: str, unit: str) -> float:
    if not spelt:
        raise ValueProblem(f"{said} has no unit. Allowed: a unit of the kind of {unit}.")
    try:
        number, _ = units.of_kind(f"{text} {spelt}", units.quantity(f"1 {unit}")[1])
    except units.QuantityError as error:
        raise ValueProblem(f"{said} {error} Allowed: a number with a unit of the kind of {unit}.") from None
    if not math.isfinite(number):
        raise ValueProblem(f"{said} is not a finite number.")
    return number


def word_of(component: Component, name: str) -> str:
    """The text of an attribute that has one value, of an array with one entry too. Raises ValueProblem."""
    entries = _entries(component, name)
    if len(entries) != 1:
        raise ValueProblem(f"{place(component, name)} is an array of {len(entries)} values. Allowed: one value.")
    return entries[0]


def numbers_of(component: Component, name: str) -> list[float]:
    """The numbers of an array. Raises ValueProblem."""
    try:
        return [float(each) for each in _entries(component, name)]
    except ValueError as error:
        raise ValueProblem(f"{place(component, name)} is no array of numbers: {error}.") from None


def lengths_of(component: Component, name: str) -> list[float]:
    """The lengths (mm) of an array. Raises ValueProblem."""
    unit = SPELLINGS.get(component.attributes[name].unit, component.attributes[name].unit)
    said = place(component, name)
    return [_quantity(f"{said} = {each}", repr(each), unit, "mm") for each in numbers_of(component, name)]


def in_words(component: Component, name: str) -> str:
    """An attribute's value, or how many an array has and from where to where they go, with its unit."""
    entries = _entries(component, name)
    unit = component.attributes[name].unit
    try:
        numbers = [float(each) for each in entries]
        text = entries[0] if len(entries) == 1 else f"{len(entries)} values from {min(numbers):g} to {max(numbers):g}"
    except ValueError:
        text = ", ".join(entries)[:100]
    return f"{text} {SPELLINGS.get(unit, unit)}".rstrip()


def _entries(component: Component, name: str) -> list[str]:
    value = component.attributes[name].value
    if isinstance(value, dict):
        return _decoded(component, component.attributes[name])
    if not isinstance(value, list):
        return [str(value)]
    if any(isinstance(each, (list, dict)) for each in value):
        raise ValueProblem(f"{place(component, name)} is a matrix. Allowed: one value.")
    return [str(each) for each in value]


def _decoded(component: Component, attribute: Attribute) -> list[str]:
    code, text = (str(attribute.value.get(name, "")) for name in ("code", "value"))
    if code not in CODES:
        what = f'{place(component, attribute.id)} is an array with the code "{code}"'
        raise ValueProblem(f"{what}. Allowed: {', '.join(CODES)}.")
    try:
        # Programs also leave out the padding at the end.
        numbers = np.frombuffer(base64.b64decode(text + "=" * (-len(text) % 4), validate=True), CODES[code])
    except ValueError as error:
        raise ValueProblem(f"{place(component, attribute.id)} is no array of {code} in base64: {error}.") from None
    return [str(number) for number in numbers]


def bare(number: float, origin: str, *, assumed: bool = False) -> Value:
    return Value(number, repr(float(number)), origin, assumed)


def computed(number: float, factor: float, unit: str, origin: str, *, assumed: bool = False) -> Value:
    """A value that follows from others; ``factor``: how many N, mm, s, rad the unit is."""
    return Value(number, f'"{number / factor:.12g} {unit}"', origin, assumed)


def agreed(values: Iterable[Value | None], what: str) -> Value | None:
    """The one value that several places give; None where none does. Raises ValueProblem where they contradict each
    other."""
    there = [value for value in values if value is not None]
    for other in there[1:]:
        if not isclose(other.number, there[0].number, rel_tol=SAME, abs_tol=1e-12):
            raise ValueProblem(
                f"{what}: {there[0].origin} is {there[0].words}, but {other.origin} is {other.words}. "
                "Allowed: the same value."
            )
    if not there:
        return None
    origin = together(value.origin for value in there)
    assumed = any(value.assumed for value in there)
    return replace(there[0], origin=origin, assumed=assumed)


def numbered(numbers: Sequence[int]) -> str:
    """Components in words, many of them by the first and the last."""
    if len(numbers) > MOST_NAMED:
        return f"{len(numbers)} components, {numbers[0]} to {numbers[-1]}"
    return f"component{'s' if len(numbers) > 1 else ''} {', '.join(map(str, numbers))}"


def together(origins: Iterable[str]) -> str:
    """Origins in one text; the same attribute of several components is named once."""
    origins = list(dict.fromkeys(origins))
    matches = [_OF_COMPONENTS.fullmatch(origin) for origin in origins]
    if len(origins) > 1 and None not in matches and len({each[1] for each in matches}) == 1:
        numbers = dict.fromkeys(number for each in matches for number in each[2].split(", "))
        return f"{matches[0][1]} of components {', '.join(numbers)}"
    return " and ".join(origins)
