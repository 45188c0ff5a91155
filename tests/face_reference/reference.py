"""Results of a resolved three-dimensional model, the rows of reference.csv.

Whole sections without the teeth far from the loaded ones, swept along the helix in eighteen-node wedges (0.08 mm at the
flanks), bores held; contact on a grid of pressures across the line of action (0.05 mm) and along the face,
frictionless, forces along n. No code of the program's compliance was used but its call of MUMPS. In the plane (spur,
phase 0.35) it gives 0.03 % less approach than the program's plane route; two levels of meshes differ by 0.1 % (plain)
to 0.5 % (misaligned) in the approach. Peak pressures are not resolved.
"""

from __future__ import annotations

import csv
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from tests.face_reference.cases import FACE_WIDTH

FILE = Path(__file__).with_name("reference.csv")
# What opens the flanks along n (mm) at heights z (mm).
OPENINGS = {
    "plain": np.zeros_like,
    "misaligned": lambda z: 0.010 * z / FACE_WIDTH,
    "crowned": lambda z: 0.010 * (2.0 * z / FACE_WIDTH) ** 2,
}


@dataclass(frozen=True)
class Row:
    """Line load (N per mm of face, along n) of a tooth pair at height `z` (mm); `approach` (mm, along the transverse
    line of action), `force` (N, of all pairs, along n) and `peak_pressure` (MPa) of the analysis."""

    helix_angle: float
    phase: float
    opening: str
    approach: float
    force: float
    peak_pressure: float
    pair: int
    z: float
    line_load: float


HEAD = {name: {"opening": str, "pair": int}.get(name, float) for name in list(Row.__annotations__)[:-2]}


def reference() -> list[Row]:
    """The rows of the file."""
    found = []
    with FILE.open() as lines:
        for line in csv.DictReader(lines):
            along = zip(line["z"].split(), line["line_load"].split())
            head = {name: kind(line[name]) for name, kind in HEAD.items()}
            found += [Row(**head, z=float(z), line_load=float(load)) for z, load in along]
    return found


def over_slices(found: list[Row], positions: np.ndarray) -> np.ndarray:
    """Line load (S,), N/mm, of all tooth pairs together, straight between the heights of one analysis and averaged over
    slices of one width at `positions` (S,), mm."""
    z = np.array(sorted({row.z for row in found}))
    load = np.array([sum(row.line_load for row in found if row.z == each) for each in z])
    parts = (np.arange(100) + 0.5) / 100.0 - 0.5
    return np.interp(positions[:, None] + (positions[1] - positions[0]) * parts, z, load).mean(axis=1)
