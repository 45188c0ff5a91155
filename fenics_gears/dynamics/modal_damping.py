"""Damping of a drivetrain, by Rayleigh's factors or by its modes: D = M Phi diag(2 zeta omega) Phi^T M with Phi of
modal mass 1.

The modes are those with one tooth pair in mesh as a spring along the line of action: without it the wheel's side would
turn freely, and motion against the mesh would not be damped. Each mode has its ratio zeta exactly; a rigid motion,
whose omega is zero, is not damped. R. W. Clough and J. Penzien, Dynamics of Structures, 2nd ed., 1993, section 12-5.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .damping import Damping
from .drivetrain import Drivetrain, gear_of
from .frequencies import RIGID, modes


def damping_of(
    undamped: Drivetrain,
    damping: Damping | None,
    mesh_stiffness: float | np.ndarray,
    of_elements: np.ndarray | float = 0.0,
) -> np.ndarray | None:
    """D (k, k), N s/mm, of a drivetrain with inertia and a mesh stiffness as of `frequencies.modes`; None without any.

    alpha K + beta M of either shaft, or by the ratios of the modes; and what elements of shafts have of their own.
    """
    if damping is None:
        return of_elements if isinstance(of_elements, np.ndarray) and of_elements.any() else None
    if damping.modal:
        return of_elements + modal_damping(undamped, mesh_stiffness, damping.modal)
    # A row and its column have the same factors, but for springs of a housing that joins both sides of the mesh.
    factors = np.array([damping.rayleigh(gear_of(name)) for name in undamped.coordinates]).T
    alpha, beta = 0.5 * (factors[:, :, None] + factors[:, None, :])
    return of_elements + alpha * undamped.stiffness_at_work + beta * undamped.mass


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
