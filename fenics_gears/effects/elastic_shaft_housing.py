"""The housing that the bearings of a shaft with sections are seated in: a stiffness matrix from a text file, as finite
element programs export it. Not an effect by itself."""

from __future__ import annotations

import os
import re
from dataclasses import replace
from hashlib import sha256
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from fenics_gears.dynamics.shafts import HousingFile
from fenics_gears.errors import SceneError
from fenics_gears.inputs.allowed import AllowedMatrix, Matrix, Refused
from fenics_gears.inputs.written import as_written
from fenics_gears.system import user_file

# Of a seat: displacements along x, y, z and rotations about them.
OF_A_SEAT = 6
ABOUT_Z = 5
COMMENTS = ("#", "%", "!", "*")
# Part of the largest entry that the digits of a file may be off by.
ROUNDING = 1e-6


Housed = TypeVar("Housed", bound=Any)


def located_housing(housed: Housed, directory: Path) -> Housed:
    """Shafts, or one, with the matrix of their `housing`, whose file is looked for from a directory on."""
    if housed.housing is None:
        return housed
    return replace(housed, housing=located(housed.housing, directory))


def located(named: HousingFile, directory: Path) -> HousingFile:
    """A file with its matrix, or with the problem with it: `check` says what is wrong; a scene that is only looked at
    needs no file."""
    path = os.path.realpath(directory / named.path)
    try:
        text = user_file.text_of(Path(path), user_file.LARGEST_SCENE)
        stiffness = _matrix_in(text)
        problem = ""
    except (user_file.Unreadable, Refused) as refused:
        text = ""
        stiffness = None
        problem = str(refused)
    return HousingFile(path, sha256(text.encode()).hexdigest(), stiffness, problem)


def _matrix_in(text: str) -> Matrix:
    """The matrix whose rows are lines of numbers, parted by blanks, commas or semicolons. Raises Refused."""
    lines = [line.strip() for line in text.splitlines()]
    rows: list[list[float]] = []
    for number, line in enumerate(lines, 1):
        if line and not line.startswith(COMMENTS):
            try:
                # Fortran writes exponents with a D.
                rows.append([float(each.replace("D", "E")) for each in re.split(r"[\s,;]+", line.strip(",;"))])
            except ValueError:
                raise Refused(f"line {number} is not of numbers alone.") from None
    if not rows:
        raise Refused("has no numbers.")
    allowed = AllowedMatrix(description="", size=len(rows), meaning="", round_off=ROUNDING)
    return allowed.convert(rows)


def check_housing(housing: HousingFile | None, field: str, bearings: int, of_both: int = 0) -> None:
    """Raise SceneError where the matrix in a field of the scene cannot be read, or is not of so many seats; `of_both`:
    how many both shafts have."""
    if housing is None:
        return
    size = OF_A_SEAT * bearings
    problem = housing.problem
    rows = len(housing.stiffness or ())
    if not problem and rows != size:
        problem = f"has {rows} rows for {bearings} bearings; allowed are {size}: six motions of each seat"
        if rows == OF_A_SEAT * of_both:
            problem += ". A housing that both shafts are seated in is the housing of [shafts]"
    if problem:
        raise SceneError(f"{field} = {as_written(housing.path)}: {problem}")


def stiffness_of_seats(housing: HousingFile | None) -> Matrix | None:
    """The stiffness over x, y, z and the tilts about x and y of each seat, which turns freely about z: bearings pass no
    moment on about it."""
    if housing is None or housing.stiffness is None:
        return None
    whole = np.array(housing.stiffness)
    free = np.arange(len(whole)) % OF_A_SEAT == ABOUT_Z
    beside = whole[np.ix_(~free, free)]
    passed = beside @ np.linalg.pinv(whole[np.ix_(free, free)]) @ beside.T
    return tuple(map(tuple, whole[np.ix_(~free, ~free)] - passed))
