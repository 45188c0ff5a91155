"""The flank compliance of a gear over its face."""

from __future__ import annotations

from dataclasses import dataclass, field
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


@dataclass(frozen=True)
class AcrossFlanks:
    """How drive and coast flanks of a gear feel each other through its body: motions (f, r) of a drive flank's dofs and
    (f, r') of a coast flank's, dofs as of a FaceCompliance; `between` (k, r, r'), mm/N: of a drive flank `first` and
    more pitches ahead of a loaded coast flank."""

    drive: np.ndarray
    coast: np.ndarray
    between: np.ndarray
    first: int


@dataclass(frozen=True)
class IdlerCompliance:
    """The body of a gear that one mate loads on its `drive` flanks and another one on its `coast` flanks: of the latter
    as the drive flanks of its mirror image, in which heights stay; and what is `across`."""

    drive: FaceCompliance
    coast: FaceCompliance
    across: AcrossFlanks
