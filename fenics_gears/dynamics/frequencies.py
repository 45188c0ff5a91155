"""Natural frequencies of the drivetrain with the mesh as a spring along the line of action, and their errors by a time step."""

from __future__ import annotations

from dataclasses import dataclass
from math import atan, inf, pi, sqrt

import numpy as np
from scipy.linalg import eigh, null_space

from fenics_gears.dynamics.drivetrain import Drivetrain

# Relative normal displacement of the flanks per coordinate; see contact.operator.displacement_jacobian. Friction also acts across.
MESH_DIRECTION = {"centre_x1": 1.0, "rotation_1": 1.0, "centre_x2": -1.0, "rotation_2": 1.0}
ACROSS_DIRECTION = {"centre_y1": 1.0, "centre_y2": -1.0}
# Below this part of the highest frequency a motion is rigid; a shape that moves the flanks by less than this part is not excited.
RIGID, STILL = 1e-6, 1e-6
# Average acceleration lengthens a period by (omega dt)^2/12 of it: 1 % where omega dt = 0.346, 18.1 steps a period.
PERIOD_ERROR = 0.01
STEPS_OF_A_RESOLVED_PERIOD = 2.0 * pi / sqrt(12.0 * PERIOD_ERROR)


@dataclass(frozen=True)
class Vibration:
    """One elastic mode: `frequency` (Hz), `damping_ratio` of the critical damping, `excited`: whether contact forces excite it."""

    frequency: float
    damping_ratio: float
    excited: bool

    @property
    def amplification(self) -> float:
        """Response at resonance over the static one; infinite without damping."""
        return 0.5 / self.damping_ratio if self.damping_ratio > 0.0 else inf

    def steps_per_period(self, time_step: float) -> float:
        """Steps of `time_step` (s) in a period."""
        return 1.0 / (self.frequency * time_step)

    def period_error(self, time_step: float) -> float:
        """Part of the period by which average acceleration lengthens it."""
        half_angle = pi * self.frequency * time_step
        return half_angle / atan(half_angle) - 1.0


def natural_frequencies(drivetrain: Drivetrain, mesh_stiffness: float) -> np.ndarray:
    """Natural frequencies (k,), Hz, ascending, of a drivetrain with inertia and a mesh stiffness (N/mm)."""
    return modes(drivetrain, mesh_stiffness)[0]


def vibrations(drivetrain: Drivetrain, mesh_stiffness: float, friction: bool = False) -> list[Vibration]:
    """The elastic modes by frequency; `friction`: whether contact forces also act across the line of action."""
    frequencies, shapes = modes(drivetrain, mesh_stiffness)
    directions = [MESH_DIRECTION, ACROSS_DIRECTION] if friction else [MESH_DIRECTION]
    moved = np.abs([[direction.get(name, 0.0) for name in drivetrain.coordinates] for direction in directions] @ shapes).max(axis=0)
    if np.isinf(mesh_stiffness):
        # Tied flanks do not move apart in any mode; their errors excite every mode.
        moved = np.full(len(frequencies), np.inf)
    damping = np.zeros_like(drivetrain.stiffness) if drivetrain.damping is None else drivetrain.damping
    damped = np.einsum("ci,cd,di->i", shapes, damping, shapes)
    return [
        Vibration(float(frequency), float(0.5 * taken / (2.0 * pi * frequency)), bool(motion > STILL * np.linalg.norm(shape)))
        for frequency, taken, motion, shape in zip(frequencies, damped, moved, shapes.T)
        if frequency > RIGID * frequencies[-1]
    ]


def modes(drivetrain: Drivetrain, mesh_stiffness: float) -> tuple[np.ndarray, np.ndarray]:
    """Natural frequencies (k,), Hz, ascending, and shapes (k, k), one a column, of modal mass 1."""
    normal = np.array([MESH_DIRECTION.get(name, 0.0) for name in drivetrain.coordinates])
    if np.isinf(mesh_stiffness):
        return _tied_modes(drivetrain, normal)
    stiffness = drivetrain.stiffness + mesh_stiffness * np.outer(normal, normal)
    squares, shapes = eigh(stiffness, drivetrain.mass)
    return np.sqrt(np.maximum(squares, 0.0)) / (2.0 * pi), shapes


def _tied_modes(drivetrain: Drivetrain, normal: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The modes (k - 1 of them) of a drivetrain whose flanks are rigid and stay together: nothing moves along `normal` (k,)."""
    free = null_space(normal[None, :])
    if not free.shape[1]:
        return np.empty(0), free
    squares, shapes = eigh(free.T @ drivetrain.stiffness @ free, free.T @ drivetrain.mass @ free)
    return np.sqrt(np.maximum(squares, 0.0)) / (2.0 * pi), free @ shapes
