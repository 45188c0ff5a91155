"""Memory that a run may take, by `--memory` or FENICS_GEARS_MEMORY, else a share of what is free; and giving it
back."""

from __future__ import annotations

import ctypes
import errno
import functools
import mmap
import os
import re
from contextlib import suppress
from dataclasses import dataclass
from math import inf
from pathlib import Path
from typing import TYPE_CHECKING

from fenics_gears.errors import SceneError

from .job import ranks_on_machine

if TYPE_CHECKING:
    import numpy as np

MEMORY_VARIABLE = "FENICS_GEARS_MEMORY"
BYTES = {"MB": 1e6, "GB": 1e9, "TB": 1e12}
# Of what is free when a run starts, or of what there is; other programs need some too.
SHARE = 0.6
# Where neither the kernel nor a container says what is free.
UNKNOWN = 8e9
# Free bytes of the heap that stay in the process after a run, for the next one.
MOST_KEPT = 200e6


def size_in_bytes(size: str, name: str, example: str) -> float:
    """Bytes of a size such as "8 GB"; raises SceneError, which names where it was given."""
    match = re.fullmatch(r"\s*(\d+(?:\.\d*)?)\s*([MGT]B)\s*", size)
    if not match:
        raise SceneError(
            f'{name} = {size!r} is no size. Allowed: a number of {", ".join(BYTES)} from 0 MB on, such as "{example}".'
        )
    return float(match[1]) * BYTES[match[2]]


def allowed_memory() -> float:
    """Bytes that a run may take; processes of a job on one machine share what is free. Raises SceneError for a wrong
    size."""
    given = os.environ.get(MEMORY_VARIABLE)
    return size_in_bytes(given, MEMORY_VARIABLE, "8 GB") if given else SHARE * free_memory() / ranks_on_machine()


def pages(rows: int, columns: int) -> np.ndarray:
    """A matrix of zeros that takes memory page by page where it is written, and gives it back as soon as nobody holds
    it."""
    # Imported here: help does without.
    import numpy as np

    try:
        held = mmap.mmap(-1, max(8 * rows * columns, 1), flags=mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS)
    except OSError as error:
        if error.errno != errno.ENOMEM:
            raise
        # `mmap` has no error of its own where there is no memory.
        raise MemoryError from error
    # Pages of megabytes would hold much that is never written. Kernels without them refuse; others have no such call.
    with suppress(OSError, AttributeError):
        held.madvise(mmap.MADV_NOHUGEPAGE)
    return np.frombuffer(held, count=rows * columns).reshape(rows, columns)


def give_back() -> None:
    """Give memory that was freed back to the system where it is much: glibc's heap shrinks from its end alone."""
    library = _c_library()
    if library is not None and library.mallinfo2().fordblks > MOST_KEPT:
        library.malloc_trim(0)


@functools.cache
def _c_library():
    """glibc from 2.33 on; None elsewhere."""
    library = ctypes.CDLL(None)
    if not (hasattr(library, "malloc_trim") and hasattr(library, "mallinfo2")):
        return None
    library.mallinfo2.restype = _HeapInformation
    library.malloc_trim.argtypes = (ctypes.c_size_t,)
    return library


class _HeapInformation(ctypes.Structure):
    """What mallinfo2(3) tells, bytes; `fordblks` are free."""

    _NAMES = "arena ordblks smblks hblks hblkhd usmblks fsmblks uordblks fordblks keepcost"
    _fields_ = [(name, ctypes.c_size_t) for name in _NAMES.split()]


def free_memory() -> float:
    """Bytes that programs can still take on this machine, or in this container."""
    return min(_of_machine(), _of_container())


def _of_machine() -> float:
    try:
        match = re.search(r"^MemAvailable:\s*(\d+) kB", Path("/proc/meminfo").read_text(encoding="ascii"), re.MULTILINE)
    except OSError:
        return UNKNOWN
    return 1024.0 * int(match[1]) if match else UNKNOWN


def _of_container() -> float:
    """By the control group's limit, less what is in use; infinite where there is none."""
    for names in (("memory.max", "memory.current"), ("memory/memory.limit_in_bytes", "memory/memory.usage_in_bytes")):
        try:
            limit, in_use = ((Path("/sys/fs/cgroup") / name).read_text(encoding="ascii").strip() for name in names)
        except OSError:
            continue
        if limit.isdecimal():
            return max(float(limit) - float(in_use), 0.0)
    return float("inf")


# Shares of the memory for contact operators: of those kept, and of a block of steps of a march, twice.
SHARE_KEPT = 0.7
SHARE_OF_A_BLOCK = 0.12


@dataclass
class Kept:
    """Memory (bytes) that operators may take at `most`, that the kept ones have `taken`, and of `others`, those of
    other cycles. Operators beyond are made again each time the cycle comes round; `needed`: whether it does."""

    most: float = inf
    taken: float = 0.0
    others: float = 0.0
    needed: bool = True

    def takes(self, size: float) -> bool:
        """Whether there is room for this many bytes more, which are then counted."""
        if not self.needed or self.others + self.taken + size > SHARE_KEPT * self.most:
            return False
        self.taken += size
        return True
