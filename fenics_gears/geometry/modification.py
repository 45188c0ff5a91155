"""Departures from the involute that all teeth of a gear share."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Removals:
    """Several effects that take material from one flank."""

    parts: tuple

    def __call__(self, roll_angle) -> np.ndarray:
        """Removal (mm) at roll angles (rad, any shape) by all of them together."""
        return sum(part(roll_angle) for part in self.parts)
