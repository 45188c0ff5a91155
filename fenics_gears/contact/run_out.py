"""Gaps of eccentric gears: their base circles are carried around their axes.

A gear whose base circle is displaced by c stays an involute gear: to first order in c its flanks move by c along their
normal, the direction of the line of action on which they touch. Coast flanks have their own line of action: they
lose what drive flanks gain only where both directions are opposite. The change of the pressure angle is of second order
and left out.
"""

from __future__ import annotations

from math import cos, pi, sin

import numpy as np

from fenics_gears.geometry.pair import GearPair

from .eccentricity import Eccentricity, Offset
from .kinematics import normals
from .mesh_cycle import PerPosition
from .operator import Position


class RunOut:
    """Gaps (n,), mm, that eccentricity adds at a step and its position; `steps` of a mesh cycle."""

    def __init__(self, pair: GearPair, eccentricity: Eccentricity, steps: int):
        self._steps = steps
        # The pinion turns counter-clockwise, the wheel clockwise.
        self._offsets = [
            (offset, sense, gear.teeth)
            for offset, sense, gear in ((eccentricity.pinion, 1.0, pair.pinion), (eccentricity.wheel, -1.0, pair.wheel))
            if offset is not None
        ]
        # Direction (n, 2) of each node's line of action in space, from pinion to wheel.
        self._normals = PerPosition(lambda position: normals(position.operator.pairs))

    def __call__(self, step: float, position: Position) -> np.ndarray:
        """The additional gaps (n,), mm, positive when they open."""
        across, along = 0.0, 0.0
        for offset, sense, teeth in self._offsets:
            x, y = displacement(offset, sense, 2.0 * pi * step / (self._steps * teeth))
            # What brings the pinion nearer along the normal closes, what takes the wheel away opens.
            along, across = along - sense * x, across - sense * y
        normal_x, normal_y = self._normals(position).T
        return normal_x * along + normal_y * across


def displacement(offset: Offset, sense: float, turned: float) -> tuple[float, float]:
    """Centre of a base circle from its axis (x along the line of action, y across it), mm, when the gear has turned by
    `turned` (rad)."""
    angle = sense * (turned + offset.phase)
    return offset.distance * cos(angle), offset.distance * sin(angle)
