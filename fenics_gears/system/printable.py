"""Text that a terminal and a file of results can take: a terminal obeys control characters, NUL ends a text of HDF5."""

from __future__ import annotations

import re

# All but tab and new line.
_CONTROL = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f]")
# Python's stand-ins for bytes of a file's name that are no UTF-8; no encoding takes them.
_BYTES = re.compile("[\ud800-\udfff]")


def control_character(text: str) -> str:
    """The first control character of a text as Unicode writes it, "U+001B"; empty where there is none."""
    found = _CONTROL.search(text)
    return f"U+{ord(found[0]):04X}" if found else ""


def printable(text: str) -> str:
    """The text with a replacement character for each that is none of a text."""
    return _BYTES.sub("\ufffd", _CONTROL.sub("\ufffd", text))
