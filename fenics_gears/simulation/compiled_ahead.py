"""Compiles the hot loops before the first run, once for all processes of a machine that use the same sources.

Numba keeps what it compiled in files beside the sources, or in the user's folder for caches. It compares the source of
a loop with them, not the sources of the loops that it calls, so files of other sources go first. A mark beside them
says of which sources they are, for one Python, numba and processor. One process compiles while the others wait; a
process that meets what is compiled already reads some file times.
"""

from __future__ import annotations

import hashlib
import logging
import os
import re
import shutil
import signal
import subprocess
import sys
import threading
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any

import llvmlite.binding
import numba
from numba.core.caching import IndexDataCacheFile
from numba.core.dispatcher import Dispatcher

from fenics_gears.system.output import one_at_a_time
from fenics_gears.system.progress import Progress

LOGGER = logging.getLogger(__name__)
PACKAGE = Path(__file__).parents[1]
STAGE = "compile, once for these sources"
# By processes at the same time, each half of the work; `warm_up` says what.
MARCH = "march"
PARTS = (MARCH, "results and face")


def compile_loops(progress: Progress) -> None:
    """Compile all loops that are not compiled yet, in a minute or less, and say so; where that fails, a run compiles
    what it needs."""
    _save_in_turn()
    places = _places()
    name = f"compiled-{_machine()}"
    sources, kept = next(iter(places.items()))
    if _is_of_these_sources(kept / name):
        return
    with one_at_a_time(kept / "compiling", lambda: progress.say("another process compiles; waiting for it")):
        if _is_of_these_sources(kept / name):
            return
        if not any(map(_is_of_these_sources, kept.glob("compiled-*"))):
            _remove(places)
        if _is_of_these_sources(sources / "__pycache__" / name):
            _take_from_beside(places)
        else:
            progress.stage(STAGE)
            progress.say("compiling, once for these sources: about 45 s on two cores")
            if any(codes := _compiling()):
                LOGGER.warning("compiling ahead failed (exit codes %s); runs compile what they need", codes)
        with suppress(OSError):
            (kept / name).write_text(_sources(), encoding="utf-8")


@cache
def _places() -> dict[Path, Path]:
    """Where numba keeps what it compiles of a folder of the package, in the order of their names."""
    loops = (each for module in _modules() for each in vars(module).values() if isinstance(each, Dispatcher))
    of_folders = {Path(loop.py_func.__code__.co_filename).parent: loop for loop in loops}
    own = {folder: loop for folder, loop in of_folders.items() if PACKAGE in folder.parents and loop.stats.cache_path}
    return {folder: Path(own[folder].stats.cache_path) for folder in sorted(own)}


def _modules() -> list[Any]:
    return [module for name, module in list(sys.modules.items()) if name.startswith("fenics_gears.")]


@cache
def _machine() -> str:
    """Of what numba's files are, but for their sources."""
    features = llvmlite.binding.get_host_cpu_features().flatten()
    words = (sys.implementation.cache_tag, numba.__version__, llvmlite.binding.get_host_cpu_name(), features)
    return hashlib.sha256("\n".join(words).encode()).hexdigest()[:16]


def _sources() -> str:
    """The files that have compiled loops, each with what numba compares of them."""
    files = (file for file in sorted(PACKAGE.rglob("*.py")) if re.search(rb"\b(njit|cfunc)\b", file.read_bytes()))
    return "".join(f"{_stamp(file)} {file.relative_to(PACKAGE)}\n" for file in files)


def _stamp(file: Path) -> str:
    status = file.stat()
    return f"{status.st_mtime_ns} {status.st_size}"


def _is_of_these_sources(mark: Path) -> bool:
    try:
        lines = [line.rsplit(" ", 1) for line in mark.read_text(encoding="utf-8").splitlines()]
        return bool(lines) and all(stamp == _stamp(PACKAGE / name) for stamp, name in lines)
    except (OSError, ValueError):
        return False


def _remove(places: dict[Path, Path]) -> None:
    for place in places.values():
        for file in (*place.glob("*.nb[ci]"), *place.glob("compiled-*")):
            file.unlink(missing_ok=True)


def _take_from_beside(places: dict[Path, Path]) -> None:
    """Of a checkout that another user compiled: numba does not look where it cannot write."""
    with suppress(OSError):
        for folder, place in places.items():
            for file in (folder / "__pycache__").glob("*.nb[ci]"):
                shutil.copy(file, place)


def _compiling() -> list[int]:
    """Exit codes of the processes that compile."""
    paths = os.pathsep.join([str(PACKAGE.parent), *filter(None, [os.environ.get("PYTHONPATH")])])
    environment = os.environ | {"PYTHONPATH": paths}
    command = [sys.executable, "-P", "-m", f"{__package__}.warm_up"]
    # Its standard input ends with this process, however that ends.
    processes = [subprocess.Popen([*command, part], env=environment, stdin=subprocess.PIPE) for part in PARTS]
    try:
        return [process.wait() for process in processes]
    finally:
        for process in processes:
            process.kill()


def end_at_once_by_ctrl_c() -> None:
    """In a process that compiles: what it has written is whole."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def end_with_its_parent() -> None:
    """In a process that compiles a part: a killed run leaves nobody behind who compiles for it."""

    def watch() -> None:
        # Not by `sys.stdin`: Python aborts where a thread still reads from it at the end.
        os.read(0, 1)
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()


@cache
def _save_in_turn() -> None:
    """Let one process at a time add to numba's files of a loop. Two that compile it for different types at once would
    both take the same free name for their code."""
    save = IndexDataCacheFile.save

    def in_turn(self: Any, key: Any, data: Any) -> None:
        with one_at_a_time(Path(self._cache_path) / "saving"):
            save(self, key, data)

    IndexDataCacheFile.save = in_turn
