"""Looking values up in a model, collecting what is wrong on the way, so that all mistakes are told at once."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from math import isclose
from typing import TypeVar

from fenics_gears.scene.rexs.model import Component
from fenics_gears.scene.rexs.values import Value, ValueProblem, number_of, place, quantity_of, unquoted

Found = TypeVar("Found")
# Values that a program rounded before it wrote them in two places differ by less, relatively.
SAME = 1e-6
Place = tuple[Component, str]
_OF_COMPONENTS = re.compile(r"(\w+) of components? (\d+(?:, \d+)*)")


class Reading:
    """What was found wrong with a model (``problems``), and what a scene made of it leaves out (``left_out``), in sentences."""

    def __init__(self) -> None:
        self.problems: list[str] = []
        self.left_out: list[str] = []

    def attempt(self, look_up: Callable[..., Found], *arguments) -> Found | None:
        """What a look-up finds; None where it raises a ValueProblem, which is kept, or where one of its arguments was not found."""
        if any(argument is None for argument in arguments):
            return None
        try:
            return look_up(*arguments)
        except ValueProblem as problem:
            if str(problem) not in self.problems:
                self.problems.append(str(problem))
            return None


def given(places: Iterable[Place]) -> list[Place]:
    """Those of the places, a component and an attribute's name each, that have a value."""
    return [(component, name) for component, name in places if name in component.attributes]


def first_quantity(places: Iterable[Place], unit: str) -> Value | None:
    """The quantity at the first of the places that has one; None where none has. Raises ValueProblem."""
    return next((quantity_of(component, name, unit) for component, name in given(places)), None)


def first_number(places: Iterable[Place]) -> Value | None:
    """The number at the first of the places that has one; None where none has. Raises ValueProblem."""
    return next((number_of(component, name) for component, name in given(places)), None)


def needed(value: Value | None, places: Iterable[Place], remedy: str = "") -> Value:
    """The value; raises ValueProblem, naming where it was looked for, for None."""
    if value is None:
        (component, name), *others = places
        besides = together(f"{other} of component {each.identifier}" for each, other in others)
        raise ValueProblem(f"{place(component, name)} is missing{' (and ' + besides + ')' if besides else ''}.{remedy}")
    return value


def agreed(values: Iterable[Value | None], what: str) -> Value | None:
    """The one value that several places give; None where none does. Raises ValueProblem where they contradict each other."""
    there = [value for value in values if value is not None]
    for other in there[1:]:
        if not isclose(other.number, there[0].number, rel_tol=SAME, abs_tol=1e-12):
            raise ValueProblem(
                f"{what}: {there[0].origin} is {unquoted(there[0])}, but {other.origin} is {unquoted(other)}. "
                "Allowed: the same value."
            )
    if not there:
        return None
    return Value(there[0].number, there[0].written, together(value.origin for value in there), any(value.assumed for value in there))


def together(origins: Iterable[str]) -> str:
    """Origins in one text; the same attribute of several components is named once."""
    origins = list(dict.fromkeys(origins))
    found = [_OF_COMPONENTS.fullmatch(origin) for origin in origins]
    if len(origins) > 1 and None not in found and len({each[1] for each in found}) == 1:
        return f"{found[0][1]} of components {', '.join(each[2] for each in found)}"
    return " and ".join(origins)


def positive(value: Value, component: Component, name: str) -> Value:
    """The value; raises ValueProblem unless it is above zero."""
    if not value.number > 0.0:
        raise ValueProblem(f"{place(component, name)} = {unquoted(value)} is not positive.")
    return value
