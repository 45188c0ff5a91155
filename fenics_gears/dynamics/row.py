"""Rotations of gears in a row, the first one's prescribed.

A gear's rotation is counted as the mesh does in which it is driven, and carried as the arc of its base circle (mm). In
the next mesh, whose frame is the mirror image, the same rotation counts the other way.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fenics_gears.geometry.pair import GearPair

from .drivetrain import Drivetrain


@dataclass(frozen=True)
class RowDrivetrain(Drivetrain):
    """Equations of motion of the driven gears; `motions` (f, k): of each mesh the motion of all gears behind it,
    which it alone holds."""

    motions: tuple[tuple[float, ...], ...] = ()

    @property
    def free_motion(self) -> np.ndarray:  # type: ignore[override]
        """The motions of all meshes, (f k,)."""
        return np.array(self.motions).ravel()

    @property
    def free_words(self) -> str:
        torque = 1e-3 * self.load[-1] * self.radii[-1]
        return f"the last gear turns freely under its torque of {torque:.4g} N m"


def rotations_of(pairs: Sequence[GearPair]) -> list[np.ndarray]:
    """Of each mesh, how the arcs (2, k) of its pinion and wheel follow from the coordinates of the row."""
    found = []
    for number, pair in enumerate(pairs):
        rows = np.zeros((2, len(pairs)))
        rows[1, number] = 1.0
        if number:
            rows[0, number - 1] = -pair.base_radii[0] / pairs[number - 1].base_radii[1]
        found.append(rows)
    return found


def row_drivetrain(pairs: Sequence[GearPair], output_torque: float) -> RowDrivetrain:
    """The gears of a row under a torque (N mm) on the last one."""
    count = len(pairs)
    radii = np.array([pair.base_radii[1] for pair in pairs])
    load = np.zeros(count)
    load[-1] = output_torque / radii[-1]
    motions = []
    for first in range(count):
        motion = np.zeros(count)
        turned = 1.0
        for number in range(first, count):
            turned *= pairs[number].rotation_ratio if number > first else 1.0
            motion[number] = radii[number] * turned
        motions.append(tuple(motion / np.linalg.norm(motion)))
    names = tuple(f"rotation_{number + 2}" for number in range(count))
    nothing = np.zeros((count, count))
    return RowDrivetrain(names, radii, nothing, load, None, None, motions=tuple(motions))


def drivetrain_of_mesh(pair: GearPair, wheel_torque: float) -> Drivetrain:
    """Both gears of one mesh of a row, whose rotations follow from those of all gears."""
    radii = np.array(pair.base_radii)
    load = np.array([0.0, wheel_torque]) / radii
    return Drivetrain(("rotation_1", "rotation_2"), radii, np.zeros((2, 2)), load, None, None)
