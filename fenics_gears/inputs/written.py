"""Values of a TOML file as they were written, and Python's values in TOML's spelling."""

from __future__ import annotations

import functools
import json
import re
from collections.abc import Iterator, Mapping
from typing import Any

_LONGEST = 60


class WrittenFloat(float):
    """A number of a TOML file that remembers how it was written."""

    def __new__(cls, text: str) -> WrittenFloat:
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
    said = getattr(value, "text", None) or str(value)
    text = json.dumps(value, ensure_ascii=False) if isinstance(value, str) else said
    return text if len(text) <= _LONGEST else text[: _LONGEST - 3] + "..."


def as_toml(tree: Mapping[str, Any]) -> str:
    """A parsed scene as the text of a scene file, without entries that are None. Raises TypeError for what no file can
    hold.

    >>> print(as_toml({"load": {"wheel_torque": "437 N m"}}), end="")
    [load]
    wheel_torque = "437 N m"
    """
    if not isinstance(tree, Mapping):
        raise TypeError(f"{type(tree).__name__} is no dictionary")
    return "\n".join(_section_lines(tree, ())).strip() + "\n"


def _section_lines(section: Mapping[str, Any], path: tuple[str, ...]) -> Iterator[str]:
    if path:
        yield f"\n[{'.'.join(map(_toml_name, path))}]"
    for name, value in section.items():
        if value is not None and not isinstance(value, Mapping):
            yield f"{_toml_name(name)} = {toml_value(value)}"
    for name, value in section.items():
        if isinstance(value, Mapping):
            yield from _section_lines(value, (*path, name))


@functools.lru_cache(maxsize=1000)
def _toml_name(name: Any) -> str:
    if not isinstance(name, str):
        raise TypeError(f"the name {name!r} is no text")
    return name if re.fullmatch(r"[A-Za-z0-9_-]+", name) else toml_value(name)


def toml_value(value: Any) -> str:
    """A value, a table of values included, in TOML's spelling on one line. Raises TypeError for a value that no TOML
    file can hold.

    >>> toml_value(["1 mm", 2.5, True])
    '["1 mm", 2.5, true]'
    """
    if hasattr(value, "tolist"):
        # Of numpy, which from version 2 on spells itself np.float64(0.1).
        value = value.tolist()
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{_toml_name(name)} = {toml_value(inner)}" for name, inner in value.items()) + " }"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(map(toml_value, value)) + "]"
    if isinstance(value, str):
        # JSON's escapes are among TOML's, but for the one character that JSON leaves as it is.
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007F")
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return getattr(value, "text", None) or repr(value)
    raise TypeError(f"{value!r} is neither a text nor a number, true or false, a list or a dictionary")
