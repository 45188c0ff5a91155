"""Kernels of OpenBLAS that suit the processor.

An OpenBLAS that is older than the processor takes kernels of 2004, which condense at half the speed. It reads
OPENBLAS_CORETYPE when it is loaded. Which kernels it takes by itself, a process of its own finds out once for a
processor and its libraries; run as a script, this file is that process.
"""

import contextlib
import ctypes
import functools
import json
import os
import subprocess
import sys
from importlib.util import find_spec
from itertools import takewhile
from pathlib import Path

VARIABLE = "OPENBLAS_CORETYPE"
PROCESSORS = Path("/proc/cpuinfo")
# Kernels that use these instructions are quick.
INSTRUCTIONS = {"avx2", "fma"}
QUICK = {"Haswell", "Excavator", "Zen", "SkylakeX", "Cooperlake", "SapphireRapids"}
# Those to take where OpenBLAS does not know the processor, by the instructions that they need, the quickest first: a
# product takes 0.6 of the time with the first.
TRIED = {"SkylakeX": {"avx512f", "avx512cd", "avx512bw", "avx512dq", "avx512vl"}, "Haswell": INSTRUCTIONS}
# The system's BLAS, which PETSc and MUMPS use also where NumPy and SciPy have libraries of their own.
SYSTEM_LIBRARY = "libblas.so.3"
SYSTEM_FOLDERS = ("/usr/lib/x86_64-linux-gnu", "/usr/lib64", "/usr/lib")


def choose(environment) -> None:
    """Set OPENBLAS_CORETYPE where OpenBLAS would take slow kernels, unless the user has set it or NumPy is loaded."""
    if VARIABLE not in environment and "numpy" not in sys.modules and takes_slow_kernels():
        environment[VARIABLE] = kernels_for(_flags())


def kernels_for(flags: set[str]) -> str:
    """Kernels for a processor of these flags, INSTRUCTIONS among them."""
    return next(kernels for kernels, needed in TRIED.items() if needed <= flags)


@functools.cache
def takes_slow_kernels() -> bool:
    """Whether OpenBLAS by itself takes kernels that do not suit this processor, from a file in the user's folder for
    caches or found out now."""
    processor = _processor()
    if not INSTRUCTIONS <= _flags():
        return False
    # As `system.environment` has made sure that it can be written.
    folder = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache", "fenics_gears")
    file = folder / "kernels.json"
    key = _key(processor)
    with contextlib.suppress(OSError, ValueError, TypeError, KeyError):
        known = json.loads(file.read_text(encoding="utf-8"))
        if known["key"] == key:
            return bool(known["slow"])
    slow = any(each["kernels"] not in QUICK for each in in_another_process())
    # Not imported by the process that runs this file as a script.
    from .output import whole_file

    with contextlib.suppress(OSError), whole_file(file) as kept:
        kept.write(json.dumps({"key": key, "slow": slow}).encode())
    return slow


def in_another_process() -> list[dict]:
    """`libraries` of a process that leaves OpenBLAS to itself; none where it fails."""
    environment = {name: value for name, value in os.environ.items() if name != VARIABLE} | {"OMP_NUM_THREADS": "1"}
    with contextlib.suppress(OSError, ValueError, subprocess.SubprocessError):
        command = [sys.executable, "-P", __file__]
        done = subprocess.run(command, env=environment, capture_output=True, stdin=subprocess.DEVNULL, timeout=60.0)
        return json.loads(done.stdout)
    return []


def libraries() -> list[dict]:
    """Every OpenBLAS that this program loads: file, version, kernels, threads."""
    import scipy.linalg  # noqa: F401 - may have a library of its own
    from threadpoolctl import ThreadpoolController

    with contextlib.suppress(OSError):
        ctypes.CDLL(SYSTEM_LIBRARY)
    described = []
    for each in ThreadpoolController().lib_controllers:
        if each.internal_api == "openblas":
            told = each.info()
            names = {"file": "filepath", "version": "version", "kernels": "architecture", "threads": "num_threads"}
            described.append({name: told[key] for name, key in names.items()})
    return described


def _processor() -> dict[str, str]:
    """What the system says of the first processor."""
    with contextlib.suppress(OSError), open(PROCESSORS, encoding="utf-8", errors="replace") as lines:
        pairs = (line.partition(":") for line in takewhile(str.strip, lines))
        return {name.strip(): value.strip() for name, _, value in pairs}
    return {}


def _flags() -> set[str]:
    return {*_processor().get("flags", "").split()}


def _key(processor: dict[str, str]) -> list:
    told = [processor.get(name) for name in ("vendor_id", "cpu family", "model", "model name", "flags")]
    files = [spec.origin for name in ("numpy", "scipy") if (spec := find_spec(name)) and spec.origin]
    files += [os.path.realpath(file) for each in SYSTEM_FOLDERS if os.path.exists(file := f"{each}/{SYSTEM_LIBRARY}")]
    return [told, sys.executable, *([file, os.stat(file).st_mtime_ns] for file in files)]


if __name__ == "__main__":
    json.dump(libraries(), sys.stdout)
