"""A seat that gives way as a mesh has it, whose frame may be another one than that of the shaft."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from fenics_gears.geometry.pair import GearPair

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

    def radii_of_face(self, pair: GearPair) -> np.ndarray:
        """mm per rad or mm of these coordinates (6,), rotations among them being arcs of the base circle."""
        radius = getattr(pair, self.gear).base_radius
        return np.array([radius if name.startswith(("face_tilt", "face_turn")) else 1.0 for name in self.of_face])

    @property
    def stiffness_of_face(self) -> np.ndarray:
        """Of shaft and bearings over these coordinates, in N, mm and rad."""
        own = [self.system.coordinates.index(name) for name in self.of_face]
        return self.system.stiffness[np.ix_(own, own)]

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
