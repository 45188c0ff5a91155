"""Where in a TOML text a key stands, for messages; ``tomllib`` does not say."""

from __future__ import annotations

import re

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
