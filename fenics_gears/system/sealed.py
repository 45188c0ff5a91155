"""Files that end with a digest of all bytes before it; it is checked before anything else reads the file.

HDF5 can end the whole process at one wrong bit of a damaged file. It ignores bytes after its own end, so other programs still read a
sealed file.
"""

from __future__ import annotations

import hashlib
import io
from pathlib import Path

_MARK = b"\nsha256 "
_LENGTH = len(_MARK) + 64


def seal(content: bytes | memoryview) -> bytes:
    """The bytes to be written after a file's content."""
    return _MARK + hashlib.sha256(content).hexdigest().encode()


def unsealed(path: Path) -> io.BytesIO:
    """The content of a sealed file. Raises ValueError where it is not what was written, OSError where it cannot be read."""
    content = path.read_bytes()
    if content[-_LENGTH:] != seal(memoryview(content)[:-_LENGTH]):
        raise ValueError("it does not hold what was written into it, or was written by another version or program")
    return io.BytesIO(content[:-_LENGTH])
