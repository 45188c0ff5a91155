"""How strongly a drivetrain is damped: by Rayleigh's factors of each shaft or by ratios of the modes.

By the modes D = M Phi diag(2 zeta omega) Phi^T M with Phi of modal mass 1. They are those with one tooth pair in mesh
as a spring along the line of action: without it the wheel's side would turn freely, and motion against the mesh would
not be damped. Each mode has its ratio zeta exactly; a rigid motion, whose omega is zero, is not damped. R. W. Clough
and J. Penzien, Dynamics of Structures, 2nd ed., 1993, section 12-5.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fenics_gears.inputs.fields import number, numbers, quantity
from fenics_gears.inputs.section import Section, own_or_shared

from .drivetrain import Drivetrain, gear_of
from .frequencies import RIGID, modes

RAYLEIGH, MODAL = ("stiffness_proportional", "mass_proportional"), ("ratio", "ratios")


OF_GEARS = "each gear has its own, or the damping is given by ratios"


def _stiffness_proportional(otherwise: str):
    meaning = "factor alpha of the stiffness matrix K in the damping matrix alpha K + beta M"
    return quantity("0 s to 1e3 s", "0.4e-3 s", meaning=meaning, otherwise=otherwise)


def _mass_proportional(otherwise: str):
    meaning = "factor beta of the mass matrix M in the damping matrix alpha K + beta M"
    return quantity("0 1/s to 1e9 1/s", "0.5e-3 1/s", meaning=meaning, otherwise=otherwise)


@dataclass(frozen=True)
class Rayleigh(Section):
    """``[damping.pinion]`` and ``[damping.wheel]``: Rayleigh damping of a gear with its bearings and its shaft."""

    stiffness_proportional: float | None = _stiffness_proportional("that of `[damping]`")
    mass_proportional: float | None = _mass_proportional("that of `[damping]`")


@dataclass(frozen=True)
class Damping(Rayleigh):
    """``[damping]``: either Rayleigh damping, for both gears or for each, or damping ratios of the modes."""

    alternatives = (MODAL,)

    stiffness_proportional: float | None = _stiffness_proportional(OF_GEARS)
    mass_proportional: float | None = _mass_proportional(OF_GEARS)
    ratio: float | None = number(
        0.05,
        meaning=(
            "damping ratio (part of the critical damping) of all modes of the drivetrain with one tooth pair in mesh"
        ),
        above=0,
        below=1,
        otherwise="damping is given by `ratios` or is Rayleigh damping",
    )
    ratios: tuple[float, ...] | None = numbers(
        0.0, 0.999, 0.05,
        meaning="damping ratios of the modes in the order of their frequencies; the last one holds for all further "
            "modes",
        otherwise="damping is given by `ratio` or is Rayleigh damping",
    )  # fmt: skip
    pinion: Rayleigh | None = None
    wheel: Rayleigh | None = None

    @property
    def modal(self) -> tuple[float, ...]:
        """Damping ratios by mode from the lowest frequency on, the last for all that follow; empty for Rayleigh
        damping."""
        return (self.ratio,) if self.ratio is not None else self.ratios or ()

    def rayleigh(self, gear: str) -> tuple[float, float]:
        """alpha (s) and beta (1/s) of the shaft of the "pinion" or of the "wheel"; of others those that all share."""
        alpha, beta = (own_or_shared(getattr(self, gear, None), self, name) or 0.0 for name in RAYLEIGH)
        return alpha, beta


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
