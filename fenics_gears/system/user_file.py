"""Files that users name: their content, or in words why it is not read; what would fill the memory is refused
before."""

import os
import stat
from pathlib import Path

MEGABYTE = 1_000_000
# Largest sizes, some ten times what the largest sensible file of a kind has.
LARGEST_SCENE = 10 * MEGABYTE  # lists of deviations of a thousand teeth are 0.1 MB; 10 MB take ten seconds to parse
LARGEST_TABLE = 200 * MEGABYTE  # measured curves of a thousand teeth with a thousand points each are 20 to 40 MB
LARGEST_MESH = 1000 * MEGABYTE  # a plane mesh of a million nodes has 100 MB


class Unreadable(ValueError):
    """Why a file is not read, in words that follow its name."""


class Missing(Unreadable):
    """There is no file of that name."""


def check_file(path: str | Path, largest: int) -> None:
    """Raise Unreadable for what is no file, or has more than `largest` bytes."""
    try:
        state = os.stat(path)
    except FileNotFoundError:
        raise Missing("there is no such file") from None
    # A ValueError is of a name that the file system cannot have.
    except (OSError, ValueError) as error:
        raise Unreadable(f"cannot be read: {_reason(error)}") from None
    if stat.S_ISDIR(state.st_mode):
        raise Unreadable("cannot be read: it is a folder")
    if not stat.S_ISREG(state.st_mode):
        raise Unreadable("it is a device or a pipe, not a file")
    if state.st_size > largest:
        size = round(state.st_size / MEGABYTE)
        most = largest // MEGABYTE
        raise Unreadable(f"has {size} MB; a file of more than {most} MB is not read")


def content_of(path: Path, largest: int) -> bytes:
    """The bytes of a file. Raises Unreadable."""
    check_file(path, largest)
    try:
        with open(path, "rb") as file:
            content = file.read(largest + 1)
    except OSError as error:
        raise Unreadable(f"cannot be read: {_reason(error)}") from None
    if len(content) > largest:
        raise Unreadable(f"has more than {largest // MEGABYTE} MB, which is not read")
    return content


def text_of(path: Path, largest: int) -> str:
    """The text of a file in UTF-8, its lines ended by new lines. Raises Unreadable."""
    content = content_of(path, largest)
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise Unreadable(f"is not a text in UTF-8 (byte {error.start})") from None
    if "\0" in text:
        line = text[: text.index("\0")].count("\n") + 1
        raise Unreadable(f"is not a text: it has the character NUL in line {line}")
    return text.replace("\r\n", "\n").replace("\r", "\n")


def _reason(error: Exception) -> str:
    if isinstance(error, UnicodeError):
        return "its name is none in this system's encoding"
    return getattr(error, "strerror", None) or str(error)
