"""One process after the other, where many start together."""

import fcntl
import logging
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

LOGGER = logging.getLogger(__name__)


@contextmanager
def one_at_a_time(file: Path) -> Iterator[None]:
    """Wait until no other process is in here by the same file, which is made where it is missing. The system lets the
    next one in when a process ends, however it ends. Where the file system has no locks nobody waits."""
    lock = None
    with suppress(OSError):
        file.parent.mkdir(parents=True, exist_ok=True)
        lock = open(file, "a")
    try:
        if lock is not None:
            try:
                fcntl.flock(lock, fcntl.LOCK_EX)
            except OSError as error:
                LOGGER.debug("%s: no locks on this file system: %s", file, error)
        yield
    finally:
        if lock is not None:
            lock.close()
