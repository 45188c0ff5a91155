"""The kinds of fields a scene has: quantities with units, bare numbers, choices; each knows what it allows.

Each function returns a pydantic field; its wording travels along as ``Allowed``, for the messages and the
documentation. ``meaning`` says what the field is; ``otherwise`` what is taken where a scene leaves it out, and thereby
that it may.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import isfinite
from typing import Any

from pydantic import BaseModel, ConfigDict, Field, ValidationInfo, field_validator
from pydantic_core import PydanticCustomError

from fenics_gears.inputs import units
from fenics_gears.inputs.names import did_you_mean
from fenics_gears.inputs.written import as_written


@dataclass(frozen=True)
class Allowed:
    """What a field allows, in words, and how its text becomes a number.

    ``kind`` is the kind of quantity ("a length"), None for a field without unit, and ``unit`` a usual one; ``words``
    are texts that stand for other values; ``below`` is a sentence added where a value is too small. ``meaning`` and
    ``otherwise`` are for the documentation:
    what the field is, and what is taken where it is left out.
    """

    description: str
    kind: str | None = None
    unit: str = ""
    words: dict[str, Any] = field(default_factory=dict)
    below: str = ""
    meaning: str = ""
    otherwise: str = ""

    def convert(self, value: Any) -> Any:
        """The number in N, mm, s, rad for a quantity's text; anything else as it is.

        Raises PydanticCustomError, whose type is "quantity", for a text that is not of this kind.
        """
        if isinstance(value, str) and value in self.words:
            return self.words[value]
        if self.kind is None:
            return value
        return self._number(value, self.kind)[0]

    def _number(self, value: Any, *kinds: str) -> tuple[float, str]:
        """The number and the kind of a quantity's text, one of some kinds."""
        if not isinstance(value, str):
            raise refused(self._without_unit(value))
        try:
            return units.of_kind(value, *kinds)
        except units.QuantityError as error:
            raise refused(str(error) + did_you_mean(value, self.words)) from None

    def _without_unit(self, value: Any) -> str:
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            return "is not a text with a number and its unit."
        written = f"{as_written(value)} {self.unit}"
        in_unit = f' In {self.unit} it is written "{written}".' if written[0] in "0123456789" else ""
        return f"is a number without its unit.{in_unit}"


def refused(reason: str) -> PydanticCustomError:
    """What a conversion raises; ``reason`` completes "the value ..." to whole sentences."""
    return PydanticCustomError("quantity", "{reason}", {"reason": reason})


def out_of_range(number: float, lowest: float, highest: float) -> str:
    """What is wrong with a number outside its bounds, both included; empty for one within."""
    if not isfinite(number):
        return "is not a finite number."
    if lowest <= number <= highest:
        return ""
    if number > highest:
        return "is too large."
    if lowest < 0 or number > 0:
        return "is too small."
    return "is negative." if number < 0 else "is zero."


def _bare(entry: Any) -> float:
    """A bare number of a list. Raises PydanticCustomError for anything else."""
    if isinstance(entry, bool) or not isinstance(entry, (int, float)):
        raise refused("is not a number.")
    try:
        return float(entry)
    except OverflowError:
        raise refused("is too large.") from None


@dataclass(frozen=True)
class AllowedList(Allowed):
    """A list of ``shortest`` to ``longest`` quantities of one kind, each within ``bounds`` (in N, mm, s, rad)."""

    bounds: tuple[float, float] = (0.0, 0.0)
    longest: int = 1000
    shortest: int = 1

    def convert(self, value: Any) -> tuple[float, ...]:
        """The numbers in N, mm, s, rad. Raises PydanticCustomError, which names the first entry that is wrong."""
        if not isinstance(value, list):
            raise refused("is not a list.")
        if not self.shortest <= len(value) <= self.longest:
            raise refused(
                "is empty." if not value else f"has {len(value)} {'entry' if len(value) == 1 else 'entries'}."
            )
        return tuple(self._entry(number, entry) for number, entry in enumerate(value, 1))

    def _entry(self, number: int, entry: Any) -> float:
        try:
            converted = super().convert(entry) if self.kind is not None else _bare(entry)
            reason = out_of_range(converted, *self.bounds)
        except PydanticCustomError as error:
            reason = error.context["reason"]
        if reason:
            raise refused(f"has the entry {as_written(entry) or 'of a section'} at place {number}, which {reason}")
        return converted


