"""Natural frequencies of the drivetrain with the mesh as a spring along the line of action, and their errors by a time
step."""

from __future__ import annotations

from dataclasses import dataclass
from math import atan, inf, pi, sqrt

import numpy as np
from scipy.linalg import eigh, null_space

from fenics_gears.inputs.tree import GEARS

from .drivetrain import Drivetrain, gear_of

# Below this part of the highest frequency a motion is rigid; a shape that moves the flanks by less than this part is
# not excited.
RIGID, STILL = 1e-6, 1e-6
# Average acceleration lengthens a period by (omega dt)^2/12 of it: 1 % where omega dt = 0.346, 18.1 steps a period.
PERIOD_ERROR = 0.01
STEPS_OF_A_RESOLVED_PERIOD = 2.0 * pi / sqrt(12.0 * PERIOD_ERROR)


@dataclass(frozen=True)
class Vibration:
    """One elastic mode: `frequency` (Hz), `damping_ratio` of the critical damping, `excited`: whether contact forces
    excite it.

    `motion`: in words, where tilting or axial motion of one gear has most of the kinetic energy; else empty.
    """

    frequency: float
    damping_ratio: float
    excited: bool
    motion: str = ""

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


def natural_frequencies(drivetrain: Drivetrain, mesh_stiffness: float | np.ndarray) -> np.ndarray:
    """Natural frequencies (k,), Hz, ascending, of a drivetrain with inertia and a mesh stiffness as of `modes`."""
    return modes(drivetrain, mesh_stiffness)[0]


def vibrations(
    drivetrain: Drivetrain, mesh_stiffness: float | np.ndarray, friction: bool | np.ndarray = False
) -> list[Vibration]:
    """The elastic modes by frequency, as far as they are right; none without masses. `friction`: whether contact forces
    also act across the line of action, of all meshes or of each.

    >>> from fenics_gears import load_scene, model_of
    >>> drivetrain = model_of(load_scene("demos/lundvall2004.toml")).drivetrain
    >>> [round(each.frequency) for each in vibrations(drivetrain, 1e6) if each.excited]
    [227, 510, 688, 3851]
    """
    if drivetrain.mass is None:
        return []
    frequencies, shapes = modes(drivetrain, mesh_stiffness)
    across = drivetrain.mesh.across
    directions = np.concatenate([drivetrain.mesh.normals, across[np.broadcast_to(friction, len(across))]])
    moved = np.abs(directions @ shapes).max(axis=0)
    if np.isinf(mesh_stiffness).any():
        # Tied flanks do not move apart in any mode; their errors excite every mode.
        moved = np.full(len(frequencies), np.inf)
    damping = np.zeros_like(drivetrain.stiffness) if drivetrain.damping is None else drivetrain.damping
    damped = np.einsum("ci,cd,di->i", shapes, damping, shapes)
    words = _motions(drivetrain, frequencies, shapes)
    return [
        Vibration(
            float(frequency),
            float(0.5 * taken / (2.0 * pi * frequency)),
            bool(motion > STILL * np.linalg.norm(shape)),
            said,
        )
        for frequency, taken, motion, shape, said in zip(frequencies, damped, moved, shapes.T, words)
        if RIGID * frequencies[-1] < frequency <= drivetrain.right_up_to
    ]


def modes(drivetrain: Drivetrain, mesh_stiffness: float | np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Natural frequencies (k,), Hz, ascending, and shapes (k, k), one a column, of modal mass 1. `mesh_stiffness`,
    N/mm: of the mesh, or of each mesh of a train (f,)."""
    normals = drivetrain.mesh.normals
    if np.isinf(mesh_stiffness).any():
        # Flanks are rigid and stay together: nothing moves along the normals.
        free = null_space(normals)
        if not free.shape[1]:
            return np.empty(0), free
        return modes_within(free, drivetrain.stiffness_at_work, drivetrain.mass)
    springs = np.broadcast_to(
        mesh_stiffness if np.ndim(mesh_stiffness) else mesh_stiffness / len(normals), len(normals)
    )
    stiffness = drivetrain.stiffness_at_work + (normals.T * springs) @ normals
    return modes_within(np.eye(len(stiffness)), stiffness, drivetrain.mass)


def modes_within(basis: np.ndarray, stiffness: np.ndarray, mass: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Natural frequencies (f,), Hz, ascending, and shapes (k, f) of motions within the span of a basis (k, f)."""
    squares, shapes = eigh(basis.T @ stiffness @ basis, basis.T @ mass @ basis)
    return np.sqrt(np.maximum(squares, 0.0)) / (2.0 * pi), basis @ shapes


# What most of the energy of a mode may be in: first words of coordinates, and the mode in words.
OF_GEARS = ((("tilt",), "{} tilts"), (("axial",), "{} moves along its axis"))
OF_SHAFTS = (
    (("centre", "tilt", "face", "bending"), "the {}'s shaft bends"),
    (("rotation", "twist", "torsion"), "the {}'s shaft twists"),
    (("axial",), "the {}'s shaft moves along its axis"),
)


def _motions(drivetrain: Drivetrain, frequencies: np.ndarray, shapes: np.ndarray) -> list[str]:
    """What gears do beside the plane motion in each mode, in words, empty where that has less than half of the kinetic
    energy; where shafts bend also what they do, and whether most of the elastic energy is in the mesh."""
    # Of modes of modal mass 1 these are shares.
    energy, said = shapes * (drivetrain.mass @ shapes), [""] * shapes.shape[1]
    bent = [shaft.name for shaft in drivetrain.elastic]
    for gear in GEARS:
        for kinds, words in (*(OF_SHAFTS if gear in bent else ()), *OF_GEARS):
            rows = [
                place
                for place, name in enumerate(drivetrain.coordinates)
                if gear_of(name) == gear and name.startswith(kinds)
            ]
            said = [
                words.format(gear) if share > 0.5 else before for share, before in zip(energy[rows].sum(axis=0), said)
            ]
    if not bent:
        return said
    in_shafts = np.einsum("ci,cd,di->i", shapes, drivetrain.stiffness_at_work, shapes)
    springs = in_shafts < 0.5 * (2.0 * pi * frequencies) ** 2
    return [" and ".join(filter(None, (words, "the mesh springs" * bool(of)))) for words, of in zip(said, springs)]
