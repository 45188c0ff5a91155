"""The directory a run writes to: a file is written aside and then renamed, so that a final name never holds half a
file.

Sealed files end with a digest of all bytes before it, which is checked first. HDF5 can end the whole process at one
wrong bit, and ignores bytes after its own end. Processes that write the same files do it one at a time.
"""

import contextlib
import fcntl
import hashlib
import logging
import os
import shutil
import socket
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import BinaryIO, TextIO

from fenics_gears.errors import ComputationError, SceneError

from .user_file import check_file

LOGGER = logging.getLogger(__name__)
# The beginning of names of files, and of directories of files, while they are written; machine and process follow.
UNFINISHED = ".unfinished-"
# What another machine has not changed for longer (s) was left by a process that was killed.
LONGEST_WRITING = 24 * 3600.0
# Bytes that have to find room before anything is computed: the size of a small result.
TRIED = 200_000
ANOTHER = "choose another directory with --output DIR."


def check_working_folder() -> None:
    """Raise SceneError where the working folder, from which names of files count, has been removed."""
    try:
        os.getcwd()
    except OSError:
        raise SceneError("The working folder has been removed. Change into one that exists (cd).") from None


def check_writable(directory: Path, *names: str, room: int = 0) -> None:
    """Raise SceneError where no result of these names, which takes so many bytes of `room`, could be written into a
    directory; leaves nothing there."""
    try:
        existing = _existing(directory)
        for name in names:
            if _is_there(directory / name) and not (directory / name).is_file():
                raise SceneError(f"{directory / name} is no file; the result needs this name. Remove it, or {ANOTHER}")
        _try_to_write(existing)
        if (free := shutil.disk_usage(existing).free) < room:
            raise OSError(0, f"the result takes {room / 1e6:,.1f} MB at least, and {free / 1e6:,.1f} MB are free")
    except OSError as error:
        # A folder that is there, as /proc, says so of the files that are to be made in it.
        why = "no file can be made there" if isinstance(error, FileNotFoundError) else error.strerror or error
        raise SceneError(f"{directory} cannot be written to: {why}. To go on, {ANOTHER}") from None


def _existing(directory: Path) -> Path:
    """The directory, or the one that is there on the way to it."""
    existing = next(parent for parent in (directory.absolute(), *directory.absolute().parents) if _is_there(parent))
    if not existing.is_dir():
        raise SceneError(f"{existing} is a file; the result needs a directory. To go on, {ANOTHER}")
    return existing


def _try_to_write(directory: Path) -> None:
    """Write a little and remove it: root may write where permissions say no, nobody into what the kernel makes up, and
    of a full disk only writing tells."""
    with tempfile.TemporaryDirectory(prefix=_unfinished(), dir=directory) as aside:
        Path(aside, "tried").write_bytes(bytes(TRIED))


def _is_there(path: Path) -> bool:
    try:
        path.stat()
        return True
    except (FileNotFoundError, NotADirectoryError):
        if path.is_symlink():
            target = os.readlink(path)
            raise SceneError(f"{path} is a link to {target}, which is not there. Remove it, or {ANOTHER}") from None
        return False


@contextlib.contextmanager
def whole_file(path: Path, buffering: int = -1) -> Iterator[BinaryIO]:
    """A new file, open to be written and read. At the end it takes its name, even from a file that had it; where an
    exception ends the block, it is removed. Raises OSError where it cannot be written."""
    path.parent.mkdir(parents=True, exist_ok=True)
    # Beside the final name, because a rename is atomic only within a file system; each writer has a file of its own.
    aside = path.with_name(f"{_unfinished()}{threading.get_ident()}")
    try:
        with open(aside, "w+b", buffering) as file:
            yield file
            file.flush()
            os.fsync(file.fileno())
        os.replace(aside, path)
    finally:
        aside.unlink(missing_ok=True)


@contextlib.contextmanager
def written_aside(directory: Path, written: list[Path]) -> Iterator[Path]:
    """A directory to write files into; at the end they move to ``directory``, replacing others, and their final names
    are added to ``written``. After an exception none is moved.

    Raises ComputationError where the disk is full or the directory cannot be written.
    """
    try:
        directory.mkdir(parents=True, exist_ok=True)
        remove_left_over(directory)
        with tempfile.TemporaryDirectory(prefix=_unfinished(), dir=directory) as aside:
            yield Path(aside)
            for file in sorted(Path(aside).iterdir()):
                os.replace(file, directory / file.name)
                written.append(directory / file.name)
    except OSError as error:
        raise ComputationError(f"{directory}: the result could not be written: {error.strerror or error}") from error


def remove_left_over(directory: Path) -> None:
    """Remove from a directory, not from its subdirectories, what killed processes were writing: processes of this
    machine that have ended, or of others more than a day ago."""
    own = f"{UNFINISHED}{_machine()}-"
    for left in directory.glob(f"{UNFINISHED}*"):
        # Another run may remove it at the same time.
        with contextlib.suppress(OSError):
            process = left.name.removeprefix(own).partition("-")[0]
            written = _is_alive(int(process)) if process.isdecimal() else _is_recent(left)
            if not written:
                shutil.rmtree(left) if left.is_dir() else left.unlink()


def _unfinished() -> str:
    return f"{UNFINISHED}{_machine()}-{os.getpid()}-"


def _machine() -> str:
    """Where a process number is one of its own: the machine, and of a container its own count of processes."""
    try:
        count = os.stat("/proc/self/ns/pid").st_ino
    except OSError:
        count = 0
    return f"{socket.gethostname()}-{count}"


def _is_alive(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except OSError:
        pass  # it is somebody else's
    return True


def _is_recent(path: Path) -> bool:
    return path.stat().st_mtime > time.time() - LONGEST_WRITING


def write_whole(file: Path, write: Callable[[Path], object]) -> Path:
    """Write a file, and others that belong to it, by `write(path)`: its name holds the whole file or none. Raises as
    `written_aside` does."""
    with written_aside(file.parent, []) as aside:
        write(aside / file.name)
    return file


_MARK = b"\nsha256 "
_LENGTH = len(_MARK) + 64
_PART = 1 << 20


def seal(content: bytes | memoryview) -> bytes:
    """The bytes to be written after a file's content."""
    return _MARK + hashlib.sha256(content).hexdigest().encode()


def seal_of(file: BinaryIO, length: int) -> bytes:
    """The same of the first `length` bytes of an open file."""
    digest = hashlib.sha256()
    left = length
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


@contextlib.contextmanager
def one_at_a_time(file: Path, waits: Callable[[], None] = lambda: None) -> Iterator[None]:
    """Wait until no other process is in here by the same file, which is made where it is missing; `waits` is called
    where there is one. The system lets the next one in when a process ends, however it ends. Where the file system has
    no locks nobody waits."""
    lock = None
    with contextlib.suppress(OSError):
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
