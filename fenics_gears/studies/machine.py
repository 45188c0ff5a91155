"""What `gears accuracy` and `gears effects` share: the machine on which times were measured, and the CSV file of the
numbers."""

import csv
import importlib.metadata
import os
import platform
from collections.abc import Mapping, Sequence
from pathlib import Path

import fenics_gears

PACKAGES = ("numpy", "numba", "fenics-dolfinx", "petsc4py")


def machine() -> dict[str, str]:
    return {
        "processor": processor(),
        "load": load(),
        "threads": "1 in the march, " + threads() + " elsewhere",
        "versions": versions(),
    }


def in_words(machine: Mapping[str, str]) -> str:
    return f"{machine['processor']}, load {machine['load']}; threads: {machine['threads']}; {machine['versions']}"


def processor() -> str:
    name = platform.processor() or platform.machine()
    description = Path("/proc/cpuinfo")
    if description.is_file():
        lines = (line.partition(":") for line in description.read_text(encoding="utf-8", errors="replace").splitlines())
        name = next((value.strip() for label, _, value in lines if label.strip() == "model name"), name)
    usable = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    return f"{name}, {usable} cores"


def load() -> str:
    """Processes that wanted a core in the last minute, this one included."""
    try:
        return f"{os.getloadavg()[0]:.1f}"
    except OSError:
        return "unknown"


def threads() -> str:
    from threadpoolctl import threadpool_info

    counts = [pool["num_threads"] for pool in threadpool_info() if pool["user_api"] == "blas"]
    return str(max(counts, default=1))


def versions(packages: Sequence[str] = PACKAGES) -> str:
    """Versions of this program, Python and packages, those that compute unless others are named; one that is not
    installed is left out."""
    named = [f"fenics_gears {fenics_gears.__version__}", f"Python {platform.python_version()}"]
    for package in packages:
        try:
            named.append(f"{package.removeprefix('fenics-')} {importlib.metadata.version(package)}")
        except importlib.metadata.PackageNotFoundError:
            continue
    return ", ".join(named)


def write_lines(file: Path, lines: Sequence[Mapping[str, object]], machine: Mapping[str, str]) -> None:
    """Write a line for each of `lines` to a CSV file, each with the machine's words; a name that a line lacks is empty
    in it."""
    columns = dict.fromkeys(name for line in (*lines, machine) for name in line)
    with open(file, "w", encoding="utf-8", newline="") as opened:
        writer = csv.DictWriter(opened, list(columns), restval="")
        writer.writeheader()
        writer.writerows({**line, **machine} for line in lines)
