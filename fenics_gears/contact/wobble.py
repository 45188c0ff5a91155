"""Gaps of gears whose teeth wobble: the axis of the teeth is tilted against the axis of rotation and is carried around
it.

To first order a flank moves with its gear's tilt, which turns with the gear; the gap opens by less than the contact
operator's own rows of tilts close it.
"""

from __future__ import annotations

from math import cos, pi, sin

import numpy as np

from fenics_gears.geometry.pair import GearPair

from .eccentricity import Eccentricity
from .kinematics import COORDINATES, displacement_jacobian
from .mesh_cycle import PerPosition
from .operator import Position
from .run_out import RunOut

TILTS = [[COORDINATES.index(f"tilt_{direction}{gear}") for direction in "xy"] for gear in (1, 2)]


class WobblingRunOut(RunOut):
    """Gaps (n,), mm along the line of action, that eccentricity and wobble add at a step and its position over a face;
    `steps` of a mesh cycle."""

    def __init__(self, pair: GearPair, eccentricity: Eccentricity, steps: int):
        super().__init__(pair, eccentricity, steps)
        gears = ((eccentricity.pinion, 1.0, pair.pinion, 0), (eccentricity.wheel, -1.0, pair.wheel, 1))
        self._wobbles = [
            # As an arc length, like the coordinate.
            (
                offset.wobble / pair.face_widths[number] * gear.base_radius,
                offset.wobble_phase,
                sense,
                gear.teeth,
                TILTS[number],
            )
            for offset, sense, gear, number in gears
            if offset is not None and offset.wobble
        ]
        self._rows = PerPosition(_rows)

    def __call__(self, step: float, position: Position) -> np.ndarray:
        """The additional gaps (n,), mm, positive when they open."""
        gap, rows = super().__call__(step, position), self._rows(position)
        for size, phase, sense, teeth, columns in self._wobbles:
            angle = sense * (2.0 * pi * step / (self._steps * teeth) + phase)
            # The axis leans by (cos, sin) of the angle in x and y towards the right end: it is tilted about (-sin,
            # cos).
            gap = gap - size * (rows[:, columns[1]] * cos(angle) - rows[:, columns[0]] * sin(angle))
        return gap


def _rows(position: Position) -> np.ndarray:
    """How each node's flanks approach along the line of action by each coordinate (n, 13)."""
    operator = position.operator
    along_normal = displacement_jacobian(
        operator.pairs, operator.base_radii, operator.normal_lever_arms, False, face=operator.face
    )
    return along_normal / operator.face.cosine
