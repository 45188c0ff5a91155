"""What a field of a section allows (``inputs.fields``), and how its text in a scene file becomes a value and back."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from math import inf, isfinite
from typing import Any

from . import units
from .problem import did_you_mean
from .written import as_written

# The longest path that Linux takes.
LONGEST_FILE_NAME = 4096
Matrix = tuple[tuple[float, ...], ...]
# Parts of the largest entry that a matrix may depart by from a symmetric, positive one.
ROUND_OFF = 1e-9
# N, mm and rad of a matrix, such as a tilting stiffness.
LARGEST_ENTRY = 1e24


class Refused(ValueError):
    """A value that a field does not allow; the message completes "the value ..." to whole sentences."""


@dataclass(frozen=True, kw_only=True)
class Allowed:
    """What a field allows, in words (``description``), and how its text becomes a value.

    ``meaning`` and ``otherwise`` (what is taken where it is left out) are for the documentation. ``kind``: of quantity
    ("a length"), None without unit; ``unit``: a usual one. ``lowest``, ``highest``: bounds of a number or of a list's
    entries, in N, mm, s, rad. ``over_face``: in three dimensions alone; ``small``: against the module.
    """

    description: str
    meaning: str = ""
    otherwise: str = ""
    kind: str | None = None
    unit: str = ""
    lowest: float = -inf
    highest: float = inf
    over_face: bool = False
    small: bool = False

    def convert(self, value: Any) -> Any:
        """The value in N, mm, s, rad. Raises Refused for what is not allowed."""
        raise NotImplementedError

    def spelled(self, value: Any) -> Any:
        """A value as a scene file has it."""
        return value


@dataclass(frozen=True, kw_only=True)
class AllowedNumber(Allowed):
    """A quantity or a bare number.

    ``words``: texts that stand for values; ``below``: a sentence added where a value is too small; ``either_sign``:
    the bounds are of its size; ``above_lowest``, ``below_highest``: the bound itself is not allowed.
    """

    words: Mapping[str, Any] = field(default_factory=dict)
    below: str = ""
    either_sign: bool = False
    whole: bool = False
    above_lowest: bool = False
    below_highest: bool = False

    def convert(self, value: Any) -> Any:
        if isinstance(value, str) and value in self.words:
            return self.words[value]
        number = _quantity(value, self.unit, self.words, self.kind)[0] if self.kind else _bare(value, self.whole)
        size = abs(number) if self.either_sign else number
        reason = out_of_range(size, self.lowest, self.highest, self.above_lowest, self.below_highest)
        if reason:
            raise Refused(reason if reason in (TOO_LARGE, NOT_FINITE) else f"{reason} {self.below}".rstrip())
        return number

    def spelled(self, value: Any) -> Any:
        """A quantity in the field's usual unit where that gives it bit for bit, else in N, mm, s, rad."""
        word = next((word for word, meant in self.words.items() if meant == value), None)
        if word is not None:
            return word
        return value if self.kind is None else units.text_of(value, self.kind, self.unit)


@dataclass(frozen=True, kw_only=True)
class AllowedList(Allowed):
    """A list of ``shortest`` to ``longest`` quantities of one kind, or bare numbers, each within the bounds; a refusal
    names the first wrong entry. ``closed``: they sum to zero, as pitch errors do around a gear.
    """

    longest: int = 1000
    shortest: int = 1
    closed: bool = False

    def convert(self, value: Any) -> tuple[float, ...]:
        if not isinstance(value, list):
            raise Refused("is not a list.")
        if not self.shortest <= len(value) <= self.longest:
            entries = "1 entry" if len(value) == 1 else f"{len(value)} entries"
            raise Refused(f"has {entries}." if value else "is empty.")
        return tuple(self._entry(number, entry) for number, entry in enumerate(value, 1))

    def _entry(self, number: int, entry: Any) -> float:
        try:
            converted = _quantity(entry, self.unit, (), self.kind)[0] if self.kind else _bare(entry, whole=False)
            reason = out_of_range(converted, self.lowest, self.highest)
        except Refused as error:
            reason = str(error)
        if reason:
            raise Refused(f"has the entry {as_written(entry) or 'of a section'} at place {number}, which {reason}")
        return converted

    def spelled(self, value: Any) -> list[Any]:
        return [float(each) if self.kind is None else units.text_of(each, self.kind, self.unit) for each in value]


@dataclass(frozen=True)
class Measured:
    """A number in N, mm, s, rad with its kind ("a length"), where it is not the field's first."""

    number: float
    kind: str


@dataclass(frozen=True, kw_only=True)
class AllowedEither(Allowed):
    """A quantity of one of several kinds, or a word; ``ranges``: bounds of each kind, both included; ``units``: usual
    ones. The first kind becomes a number, another a ``Measured``; a word stays.
    """

    ranges: Mapping[str, tuple[float, float]]
    units: Mapping[str, str]
    words: tuple[str, ...]

    def convert(self, value: Any) -> float | Measured | str:
        if isinstance(value, str) and value in self.words:
            return value
        number, kind = _quantity(value, self.unit, self.words, *self.ranges)
        reason = out_of_range(number, *self.ranges[kind])
        if reason:
            raise Refused(reason)
        return number if kind == self.kind else Measured(number, kind)

    def spelled(self, value: float | Measured | str) -> str:
        if isinstance(value, str):
            return value
        measured = value if isinstance(value, Measured) else Measured(value, self.kind)
        return units.text_of(measured.number, measured.kind, self.units[measured.kind])


