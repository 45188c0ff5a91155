"""Material removed from the involute by several effects, alike on all teeth of a gear."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Removals:
    """The removals of several effects from one flank."""

    parts: tuple

    def __call__(self, roll_angle) -> np.ndarray:
        """Removal (mm) at roll angles (rad, any shape) by all of them together."""
        return sum(part(roll_angle) for part in self.parts)