@dataclass(frozen=True)
class Measured:
    """A number in N, mm, s, rad with its kind ("a length"), of a field that takes several kinds."""

    number: float
    kind: str


@dataclass(frozen=True)
class AllowedEither(Allowed):
    """A quantity of one of several kinds; ``ranges``: bounds of each kind, both included, in N, mm, s, rad."""

    ranges: dict[str, tuple[float, float]] = field(default_factory=dict)

    def convert(self, value: Any) -> Any:
        """The number with its kind. Raises PydanticCustomError for a text of no such kind or out of its bounds."""
        if isinstance(value, str) and value in self.words:
            return self.words[value]
        number, kind = self._number(value, *self.ranges)
        reason = out_of_range(number, *self.ranges[kind])
        if reason:
            raise refused(reason)
        return Measured(number, kind)


# The longest path that Linux takes.
LONGEST_FILE_NAME = 4096


@dataclass(frozen=True)
class AllowedFile(Allowed):
    """The name of a file with a certain ``ending``, such as ".msh"."""

    ending: str = ""

    def convert(self, value: Any) -> str:
        """The name as it is. Raises PydanticCustomError for what cannot be one."""
        if not isinstance(value, str):
            raise refused("is not a text.")
        if not value.strip():
            raise refused("is empty.")
        if not value.endswith(self.ending) or value == self.ending:
            raise refused(f"is not the name of a file that ends in {self.ending}.")
        return value


class Section(BaseModel):
    """A section of the scene: unknown keys and values of a wrong type are refused."""

    # defer_build: sections are built once, with the scene that they are part of.
    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, allow_inf_nan=False, defer_build=True)

    @field_validator("*", mode="before")
    @classmethod
    def _to_program_units(cls, value: Any, info: ValidationInfo) -> Any:
        allowed = allowed_in(cls, info.field_name)
        return value if allowed is None else allowed.convert(value)


def allowed_in(section: type[BaseModel], name: str) -> Allowed | None:
    """What the field of that name allows; None for a section within a section."""
    extra = section.model_fields[name].json_schema_extra
    return extra["allowed"] if extra else None


def section_within(section: type[BaseModel], name: str) -> type[BaseModel] | None:
    """The schema of a section within a section; None where the name is a plain field."""
    annotation = section.model_fields[name].annotation
    kinds = (annotation, *getattr(annotation, "__args__", ()))
    return next((kind for kind in kinds if isinstance(kind, type) and issubclass(kind, BaseModel)), None)


def quantity(
    lowest: str,
    highest: str,
    example: str,
    *,
    meaning: str,
    otherwise: str = "",
    words: dict[str, Any] | None = None,
    below: str = "",
) -> Any:
    """A quantity with a unit; bounds, both included, are written with units too."""
    kind = units.quantity(example)[1]
    words = words or {}
    description = f'{kind} from {lowest} to {highest}, with its unit, such as "{example}"'
    description += "".join(f', or "{word}"' for word in words)
    allowed = Allowed(description, kind, units.unit_of(example), words, below, meaning, otherwise)
    return _field(allowed, ge=units.quantity(lowest)[0], le=units.quantity(highest)[0])


def number(
    example: float,
    *,
    meaning: str,
    above: float | None = None,
    lowest: float | None = None,
    below: float | None = None,
    highest: float | None = None,
    default: Any = ...,
    too_low: str = "",
    otherwise: str = "",
) -> Any:
    """A bare number; ``above`` and ``below`` are excluded, ``lowest`` and ``highest`` included."""
    least = f"above {above:g} and" if lowest is None else f"from {lowest:g}"
    most = f"below {below:g}" if highest is None else f"up to {highest:g}"
    allowed = Allowed(
        f"a number {least} {most}, without unit, such as {example:g}",
        below=too_low,
        meaning=meaning,
        otherwise=otherwise,
    )
    return Field(
        None if otherwise else default,
        gt=above,
        ge=lowest,
        lt=below,
        le=highest,
        json_schema_extra={"allowed": allowed},
    )


