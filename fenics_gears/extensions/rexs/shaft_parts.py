"""Shafts of a REXS file: their sections, and where along them a gear or a bearing stands."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .model import Component
from .values import Value, computed, lengths_of, together, value_of

SECTION = "shaft_section"
POSITION = "support_vector"


@dataclass(frozen=True)
class SectionOfShaft:
    """A section from `start`: its length, the diameters of its ends and those of its bore there."""

    component: Component
    start: Value
    length: Value
    diameters: tuple[Value, Value]
    bores: tuple[Value, Value]

    @property
    def end(self) -> float:
        return self.start.number + self.length.number


def sections_of(components: Sequence[Component]) -> list[SectionOfShaft]:
    """Of the components on a shaft those that are its sections, from its beginning on; empty where one of them is not
    completely given. Raises ValueProblem."""
    found = []
    for each in components:
        if each.type == SECTION:
            section = _section(each)
            if section is None:
                return []
            found.append(section)
    return sorted(found, key=lambda section: section.start.number)


def _section(component: Component) -> SectionOfShaft | None:
    names = ("u_coordinate_on_shaft", "length", "outer_diameter_begin")
    if not all(name in component.attributes for name in names):
        return None
    start, length, diameter = (value_of(component, name, "mm") for name in names)
    if not (length.number > 0.0 and diameter.number > 0.0):
        return None

    def either(name: str, otherwise: Value) -> Value:
        return value_of(component, name, "mm") if name in component.attributes else otherwise

    bore = either("inner_diameter_begin", Value(0.0, '"0 mm"', f"no inner_diameter_begin of component {component.id}"))
    ends = either("outer_diameter_end", diameter), either("inner_diameter_end", bore)
    return SectionOfShaft(component, start, length, (diameter, ends[0]), (bore, ends[1]))


def located(component: Component) -> tuple[np.ndarray, str] | None:
    """Where a component is, mm, and from which part that counts; None where the file does not say it. Raises
    ValueProblem."""
    if POSITION not in component.attributes:
        return None
    vector = np.array(lengths_of(component, POSITION))
    counted = component.attributes.get("reference_component_for_position")
    return (vector, "" if counted is None else str(counted.value)) if vector.shape == (3,) else None


def place_along(part: Component, shaft: Component) -> Value | None:
    """Where the middle of a part is on its shaft: by the positions of both, which are of middles, or as the part says;
    None where the file does not say it. Raises ValueProblem."""
    found = located(part), located(shaft)
    if found[0] is not None and found[1] is not None and found[0][1] == found[1][1]:
        along = float(np.linalg.norm(found[0][0] - found[1][0]))
        origin = together(f"{POSITION} of component {each.id}" for each in (part, shaft))
        return computed(along, 1.0, "mm", origin)
    for name in ("u_coordinate_on_shaft", "u_coordinate_on_shaft_inner_side"):
        if name in part.attributes:
            return value_of(part, name, "mm")
    return None


def diameter_at(part: Component, shaft: Component, on_shaft: Sequence[Component]) -> Value | None:
    """The outer diameter of a shaft where the middle of a part is; None where the file does not say it. Raises
    ValueProblem."""
    at = place_along(part, shaft)
    for section in sections_of(on_shaft) if at is not None else ():
        if section.start.number <= at.number <= section.end:
            first, last = section.diameters
            share = (at.number - section.start.number) / section.length.number
            if first.number == last.number:
                return first
            return computed(first.number + share * (last.number - first.number), 1.0, "mm", first.origin)
    return None
