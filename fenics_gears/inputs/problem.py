"""One mistake in a scene file, and the line where it stands, which ``tomllib`` does not tell."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

Path = tuple[str, ...]


@dataclass(frozen=True)
class Problem:
    """One mistake: the field's path, its value as written, and what to do about it.

    ``written`` is None where nothing is written and empty for a section; ``unknown`` marks a name that no scene has.
    """

    path: Path
    written: str | None
    message: str
    unknown: bool = False

    def line(self, lines: Mapping[Path, int]) -> int:
        """The line of the field or of the section that lacks it; 0 where neither is found."""
        return next((lines[self.path[:n]] for n in range(len(self.path), 0, -1) if self.path[:n] in lines), 0)

    def describe(self, source: str, lines: Mapping[Path, int]) -> str:
        """Two lines for people: file, line, field and value; then what is wrong and what is allowed."""
        line = self.line(lines)
        place = f"{source}:{line}" if line else source
        field = ".".join(self.path)
        if self.written is not None:
            field = f"{field} = {self.written}" if self.written else f"[{field}]"
        return f"{place}: {field}\n    {self.message}"


# More mistakes than these are counted, not told: they are of a file that is no scene.
MOST_TOLD = 20


def listed(problems: Sequence[Problem], lines: Mapping[Path, int], source: str) -> str:
    """The first mistakes of a file in the order of their lines, and how many there are."""
    first = sorted(problems, key=lambda each: each.line(lines))[:MOST_TOLD]
    return counted([problem.describe(source, lines) for problem in first], len(problems), source)


def counted(entries: Sequence[str], count: int, source: str) -> str:
    """The same of mistakes in words, `count` of them in all."""
    more = [f"... and {count - MOST_TOLD} more"] if count > MOST_TOLD else []
    total = f"{count} mistake{'s' if count > 1 else ''} in {source}. Nothing was computed or written."
    return "\n".join([*entries[:MOST_TOLD], *more, total])


_NAME = r"(?:[A-Za-z0-9_-]+|\"[^\"]*\"|'[^']*')"
_DOTTED = rf"{_NAME}(?:\s*\.\s*{_NAME})*"
_HEADER = re.compile(rf"\s*\[\[?\s*({_DOTTED})\s*\]")
_KEY = re.compile(rf"\s*({_DOTTED})\s*=")


def line_numbers(text: str) -> dict[tuple[str, ...], int]:
    """The line, counted from 1, of each section header and each key that begins a line, by its path."""
    found: dict[tuple[str, ...], int] = {}
    section: tuple[str, ...] = ()
    within_text = False
    for number, line in enumerate(text.splitlines(), 1):
        # A text over several lines may hold anything, also what looks like a key.
        begins_within, within_text = within_text, within_text ^ (len(re.findall(r'"""|\'\'\'', line)) % 2 == 1)
        if begins_within:
            continue
        if header := _HEADER.match(line):
            section = _path(header[1])
            found.setdefault(section, number)
        elif key := _KEY.match(line):
            found.setdefault((*section, *_path(key[1])), number)
    return found


def _path(dotted: str) -> tuple[str, ...]:
    return tuple(name.strip("\"'") for name in re.findall(_NAME, dotted))