def quantities(
    lowest: str, highest: str, *examples: str, meaning: str, otherwise: str, count: int | None = None
) -> Any:
    """A list of quantities with units, optional; bounds of each entry, both included, are written with units too.

    ``examples``: of two entries, or one for both; ``count``: of the entries, where it is fixed.
    """
    (low, kind), high, first, second = units.quantity(lowest), units.quantity(highest)[0], examples[0], examples[-1]
    many, sizes = (f"{count} quantities", {"shortest": count, "longest": count}) if count else ("quantities", {})
    description = (
        f'a list of {many}, each {kind} from {lowest} to {highest}, with its unit, such as ["{first}", "{second}"]'
    )
    return _field(
        AllowedList(
            description, kind, units.unit_of(first), bounds=(low, high), meaning=meaning, otherwise=otherwise, **sizes
        )
    )


def numbers(lowest: float, highest: float, example: float, *, meaning: str, otherwise: str) -> Any:
    """A list of bare numbers, optional; bounds of each entry, both included."""
    description = (
        f"a list of numbers, each from {lowest:g} to {highest:g}, without unit, such as [{example:g}, {example:g}]"
    )
    return _field(AllowedList(description, bounds=(lowest, highest), meaning=meaning, otherwise=otherwise))


def either(*ranges: tuple[str, str, str], words: dict[str, Any], meaning: str, otherwise: str) -> Any:
    """A quantity of one of several kinds, each given as lowest, highest, example with units; optional. It becomes a
    ``Measured``."""
    described, bounds = [], {}
    for lowest, highest, example in ranges:
        (low, kind), high = units.quantity(lowest), units.quantity(highest)[0]
        described.append(f'{kind} from {lowest} to {highest}, such as "{example}"')
        bounds[kind] = low, high
    description = ", or ".join([*described, *(f'"{word}"' for word in words)])
    allowed = AllowedEither(
        description,
        next(iter(bounds)),
        units.unit_of(ranges[0][2]),
        words,
        meaning=meaning,
        otherwise=otherwise,
        ranges=bounds,
    )
    return _field(allowed)


def whole_number(
    lowest: int, highest: int, example: int, *, meaning: str, otherwise: str = "", words: dict[str, Any] | None = None
) -> Any:
    """A bare whole number, bounds included."""
    words = words or {}
    description = f"a whole number from {lowest} to {highest}, without unit, such as {example}"
    description += "".join(f', or "{word}"' for word in words)
    return _field(Allowed(description, words=words, meaning=meaning, otherwise=otherwise), ge=lowest, le=highest)


def choice(*names: str, meaning: str, otherwise: str) -> Any:
    """One of a few names, optional."""
    listed = ", ".join(f'"{name}"' for name in names)
    return _field(
        Allowed(f"one of {listed}" if len(names) > 1 else f"only {listed}", meaning=meaning, otherwise=otherwise)
    )


def text(longest: int, *, meaning: str, otherwise: str) -> Any:
    """A text, optional."""
    return _field(
        Allowed(f"a text of at most {longest} characters", meaning=meaning, otherwise=otherwise), max_length=longest
    )


def file_name(ending: str, example: str, *, meaning: str, otherwise: str) -> Any:
    """The name of a file that ends in ``ending``, optional."""
    description = (
        f'the name of a file that ends in {ending}, of at most {LONGEST_FILE_NAME} characters, such as "{example}"'
    )
    return _field(
        AllowedFile(description, meaning=meaning, otherwise=otherwise, ending=ending), max_length=LONGEST_FILE_NAME
    )


def switch(*, meaning: str) -> Any:
    """True or false; false unless given."""
    return Field(False, json_schema_extra={"allowed": Allowed("true or false", meaning=meaning, otherwise="false")})


def _field(allowed: Allowed, **bounds: Any) -> Any:
    return Field(None if allowed.otherwise else ..., json_schema_extra={"allowed": allowed}, **bounds)
