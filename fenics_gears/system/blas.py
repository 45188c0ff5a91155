"""Kernels of OpenBLAS that suit the processor.

An OpenBLAS that is older than the processor takes kernels of 2004, which condense at half the speed. It reads
OPENBLAS_CORETYPE when it is loaded. Which kernels suit, a process of its own finds out once for a processor and its
libraries; run as a script, this file is that process.
"""

import contextlib
import ctypes
import functools
import json
import os
import subprocess
import sys
from dataclasses import asdict, dataclass
from importlib.util import find_spec
from itertools import takewhile
from pathlib import Path

VARIABLE = "OPENBLAS_CORETYPE"
PROCESSORS = Path("/proc/cpuinfo")
# Kernels that use these instructions are quick. The oldest are the tried ones: those for AVX-512 have been wrong in
# several releases.
INSTRUCTIONS = {"avx2", "fma"}
QUICK = {"Haswell", "Excavator", "Zen", "SkylakeX", "Cooperlake", "SapphireRapids"}
TRIED = "Haswell"
# The system's BLAS, which PETSc and MUMPS use also where NumPy and SciPy have libraries of their own.
SYSTEM_LIBRARY = "libblas.so.3"
SYSTEM_FOLDERS = ("/usr/lib/x86_64-linux-gnu", "/usr/lib64", "/usr/lib")
# Rows, columns and inner size of the products that must be exact: below, at and beyond the kernels' blocks.
SIZES = ((1, 1, 1), (5, 7, 3), (33, 18, 65), (130, 97, 401))


@dataclass(frozen=True)
class Choice:
    """The value for OPENBLAS_CORETYPE, "" where OpenBLAS is left to itself, and the reason in words."""

    kernels: str
    why: str


def choose(environment) -> None:
    """Set OPENBLAS_CORETYPE where OpenBLAS would take slow or wrong kernels, unless the user has set it or NumPy is
    loaded."""
    if VARIABLE in environment or "numpy" in sys.modules:
        return
    if kernels := choice().kernels:
        environment[VARIABLE] = kernels


def said(environment=os.environ) -> str:
    """In words, why OpenBLAS has the kernels that it has."""
    given = environment.get(VARIABLE)
    if given and given != choice().kernels:
        return f"{VARIABLE}={given}, set by the user"
    return f"{VARIABLE}={given}: {choice().why}" if given else choice().why


@functools.cache
def choice() -> Choice:
    """What suits this processor and its libraries, from a file in the user's folder for caches or found out now."""
    processor = _processor()
    missing = INSTRUCTIONS - {*processor.get("flags", "").split()}
    if missing:
        return Choice("", f"chosen by OpenBLAS; the processor is not known to have {' and '.join(sorted(missing))}")
    # As `system.environment` has made sure that it can be written.
    folder = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache", "fenics_gears")
    file = folder / "kernels.json"
    key = _key(processor)
    with contextlib.suppress(OSError, ValueError, TypeError, KeyError):
        known = json.loads(file.read_text(encoding="utf-8"))
        if known["key"] == key:
            return Choice(**known["choice"])
    chosen = _measured()
    # Not imported by the process that runs this file as a script.
    from .output import whole_file

    with contextlib.suppress(OSError), whole_file(file) as kept:
        kept.write(json.dumps({"key": key, "choice": asdict(chosen)}).encode())
    return chosen


def _measured() -> Choice:
    libraries = in_another_process(None)
    unsuitable = [each for each in libraries if each["kernels"] not in QUICK or not each["exact"]]
    if not unsuitable:
        return Choice("", "chosen by OpenBLAS")
    one = unsuitable[0]
    wrong = "" if one["exact"] else ", which are wrong"
    what = f"OpenBLAS {one['version']} by itself takes {one['kernels']}'s{wrong}"
    tried = in_another_process(TRIED)
    if tried and all(each["kernels"] == TRIED and each["exact"] for each in tried):
        return Choice(TRIED, f"{what}, but the processor has AVX2 and FMA; integer products are exact")
    return Choice("", f"{what}; it does not take {TRIED}'s, or they are wrong")


