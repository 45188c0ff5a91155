"""Values of a TOML file as they were written."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

_LONGEST = 60


class WrittenFloat(float):
    """A number of a TOML file that remembers how it was written."""

    def __new__(cls, text: str) -> WrittenFloat:
        """The number that ``text`` stands for."""
        number = super().__new__(cls, text)
        number.text = text
        return number


def as_written(value: Any) -> str:
    """A value in TOML's own spelling, shortened where it is long; empty for a section."""
    if isinstance(value, Mapping):
        return ""
    if isinstance(value, list):
        return "a list"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int) and abs(value) >= 10**_LONGEST:
        return f"a number of more than {_LONGEST} digits"
    text = json.dumps(value, ensure_ascii=False) if isinstance(value, str) else getattr(value, "text", None) or str(value)
    return text if len(text) <= _LONGEST else text[: _LONGEST - 3] + "..."
