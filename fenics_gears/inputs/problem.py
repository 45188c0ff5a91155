"""One mistake in a scene file."""

from __future__ import annotations

from collections.abc import Mapping
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
