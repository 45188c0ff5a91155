"""Damping by the drivetrain's modes: D = M Phi diag(2 zeta omega) Phi^T M with Phi of modal mass 1.

The modes are those with one tooth pair in mesh as a spring along the line of action: without it the wheel's side would
turn freely, and motion against the mesh would not be damped. Each mode has its ratio zeta exactly; a rigid motion,
whose omega is zero, is not damped. R. W. Clough and J. Penzien, Dynamics of Structures, 2nd ed., 1993, section 12-5.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .drivetrain import Drivetrain
from .frequencies import RIGID, modes


def modal_damping(drivetrain: Drivetrain, mesh_stiffness: float | np.ndarray, ratios: Sequence[float]) -> np.ndarray:
    """D (k, k), N s/mm, of a drivetrain with inertia and a mesh stiffness as of `frequencies.modes`.

    `ratios`: zeta by elastic mode from the lowest frequency on; the last holds for all that follow.
    """
    frequencies, shapes = modes(drivetrain, mesh_stiffness)
    elastic = frequencies > RIGID * frequencies.max(initial=0.0)
    frequencies, shapes = frequencies[elastic], shapes[:, elastic]
    zeta = np.array([ratios[min(number, len(ratios) - 1)] for number in range(len(frequencies))])
    momenta = drivetrain.mass @ shapes
    return (momenta * (4.0 * np.pi * zeta * frequencies)) @ momenta.T
