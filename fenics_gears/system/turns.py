"""One process after the other, where many start together."""

import fcntl
import logging
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TextIO

LOGGER = logging.getLogger(__name__)


@contextmanager
def one_at_a_time(file: Path, waits: Callable[[], None] = lambda: None) -> Iterator[None]:
    """Wait until no other process is in here by the same file, which is made where it is missing; `waits` is called
    where there is one. The system lets the next one in when a process ends, however it ends. Where the file system has
    no locks nobody waits."""
    lock = None
    with suppress(OSError):
        file.parent.mkdir(parents=True, exist_ok=True)
        lock = open(file, "a")
    try:
        if lock is not None:
            _lock(lock, file, waits)
        yield
    finally:
        if lock is not None:
            lock.close()


def _lock(lock: TextIO, file: Path, waits: Callable[[], None]) -> None:
    try:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            waits()
            fcntl.flock(lock, fcntl.LOCK_EX)
    except OSError as error:
        LOGGER.debug("%s: no locks on this file system: %s", file, error)
