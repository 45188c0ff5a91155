"""Flank compliance of a gear whose teeth are not all alike."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import ClassVar

import numpy as np

from fenics_gears.errors import ComputationError


@dataclass(frozen=True)
class WholeBodyCompliance:
    """Displacement of drive-flank nodes per unit line force on drive-flank nodes of every tooth, hub ring held.

    Teeth are counted counter-clockwise from `first`. roll_angles: of each tooth's flank nodes (n,), rad, increasing.
    element_order: 1 or 2. blocks: blocks[t][m] (2n', 2n), mm per N/mm (plane strain, unit thickness), is the
    displacement of the flank m pitches ahead of tooth t under forces on tooth t. Dofs are as in `FlankCompliance`.
    openings: of a body with cracks, by the loaded tooth within `offsets` of one, (k, 2n), mm per N/mm: how far the
    faces are moved apart at k places.
    """

    roll_angles: tuple[np.ndarray, ...]
    element_order: int
    blocks: tuple[tuple[np.ndarray, ...], ...]
    openings: dict[int, np.ndarray] = field(default_factory=dict)
    timings: dict = field(default_factory=dict, compare=False)
    flanks: int = 1
    first: int = 0
    alike: ClassVar[bool] = False

    def counted_from(self, tooth: int) -> WholeBodyCompliance:
        """The same body, whose tooth of that number is called 0."""
        return replace(self, first=self.first + tooth)

    @property
    def teeth(self) -> int:
        """Number of teeth."""
        return len(self.roll_angles)

    @property
    def offsets(self) -> int:
        """Largest distance, in pitches, between two teeth whose interaction is known."""
        return len(self.blocks[0]) - 1

    def between(self, responding: int, loaded: int, sides: tuple[int, int] = (0, 0)) -> np.ndarray:
        """As of `compliance.BetweenFlanks`; raises ComputationError for coast flanks, and for teeth further apart than
        `offsets`."""
        if any(sides):
            raise ComputationError(
                "flank compliance: of a gear that is meshed as a whole only the drive flanks are known"
            )
        own, other = self.key(responding, loaded)
        ahead = (own - other) % self.teeth
        if ahead <= self.offsets:
            return self.blocks[other][ahead]
        if self.teeth - ahead <= self.offsets:
            return self.blocks[own][self.teeth - ahead].T
        raise ComputationError(
            f"flank compliance: teeth {own} and {other} are further apart than the"
            f" {self.offsets} pitches that were computed; ask whole_body_compliance for more tooth_offsets"
        )

    def rolls_of(self, tooth: int) -> np.ndarray:
        """As of `compliance.FlankBody`."""
        return self.roll_angles[(self.first + tooth) % self.teeth]

    def key(self, responding: int, loaded: int) -> tuple[int, int]:
        """As of `compliance.BetweenFlanks`: both teeth, which repeat after a turn."""
        return (self.first + responding) % self.teeth, (self.first + loaded) % self.teeth
