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

    @property
    def kinks(self) -> tuple[float, ...]:
        """Those of all parts."""
        return tuple(roll for part in self.parts for roll in part.kinks)


def kinks(removal) -> tuple[float, ...]:
    """Roll angles (rad) at which a removal, None for no removal, leaves the flank with a kink."""
    return () if removal is None else removal.kinks
