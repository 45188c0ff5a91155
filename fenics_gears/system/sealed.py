"""Files that end with a digest of all bytes before it; it is checked before anything else reads the file.

HDF5 can end the whole process at one wrong bit of a damaged file. It ignores bytes after its own end, so other programs
still read a sealed file.
"""

from __future__ import annotations

import hashlib
import os
import sys
from pathlib import Path
from typing import BinaryIO

from fenics_gears.system.user_file import check_file

_MARK = b"\nsha256 "
_LENGTH = len(_MARK) + 64
_PART = 1 << 20


def seal(content: bytes | memoryview) -> bytes:
    """The bytes to be written after a file's content."""
    return _MARK + hashlib.sha256(content).hexdigest().encode()


def seal_of(file: BinaryIO, length: int) -> bytes:
    """The same of the first `length` bytes of an open file."""
    digest, left = hashlib.sha256(), length
    file.seek(0)
    while left and (part := file.read(min(left, _PART))):
        digest.update(part)
        left -= len(part)
    return _MARK + digest.hexdigest().encode()


def unsealed(path: Path) -> BinaryIO:
    """A sealed file, open at its beginning. Raises ValueError where it is not what was written, OSError where it cannot
    be read."""
    check_file(path, sys.maxsize)
    file = open(path, "rb")
    try:
        length = os.fstat(file.fileno()).st_size - _LENGTH
        if length < 0 or seal_of(file, length) != file.read(_LENGTH):
            raise ValueError("it does not hold what was written into it, or was written by another version or program")
        file.seek(0)
        return file
    except BaseException:
        file.close()
        raise