def in_another_process(kernels: str | None) -> list[dict]:
    """`libraries` of a process with these kernels, None for those that OpenBLAS takes; none where it fails."""
    environment = {name: value for name, value in os.environ.items() if name != VARIABLE}
    environment |= {"OMP_NUM_THREADS": "1"} | ({VARIABLE: kernels} if kernels else {})
    with contextlib.suppress(OSError, ValueError, subprocess.SubprocessError):
        command = [sys.executable, "-P", __file__]
        done = subprocess.run(command, env=environment, capture_output=True, stdin=subprocess.DEVNULL, timeout=60.0)
        return json.loads(done.stdout)
    return []


def libraries() -> list[dict]:
    """Every OpenBLAS that this program loads: file, version, kernels, threads, and whether its products are exact."""
    import scipy.linalg  # noqa: F401 - may have a library of its own
    from threadpoolctl import ThreadpoolController

    with contextlib.suppress(OSError):
        ctypes.CDLL(SYSTEM_LIBRARY)
    described = []
    for each in ThreadpoolController().lib_controllers:
        if each.internal_api == "openblas":
            told = each.info()
            names = {"file": "filepath", "version": "version", "kernels": "architecture", "threads": "num_threads"}
            described.append({name: told[key] for name, key in names.items()} | {"exact": exact(told["filepath"])})
    return described


def exact(file: str) -> bool:
    """Whether a library's products of small integers, which have no round-off, are exact."""
    import numpy as np

    product, integer = _product(ctypes.CDLL(file))
    numbers = np.random.default_rng(0)
    for rows, columns, inner in SIZES:
        left, right = (numbers.integers(-9, 10, size) for size in ((rows, inner), (inner, columns)))
        for turned in ("NN", "NT", "TN", "TT"):
            given = (each.T if turn == "T" else each for each, turn in zip((left, right), turned))
            first, second = (np.array(each, dtype=float, order="F") for each in given)
            result = np.full((rows, columns), np.nan, order="F")
            sizes = [ctypes.byref(integer(size)) for size in (rows, columns, inner)]
            one, nothing = (ctypes.byref(ctypes.c_double(value)) for value in (1.0, 0.0))
            # Each array with its leading dimension.
            arrays = [
                (each.ctypes.data_as(ctypes.c_void_p), ctypes.byref(integer(len(each))))
                for each in (first, second, result)
            ]
            turns = (turn.encode() for turn in turned)
            product(*turns, *sizes, one, *arrays[0], *arrays[1], nothing, *arrays[2])
            # NumPy multiplies integers without BLAS.
            if not np.array_equal(result, left @ right):
                return False
    return True


def _product(library: ctypes.CDLL):
    """A library's DGEMM and its kind of integers; wheels of NumPy and SciPy give theirs names of their own."""
    for prefix in ("", "scipy_"):
        for suffix, integer in (("", ctypes.c_int32), ("64_", ctypes.c_int64)):
            if hasattr(library, name := f"{prefix}dgemm_{suffix}"):
                return getattr(library, name), integer
    raise OSError("an OpenBLAS without DGEMM")


def _processor() -> dict[str, str]:
    """What the system says of the first processor."""
    with contextlib.suppress(OSError), open(PROCESSORS, encoding="utf-8", errors="replace") as lines:
        pairs = (line.partition(":") for line in takewhile(str.strip, lines))
        return {name.strip(): value.strip() for name, _, value in pairs}
    return {}


def _key(processor: dict[str, str]) -> list:
    told = [processor.get(name) for name in ("vendor_id", "cpu family", "model", "model name", "flags")]
    files = [spec.origin for name in ("numpy", "scipy") if (spec := find_spec(name)) and spec.origin]
    files += [os.path.realpath(file) for each in SYSTEM_FOLDERS if os.path.exists(file := f"{each}/{SYSTEM_LIBRARY}")]
    return [told, sys.executable, *([file, os.stat(file).st_mtime_ns] for file in files)]


if __name__ == "__main__":
    json.dump(libraries(), sys.stdout)
