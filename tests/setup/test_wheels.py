"""The wheels of setup/*.pip, which pip does not resolve, fit each other and what Debian has."""

import platform
from importlib import metadata
from pathlib import Path

import numpy
import pytest
from packaging.requirements import Requirement

SETUP = Path(__file__).parents[2] / "setup"


def wheels(suite):
    lines = (SETUP / f"{suite}.pip").read_text().splitlines()
    return dict(line.split("==") for line in lines if not line.startswith("#"))


def here():
    """Skips the test where all comes from Debian."""
    try:
        suite = platform.freedesktop_os_release().get("VERSION_CODENAME", "")
    except OSError:
        suite = ""
    if not (SETUP / f"{suite}.pip").exists():
        pytest.skip(f"{suite or 'this system'} needs no wheels")
    found = wheels(suite)
    if any(_installed(name) != version for name, version in found.items()):
        pytest.skip("this Python is not the one that setup/install makes")
    return found


def _installed(name):
    try:
        return metadata.version(name)
    except metadata.PackageNotFoundError:
        return None


@pytest.mark.parametrize("suite", [path.stem for path in SETUP.glob("*.pip")])
def test_no_wheel_brings_what_dolfinx_is_built_on(suite):
    """DOLFINx, petsc4py and mpi4py are compiled against Debian's numpy and MPI."""
    assert not {"numpy", "scipy", "mpi4py", "petsc4py", "h5py", "numba", "fenics-dolfinx"} & wheels(suite).keys()


def test_what_the_wheels_require_is_there():
    """Each wheel's own metadata."""
    wanting = []
    for wheel in here():
        for requirement in map(Requirement, metadata.requires(wheel) or ()):
            if requirement.marker and not requirement.marker.evaluate({"extra": ""}):
                continue
            version = _installed(requirement.name)
            if version is None or not requirement.specifier.contains(version, prereleases=True):
                wanting.append(f"{wheel} wants {requirement}, there is {version}")
    assert wanting == []


def test_the_one_numpy_is_debians():
    """Where Debian puts its modules."""
    here()
    assert Path(numpy.__file__).is_relative_to("/usr/lib/python3/dist-packages")
