"""The flank compliance of a gear over its face."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from .compliance import FlankCompliance

if TYPE_CHECKING:
    from .face.free_end import FreeEnds
    from .face.near_field import NearField


@dataclass(frozen=True)
class FaceCompliance:
    """Displacement of drive-flank nodes per unit force on drive-flank nodes over a gear's face, hub held.

    roll_angle: (n,), rad, increasing, of the flank nodes of a section. element_order: of the displacement along a flank
    element, and along the face. heights: (h,), mm from the gear's mid-width, increasing, of the nodes of the layers.
    blocks: (offsets + 1, 3 n h, 3 n h), mm/N: blocks[m] is the displacement of the flank m pitches ahead
    (counter-clockwise) of the loaded one. Dofs by height, then flank node, then component (x, y, z) in the tooth's own
    frame at that height. plane: the plane-strain compliance of the section's mesh. seat: (h, 6, h, 6), mm, rad, N,
    compliance of the axis of a gear that is cut into its shaft; None where the hub is rigid. Its motions are x, y, z,
    tilts about x and y, and turn. near: what the layers leave out near a load; None where nothing is. ends: how
    flanks give way beside the ends of the face; None where they do as elsewhere.
    """

    roll_angle: np.ndarray
    element_order: int
    heights: np.ndarray
    blocks: np.ndarray
    plane: FlankCompliance
    timings: dict = field(default_factory=dict, compare=False)
    flanks: int = 1
    seat: np.ndarray | None = field(default=None, compare=False)
    near: NearField | None = field(default=None, compare=False)
    ends: FreeEnds | None = field(default=None, compare=False)

    @property
    def offsets(self) -> int:
        """Largest distance, in pitches, between two teeth whose interaction is known."""
        return len(self.blocks) - 1

    @property
    def of_drive_flanks(self) -> FaceCompliance:
        """That of drive flanks alone."""
        if self.flanks == 1:
            return self
        half = self.plane.blocks.shape[1] // 2
        plane = replace(self.plane, blocks=np.ascontiguousarray(self.plane.blocks[:, :half, :half]), flanks=1)
        half = self.blocks.shape[1] // 2
        blocks = np.ascontiguousarray(self.blocks[:, :half, :half])
        near = None if self.near is None else self.near.of_flanks(slice(1))
        return replace(self, blocks=blocks, plane=plane, near=near, flanks=1)


@dataclass(frozen=True)
class BetweenMates:
    """How flanks of a gear that different mates load feel each other through its body: `motions` (f, r) of the dofs of
    a drive flank and, where they are loaded, of a coast flank, dofs as of a FaceCompliance. `known`, by the kinds of
    both flanks, 0 drive and 1 coast: a distance in pitches, and mm/N (k, r, r') of the one flank so many and more
    pitches ahead of the loaded other one; of like flanks the shorter way round the gear."""

    motions: tuple[np.ndarray, ...]
    known: dict[tuple[int, int], tuple[int, np.ndarray]]


@dataclass(frozen=True)
class SharedCompliance:
    """The body of a gear that several mates load: of its drive `flanks` and, where they are loaded, of its coast flanks
    as the drive flanks of its mirror image, in which heights stay; where a mate loads flanks of both kinds, either with
    its coast flanks. And what is `between` flanks of different mates."""

    flanks: tuple[FaceCompliance, ...]
    between: BetweenMates
