"""The kinds of fields that a section has (``inputs.section``).

Each function declares a field of a frozen dataclass: range, unit, and meaning in one sentence. ``default``, and
``otherwise`` in words, say what holds where a scene leaves it out; a field with neither is required. ``marks``: further
fields of ``Allowed``.
"""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import field
from typing import Any

from . import units
from .allowed import (
    LONGEST_FILE_NAME,
    Allowed,
    AllowedChoice,
    AllowedEither,
    AllowedFile,
    AllowedList,
    AllowedNumber,
    AllowedSwitch,
    AllowedText,
)


def quantity(
    limits: str, example: str, *, meaning: str, otherwise: str = "", default: str = "", below: str = "", **marks: bool
) -> Any:
    """A quantity; its limits, both included, are written with units ("0 mm to 1 m"), and so is a default."""
    kind, lowest, highest = _limits(limits)
    allowed = AllowedNumber(
        description=f'{kind} from {limits}, with its unit, such as "{example}"',
        meaning=meaning,
        otherwise=otherwise or default,
        kind=kind,
        unit=units.unit_of(example),
        lowest=lowest,
        highest=highest,
        below=below,
        **marks,
    )
    return declared(allowed, units.quantity(default)[0] if default else None)


def number(
    example: float,
    *,
    meaning: str,
    above: float | None = None,
    lowest: float | None = None,
    below: float | None = None,
    highest: float | None = None,
    too_low: str = "",
    otherwise: str = "",
) -> Any:
    """A bare number; ``above`` and ``below`` are excluded, ``lowest`` and ``highest`` included."""
    least = f"above {above:g} and" if lowest is None else f"from {lowest:g}"
    most = f"below {below:g}" if highest is None else f"up to {highest:g}"
    allowed = AllowedNumber(
        description=f"a number {least} {most}, without unit, such as {example:g}",
        meaning=meaning,
        otherwise=otherwise,
        lowest=above if lowest is None else lowest,
        highest=below if highest is None else highest,
        above_lowest=lowest is None,
        below_highest=highest is None,
        below=too_low,
    )
    return declared(allowed)


def quantities(
    limits: str, *examples: str, meaning: str, otherwise: str, count: int | None = None, **marks: bool
) -> Any:
    """An optional list of quantities; each entry has limits as a quantity has.

    ``examples``: of two entries, or one for both; ``count``: of the entries, where it is fixed.
    """
    kind, low, high = _limits(limits)
    many, sizes = (f"{count} quantities", {"shortest": count, "longest": count}) if count else ("quantities", {})
    listed = f'["{examples[0]}", "{examples[-1]}"]'
    description = f"a list of {many}, each {kind} from {limits}, with its unit, such as {listed}"
    allowed = AllowedList(
        description=description, meaning=meaning, otherwise=otherwise, kind=kind, unit=units.unit_of(examples[0]),
        lowest=low, highest=high, **sizes, **marks,
    )  # fmt: skip
    return declared(allowed)


def numbers(lowest: float, highest: float, example: float, *, meaning: str, otherwise: str) -> Any:
    """A list of bare numbers, optional; bounds of each entry, both included."""
    limits = f"each from {lowest:g} to {highest:g}, without unit"
    description = f"a list of numbers, {limits}, such as [{example:g}, {example:g}]"
    bounds = {"lowest": lowest, "highest": highest}
    return declared(AllowedList(description=description, meaning=meaning, otherwise=otherwise, **bounds))


def either(*ranges: tuple[str, str], words: tuple[str, ...], meaning: str, otherwise: str) -> Any:
    """A quantity of one of several kinds, each given by its limits and an example, or a word; optional."""
    described = []
    bounds = {}
    usual = {}
    for limits, example in ranges:
        kind, *bounds_of_kind = _limits(limits)
        described.append(f'{kind} from {limits}, such as "{example}"')
        bounds[kind] = bounds_of_kind
        usual[kind] = units.unit_of(example)
    first = next(iter(bounds))
    description = ", or ".join(described) + _or(words)
    allowed = AllowedEither(
        description=description, meaning=meaning, otherwise=otherwise, kind=first, unit=usual[first],
        ranges=bounds, units=usual, words=words,
    )  # fmt: skip
    return declared(allowed)


def whole_number(
    lowest: int,
    highest: int,
    example: int,
    *,
    meaning: str,
    otherwise: str = "",
    default: int | None = None,
    words: Mapping[str, Any] | None = None,
    negative_means: str = "",
    **marks: bool,
) -> Any:
    """A bare whole number, bounds included; ``negative_means``: what one with a minus sign is, whose size has the same
    bounds."""
    words = words or {}
    signed = f", negative for {negative_means}" if negative_means else ""
    allowed = AllowedNumber(
        description=f"a whole number from {lowest} to {highest}, without unit, such as {example}{signed}{_or(words)}",
        meaning=meaning,
        otherwise=otherwise or ("" if default is None else str(default)),
        lowest=lowest,
        highest=highest,
        words=words,
        either_sign=bool(negative_means),
        whole=True,
        **marks,
    )
    return declared(allowed, default)


def choice(*names: str, meaning: str, otherwise: str = "", default: str | None = None) -> Any:
    """One of a few names, optional."""
    listed = ", ".join(f'"{name}"' for name in names)
    description = f"{'one of' if len(names) > 1 else 'only'} {listed}"
    otherwise = otherwise or f"`{default}`"
    return declared(AllowedChoice(description=description, meaning=meaning, otherwise=otherwise, names=names), default)


def text(longest: int, *, meaning: str, otherwise: str) -> Any:
    """A text, optional."""
    description = f"a text of at most {longest} characters"
    return declared(AllowedText(description=description, meaning=meaning, otherwise=otherwise, longest=longest))


def file_name(
    ending: str, example: str, *, meaning: str, otherwise: str, made: Callable[[str], Any] = str, **marks: bool
) -> Any:
    """The name of a file that ends in ``ending``, optional."""
    limits = f"that ends in {ending}, of at most {LONGEST_FILE_NAME} characters"
    description = f'the name of a file {limits}, such as "{example}"'
    allowed = AllowedFile(
        description=description, meaning=meaning, otherwise=otherwise, ending=ending, made=made, **marks
    )
    return declared(allowed)


def switch(*, meaning: str) -> Any:
    """True or false; false unless given."""
    return declared(AllowedSwitch(description="true or false", meaning=meaning, otherwise="false"), False)


def declared(allowed: Allowed, default: Any = None) -> Any:
    """A dataclass's field that allows this; required unless it says what is taken otherwise."""
    metadata = {"allowed": allowed}
    return field(default=default, metadata=metadata) if allowed.otherwise else field(metadata=metadata)


def _limits(limits: str) -> tuple[str, float, float]:
    """Kind, lowest and highest of "0 mm to 1 m"."""
    (lowest, kind), (highest, _) = (units.quantity(each) for each in limits.split(" to "))
    return kind, lowest, highest


def _or(words: Iterable[str]) -> str:
    return "".join(f', or "{word}"' for word in words)
