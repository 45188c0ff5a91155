"""Gaps of gears that run out: their base circles are eccentric, or the axis of their teeth wobbles.

A gear whose base circle is displaced by c stays an involute gear: to first order in c its flanks move by c along their
normal, the direction of the line of action on which they touch. Coast flanks have their own line of action: they
lose what drive flanks gain only where both directions are opposite. The change of the pressure angle is of second order
and left out. Likewise flanks move with the tilt of the axis of their teeth.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from fenics_gears.geometry.pair import GearPair
from fenics_gears.geometry.side import Side

from .eccentricity import Eccentricity, Offset
from .kinematics import COLUMNS, COORDINATES, displacement_jacobian
from .mesh_cycle import PerPosition
from .operator import Position


class RunOut:
    """Gaps (n,), mm along the line of action, that eccentricity and wobble add at a step and its position; `steps` of a
    mesh cycle."""

    def __init__(self, pair: GearPair, eccentricity: Eccentricity, steps: int):
        self._steps = steps
        each = zip(pair.sides, eccentricity.of_gears, pair.face_widths)
        self._gears = [(side, offset, width) for side, offset, width in each if offset is not None]
        self.rows = PerPosition(_rows)

    def __call__(self, step: float, position: Position) -> np.ndarray:
        """The additional gaps (n,), mm, positive when they open."""
        return -self.rows(position) @ self.motion(step)

    def motion(self, steps: float | np.ndarray) -> np.ndarray:
        """How both gears' teeth stand beside their axes at a step (13,) or at many (s, 13); `rows` (n, 13) at a
        position say what that closes."""
        motion = np.zeros((*np.shape(steps), len(COORDINATES)))
        for side, offset, width in self._gears:
            motion[..., COLUMNS[side.number]] = run_out(side, offset, width, steps / self._steps)
        return motion

    @staticmethod
    def of_runs(run_outs: Sequence[RunOut], steps: np.ndarray) -> Callable[[Position, slice], np.ndarray]:
        """The gaps (r, s, n) of runs with these in one mesh, at a position and those of the steps that are there."""
        motions = np.array([each.motion(steps) for each in run_outs])
        # Of one mesh all have the same rows.
        return lambda position, there: -(motions[:, there] @ run_outs[0].rows(position).T)


def run_out(side: Side, offset: Offset, width: float, cycles: float | np.ndarray) -> np.ndarray:
    """Displacement, mm, and tilt, mm as arc lengths, of a gear's teeth on its axis after some mesh cycles, in the order
    of `kinematics.MOTIONS` (..., 6); `width` (mm): of its face."""
    turned = side.turn * cycles
    angle = turned + side.turning * offset.phase
    leaning = turned + side.turning * offset.wobble_phase
    # The axis leans by (cos, sin) towards the right end: it is tilted about (-sin, cos).
    tilt = offset.wobble / width * side.gear.base_radius
    none = np.zeros_like(angle)
    centre = offset.distance * np.cos(angle), offset.distance * np.sin(angle), none
    return np.stack([*centre, -tilt * np.sin(leaning), tilt * np.cos(leaning), none], axis=-1)


def _rows(position: Position) -> np.ndarray:
    """How each node's flanks approach along the line of action by each coordinate (n, 13)."""
    operator = position.operator
    return displacement_jacobian(operator.lines, False) / operator.face.cosine
