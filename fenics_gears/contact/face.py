"""The face of a gear pair, cut into slices across the axes: the place of each, and how far its mesh is ahead of the
middle one's. In the plane there is one slice."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import sqrt

import numpy as np

from fenics_gears.geometry.side import Side


@dataclass(frozen=True, eq=False)
class Face:
    """Slices of the common face: `positions` of their middles and `widths` (S,), mm; z runs along the axes from the
    middle of the common face.

    `slope`: mm along the path of contact per mm of z: the tangent of the base helix angle, positive for a right-hand
    pinion. `middles` (mm): of the faces of pinion and wheel.
    """

    positions: np.ndarray
    widths: np.ndarray
    slope: float = 0.0
    middles: tuple[float, float] = (0.0, 0.0)

    @property
    def slices(self) -> int:
        """Number of slices."""
        return len(self.positions)

    @cached_property
    def evenly(self) -> int:
        """Number of slices without the cuts of the outermost ones: that `[accuracy]` speaks of."""
        return round(float(self.widths.sum() / self.widths.max()))

    @cached_property
    def cosine(self) -> float:
        """Cosine of the base helix angle: between the contact normal and the transverse plane."""
        return 1.0 / sqrt(1.0 + self.slope**2)

    @cached_property
    def contact_widths(self) -> np.ndarray:
        """Length (S,), mm, of the line of contact in each slice."""
        return self.widths / self.cosine

    @cached_property
    def shifts(self) -> np.ndarray:
        """Distance (S,), mm, along the path of contact by which each slice is ahead of the middle of the face."""
        return self.slope * self.positions

    @cached_property
    def outermost_shifts(self) -> tuple[float, ...]:
        """Least and largest of the shifts; one where all are alike."""
        return tuple(sorted({float(self.shifts.min()), float(self.shifts.max())}))

    def axial_share(self, side: Side, turn: float) -> float:
        """Axial component of the contact normal in the tooth frame of the gear of a side; `turn`: as of a Place."""
        return -turn * side.sense * self.slope * self.cosine


def one_slice(width: float) -> Face:
    """The face (mm) of flanks that are alike along the axes."""
    return Face(np.zeros(1), np.array([width]))


def even_slices(width: float, slices: int) -> tuple[np.ndarray, np.ndarray]:
    """Positions and widths (S,), mm, of slices of one width over a face.

    >>> even_slices(3.0, 3)[0].tolist()
    [-1.0, 0.0, 1.0]
    """
    size = width / slices
    return size * (np.arange(slices) - 0.5 * (slices - 1)), np.full(slices, size)


def finer_ends(positions: np.ndarray, widths: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The same with either outermost slice cut in two.

    >>> [values.tolist() for values in finer_ends(*even_slices(12.0, 3))]
    [[-5.0, -3.0, 0.0, 3.0, 5.0], [2.0, 2.0, 4.0, 2.0, 2.0]]
    """
    ends = positions[[0, 0, -1, -1]] + 0.25 * widths[0] * np.array([-1.0, 1.0, -1.0, 1.0])
    half = [0.5 * widths[0]] * 2
    return np.concatenate([ends[:2], positions[1:-1], ends[2:]]), np.concatenate([half, widths[1:-1], half])
