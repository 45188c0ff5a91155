"""A seat that gives way as a mesh has it, whose frame may be another one than that of the shaft."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from .elastic_shaft import SeatedGear
    from .shaft_system import ShaftSystem


@dataclass(frozen=True, eq=False)
class SeatOfMesh:
    """A gear's `seat` on a shaft of a `system`, the gear being the "pinion" or the "wheel" of a mesh; `turned` (6, 6):
    motions in the frame of the mesh per those in the frame of the shaft."""

    system: ShaftSystem
    seat: SeatedGear
    gear: str
    turned: np.ndarray

    @property
    def of_face(self) -> tuple[str, ...]:
        """Names of the coordinates by which the ends of the face move apart, in the frame of the shaft."""
        return self.system.shaft_of(self.seat).of_face(self.seat)

    def compliance(self, heights: np.ndarray) -> np.ndarray:
        """Motions (h, 6, h, 6) of teeth at `heights` (h,), mm from the gear's middle, per load there, with the
        coordinates of the face held."""
        own = self.system.seat(self.seat).under(self._along(heights)).compliance
        return np.einsum("ai,hikj,bj->hakb", self.turned, own, self.turned)

    def follows(self, heights: np.ndarray) -> np.ndarray:
        """Motions (h, 6, 6) of teeth there per coordinate of the face."""
        return self.turned @ self.system.seat(self.seat).follows(self._along(heights))

    def _along(self, heights: np.ndarray) -> np.ndarray:
        """The same heights along the axis of the shaft."""
        return self.turned[2, 2] * heights
