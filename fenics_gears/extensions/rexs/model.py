"""A REXS file as components with attributes, relations between them, and load cases; values are texts as written."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import Annotated, Any

from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, ValidationError, model_validator

# As programs write them: "1.4", "1.40", "2.0.0", "v1.4", "1,4".
KNOWN_VERSION = re.compile(r"[vV]?\s*[12]([.,-]\d+)*")


class ModelError(ValueError):
    """A file that is no REXS model; the message completes "the file ..."."""


def readable(text: Any) -> Any:
    """A name of the file in one line of characters that can be printed."""
    if not isinstance(text, str):
        return text
    return " ".join("".join(each if each.isprintable() else " " for each in text).split())[:100]


Name = Annotated[str, BeforeValidator(readable)]
# What may be left out, or null.
OtherName = Annotated[str, BeforeValidator(lambda text: readable("" if text is None else text))]


class _Node(BaseModel):
    model_config = ConfigDict(frozen=True)


class Attribute(_Node):
    """A value and its unit as written (empty where there is none). ``value``: a text; of an array a list of texts, or
    code and text where it is coded; of a matrix a list of lists."""

    id: Name
    unit: OtherName = ""
    value: Any

    @model_validator(mode="before")
    @classmethod
    def _typed(cls, tree: Any) -> Any:
        """A value has the name of its type in a file."""
        if not isinstance(tree, Mapping):
            return tree
        value = next((value for key, value in tree.items() if key not in ("id", "unit")), None)
        value = ("false", "true")[value] if isinstance(value, bool) else readable(value)
        return {"id": tree.get("id"), "unit": tree.get("unit"), "value": value}


def _by_name(attributes: list[Attribute]) -> dict[str, Attribute]:
    """Attributes by their names, without those that are null or empty. Raises ValueError for two different values of
    one."""
    by_name: dict[str, Attribute] = {}
    for each in attributes:
        first = by_name.setdefault(each.id, each) if each.value not in (None, "") else each
        if first != each:
            raise ValueError(
                f"has {each.id} twice, with different values: {first.value} {first.unit}; {each.value} {each.unit}"
            )
    return by_name


Attributes = Annotated[list[Attribute], AfterValidator(_by_name)]


class Component(_Node):
    """A machine element or a part of one; attributes without a value are left out."""

    id: int
    type: Name
    name: OtherName = ""
    attributes: Attributes = {}

    def __str__(self) -> str:
        named = f" {self.name!r}" if self.name else ""
        return f"component {self.id} ({self.type}{named})"


def _by_number(components: list[Component]) -> dict[int, Component]:
    by_number: dict[int, Component] = {}
    for each in components:
        if (first := by_number.setdefault(each.id, each)) is not each:
            raise ValueError(f"has two components with the number {each.id}: {first}, {each}")
    return by_number


class _Reference(_Node):
    role: Name
    id: int


class Relation(_Node):
    """Components in their roles; ``order`` counts from 1 where a relation has one."""

    type: Name
    refs: list[_Reference]
    order: int | None = None

    @property
    def roles(self) -> dict[str, int]:
        """The number of each role's component."""
        return {each.role: each.id for each in self.refs}


class _Loaded(_Node):
    id: int
    attributes: Attributes = {}


class _LoadCase(_Node):
    id: Name
    components: list[_Loaded] = []


class _LoadSpectrum(_Node):
    load_cases: list[_LoadCase] = []


class RexsModel(_Node):
    """A whole file."""

    version: Name
    applicationId: OtherName = ""
    applicationVersion: OtherName = ""
    date: OtherName = ""
    components: Annotated[list[Component], AfterValidator(_by_number)] = {}
    relations: list[Relation] = []
    load_spectrum: _LoadSpectrum = _LoadSpectrum()

    @property
    def load_cases(self) -> dict[str, dict[int, Mapping[str, Attribute]]]:
        """By the case's name, what each says of components, by their number."""
        cases = self.load_spectrum.load_cases
        return {case.id: {each.id: each.attributes for each in case.components} for case in cases}

    def related(self, type: str, **known: Component) -> Iterator[Relation]:
        """Relations of a type in which the known components have these roles, in their order."""
        numbers = {role: component.id for role, component in known.items()}
        related = [each for each in self.relations if each.type == type and numbers.items() <= each.roles.items()]
        yield from sorted(related, key=lambda relation: relation.order or 0)

    def partners(self, type: str, wanted: str, **known: Component) -> list[Component]:
        """The components in the wanted role of these relations, each once."""
        numbers = dict.fromkeys(each.roles[wanted] for each in self.related(type, **known) if wanted in each.roles)
        return [self.components[number] for number in numbers]

    def under_load(self, case: str) -> RexsModel:
        """The model with what a load case says of its components put before what they say themselves."""
        said = self.load_cases[case]
        loaded = {
            number: component.model_copy(update={"attributes": {**component.attributes, **said.get(number, {})}})
            for number, component in self.components.items()
        }
        return self.model_copy(update={"components": loaded})


def checked_model(tree: Any) -> RexsModel:
    """The model of a file's tree, as JSON has it. Raises ModelError where it is none: of another shape, with numbers
    that are there twice or lead nowhere, or of a version that is not known."""
    try:
        model = RexsModel.model_validate(tree)
    except ValidationError as error:
        raise ModelError(_words(tree, error.errors()[0])) from None
    if not KNOWN_VERSION.fullmatch(model.version):
        raise ModelError(f'has the REXS version "{model.version}"; 1.0 to 2.0 are read')
    for relation in model.relations:
        for role, number in relation.roles.items():
            if number not in model.components:
                words = f'has a relation "{relation.type}" whose {role} is component {number}'
                raise ModelError(f"{words}, which is not there")
    return model


# What is wrong with a node of a file's tree, by pydantic's names of mistakes.
_WORDS = {
    "missing": "is missing",
    "int_parsing": "is not a whole number",
    "int_type": "is not a whole number",
    "list_type": "is not a list",
    "string_type": "is not a text or a number",
    "model_type": "is not an object",
    "model_attributes_type": "is not an object",
}


def _words(tree: Any, mistake: Mapping[str, Any]) -> str:
    """A mistake with its place (components by their own number) and its value where that is short."""
    place = ""
    for step in mistake["loc"]:
        if isinstance(step, str) and step not in tree:
            place += f" {step}"
            break
        tree = tree[step]
        number = tree.get("id") if isinstance(tree, Mapping) else None
        place += (
            f" {step}" if isinstance(step, str) else f" {number}," if isinstance(number, str) else f" ({step + 1}.),"
        )
    value = f' = "{readable(mistake["input"])}"' if isinstance(mistake["input"], str) else ""
    words = mistake["ctx"]["error"] if mistake["type"] == "value_error" else _WORDS.get(mistake["type"], mistake["msg"])
    return f"is no REXS:{place or ' the model'}{value} {words}"
