"""What a REXS file holds: components with attributes, relations between components, load cases. Texts as written; units not yet converted."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace


@dataclass(frozen=True)
class Attribute:
    """A value as written, with its unit as written (empty where there is none); ``text`` is None for arrays and matrices."""

    identifier: str
    unit: str
    text: str | None


@dataclass(frozen=True)
class Component:
    """A machine element or a part of one; attributes without a value are left out."""

    identifier: int
    type: str
    name: str = ""
    attributes: Mapping[str, Attribute] = field(default_factory=dict)

    def __str__(self) -> str:
        named = f" {self.name!r}" if self.name else ""
        return f"component {self.identifier} ({self.type}{named})"


@dataclass(frozen=True)
class Relation:
    """Components in their roles; ``order`` counts from 1 where a relation has one."""

    type: str
    roles: Mapping[str, int]
    order: int | None = None


@dataclass(frozen=True)
class Model:
    """A whole file. ``load_cases``: by the case's name, what each says of components, by their number."""

    version: str
    application: str
    date: str
    components: Mapping[int, Component]
    relations: tuple[Relation, ...]
    load_cases: Mapping[str, Mapping[int, Mapping[str, Attribute]]] = field(default_factory=dict)

    def related(self, type: str, **known: Component) -> Iterator[Relation]:
        """Relations of a type in which the known components have these roles, in their order."""
        numbers = {role: component.identifier for role, component in known.items()}
        found = [each for each in self.relations if each.type == type and numbers.items() <= each.roles.items()]
        yield from sorted(found, key=lambda relation: relation.order or 0)

    def partners(self, type: str, wanted: str, **known: Component) -> list[Component]:
        """The components in the wanted role of these relations, each once."""
        numbers = dict.fromkeys(each.roles[wanted] for each in self.related(type, **known) if wanted in each.roles)
        return [self.components[number] for number in numbers]

    def under_load(self, case: str) -> Model:
        """The model with what a load case says of its components put before what they say themselves."""
        said = self.load_cases[case]
        loaded = {
            number: replace(component, attributes={**component.attributes, **said.get(number, {})})
            for number, component in self.components.items()
        }
        return replace(self, components=loaded)


class ModelError(ValueError):
    """A file that is no REXS model; the message completes "the file ..."."""


def attributes_by_name(attributes: Iterable[Attribute], owner: str) -> dict[str, Attribute]:
    """The attributes by their names. Raises ModelError where one is there twice with different values."""
    found: dict[str, Attribute] = {}
    for attribute in attributes:
        first = found.setdefault(attribute.identifier, attribute)
        if first != attribute:
            raise ModelError(f"has {attribute.identifier} twice in {owner}, with different values: {first.text} {first.unit}; {attribute.text} {attribute.unit}")
    return found


def checked_model(version, application, date, components: Iterable[Component], relations: Iterable[Relation], load_cases) -> Model:
    """The model of what was read. Raises ModelError where numbers are there twice or lead nowhere, or the version is not known."""
    if version.partition(".")[0] not in ("1", "2"):
        raise ModelError(f'has the REXS version "{version}"; 1.0 to 2.0 are read')
    by_number: dict[int, Component] = {}
    for component in components:
        if component.identifier in by_number:
            raise ModelError(f"has two components with the number {component.identifier}: {by_number[component.identifier]}, {component}")
        by_number[component.identifier] = component
    relations = tuple(relations)
    for relation in relations:
        for role, number in relation.roles.items():
            if number not in by_number:
                raise ModelError(f'has a relation "{relation.type}" whose {role} is component {number}, which is not there')
    return Model(version, application, date, by_number, relations, load_cases)


def readable(text: str | None) -> str:
    """A name of the file in one line of characters that can be printed, so that it can stand in a message or a comment."""
    return " ".join("".join(each if each.isprintable() else " " for each in text or "").split())[:100]
