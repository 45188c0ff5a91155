"""Memory of this process, stage by stage (Linux), and the bytes that arrays themselves hold."""

from __future__ import annotations

from dataclasses import fields, is_dataclass
from pathlib import Path

import numpy as np

STATUS, RESET = Path("/proc/self/status"), Path("/proc/self/clear_refs")


def resident() -> int:
    """Bytes that the process holds now."""
    return _status("VmRSS")


def peak() -> int:
    """The most bytes that the process has held since `forget_peak`."""
    return _status("VmHWM")


def forget_peak() -> None:
    """Count the peak from now on (proc(5): writing 5 to clear_refs)."""
    RESET.write_text("5", encoding="ascii")


def _status(name: str) -> int:
    line = next(line for line in STATUS.read_text(encoding="ascii").splitlines() if line.startswith(name + ":"))
    return 1024 * int(line.split()[1])


def array_bytes(*things) -> int:
    """Bytes of all arrays in dataclasses, containers and instances reached from `things`, each counted once."""
    seen: set[int] = set()
    return sum(_bytes(thing, seen) for thing in things)


def _bytes(thing, seen: set[int]) -> int:
    if isinstance(thing, (str, bytes, int, float, type)) or thing is None or id(thing) in seen:
        return 0
    seen.add(id(thing))
    if isinstance(thing, np.ndarray):
        return 0 if thing.base is not None and id(thing.base) in seen else thing.nbytes
    if isinstance(thing, dict):
        return sum(_bytes(value, seen) for value in thing.values())
    if isinstance(thing, (list, tuple, set, frozenset)) or type(thing).__name__ == "deque":
        return sum(_bytes(value, seen) for value in thing)
    if is_dataclass(thing):
        return sum(_bytes(getattr(thing, field.name), seen) for field in fields(thing))
    return 0