@dataclass(frozen=True, kw_only=True)
class AllowedText(Allowed):
    """A text of at most ``longest`` characters."""

    longest: int

    def convert(self, value: Any) -> Any:
        if not isinstance(value, str):
            raise Refused("is not a text.")
        if len(value) > self.longest:
            raise Refused("is too long.")
        return value


@dataclass(frozen=True, kw_only=True)
class AllowedFile(AllowedText):
    """The name of a file with a certain ``ending``, such as ".msh"; ``made``: makes what has the name as its
    ``path``."""

    longest: int = LONGEST_FILE_NAME
    ending: str
    made: Callable[[str], Any] = str

    def convert(self, value: Any) -> Any:
        if isinstance(value, str) and not value.strip():
            raise Refused("is empty.")
        if isinstance(value, str) and (not value.endswith(self.ending) or value == self.ending):
            raise Refused(f"is not the name of a file that ends in {self.ending}.")
        return self.made(super().convert(value))

    def spelled(self, value: Any) -> str:
        return value if isinstance(value, str) else value.path


@dataclass(frozen=True, kw_only=True)
class AllowedChoice(Allowed):
    """One of a few ``names``."""

    names: tuple[str, ...]

    def convert(self, value: Any) -> str:
        if not isinstance(value, str):
            raise Refused("is not known.")
        if value not in self.names:
            raise Refused("is not known." + did_you_mean(value, self.names))
        return value


class AllowedSwitch(Allowed):
    """True or false."""

    def convert(self, value: Any) -> bool:
        if not isinstance(value, bool):
            raise Refused("is neither true nor false.")
        return value


TOO_LARGE = "is too large."
NOT_FINITE = "is not a finite number."


def out_of_range(
    number: float, lowest: float, highest: float, above_lowest: bool = False, below_highest: bool = False
) -> str:
    """What is wrong with a number outside its bounds, both included unless told; empty for one within."""
    if isinstance(number, float) and not isfinite(number):
        return NOT_FINITE
    if number > highest or (below_highest and number == highest):
        return TOO_LARGE
    if number > lowest or (not above_lowest and number == lowest):
        return ""
    if lowest < 0 or number > 0:
        return "is too small."
    return "is negative." if number < 0 else "is zero."


def _bare(value: Any, whole: bool) -> float:
    if isinstance(value, str):
        raise Refused("is a text, not a bare number.")
    if isinstance(value, bool):
        raise Refused("is true or false, not a number.")
    if not isinstance(value, (int, float)):
        raise Refused("is not a number.")
    if whole and isinstance(value, float):
        raise Refused("is not a whole number.")
    try:
        # A float leaves its spelling behind.
        return value if whole else float(value)
    except OverflowError:
        raise Refused(TOO_LARGE) from None


def _quantity(value: Any, unit: str, words: Any, *kinds: str) -> tuple[float, str]:
    if isinstance(value, bool) or not isinstance(value, (int, float, str)):
        raise Refused("is not a text with a number and its unit.")
    if not isinstance(value, str):
        written = f"{as_written(value)} {unit}"
        in_unit = f' In {unit} it is written "{written}".' if written[0] in "0123456789" else ""
        if in_unit and unit == "%" and value < 1.0:
            in_unit = f'{in_unit[:-1]}, as a part of 1 "{100.0 * value:g} %".'
        raise Refused(f"is a number without its unit.{in_unit}")
    try:
        return units.of_kind(value, *kinds)
    except units.QuantityError as error:
        raise Refused(str(error) + did_you_mean(value, words)) from None


@dataclass(frozen=True, kw_only=True)
class AllowedMatrix(Allowed):
    """A stiffness matrix: ``size`` rows of as many bare numbers, symmetric and not negative but for ``round_off``."""

    size: int
    round_off: float = ROUND_OFF

    def convert(self, value: Any) -> Matrix:
        import numpy as np

        rows = value if isinstance(value, list) and all(isinstance(row, list) for row in value) else []
        numbers = [each for row in rows for each in row if isinstance(each, (int, float)) and type(each) is not bool]
        # So large ones have squares, and whole ones as many digits as floats hold.
        held = [each for each in numbers if abs(each) <= LARGEST_ENTRY]
        if {len(rows), *map(len, rows)} != {self.size} or len(held) != self.size**2:
            raise Refused(f"is not {self.size} rows of {self.size} numbers of up to {LARGEST_ENTRY:g}.")
        matrix = np.array(numbers, dtype=float).reshape(self.size, self.size)
        apart = np.abs(matrix - matrix.T)
        round_off = self.round_off * np.abs(matrix).max()
        if apart.max() > round_off:
            row, column = (int(each) for each in np.unravel_index(apart.argmax(), apart.shape))
            places = f"{matrix[row, column]:g} in row {row + 1}, but {matrix[column, row]:g} in column {row + 1}"
            raise Refused(f"is not symmetric: {places}.")
        # Each motion by what gives its stiffness the size of the others'.
        size = np.sqrt(np.maximum(np.abs(np.diag(matrix)), round_off or 1.0))
        if np.linalg.eigvalsh(matrix / np.outer(size, size))[0] < -self.round_off:
            raise Refused("is not positive: in one motion it would push on by itself.")
        return tuple(tuple(float(each) for each in row) for row in 0.5 * (matrix + matrix.T))

    def spelled(self, value: Matrix) -> list[list[float]]:
        return [list(row) for row in value]
