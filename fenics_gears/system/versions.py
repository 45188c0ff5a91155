"""The processor, and versions of this program, Python and packages."""

import importlib.metadata
import os
import platform
from collections.abc import Sequence
from pathlib import Path

import fenics_gears

PACKAGES = ("numpy", "numba", "fenics-dolfinx", "petsc4py")


def processor() -> str:
    """The name of the processor, and how many of its cores this process may use."""
    name = platform.processor() or platform.machine()
    description = Path("/proc/cpuinfo")
    if description.is_file():
        lines = (line.partition(":") for line in description.read_text(encoding="utf-8", errors="replace").splitlines())
        name = next((value.strip() for label, _, value in lines if label.strip() == "model name"), name)
    usable = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    return f"{name}, {usable} cores"


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
