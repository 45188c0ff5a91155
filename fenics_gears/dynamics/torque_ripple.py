"""A torque on the wheel's shaft that varies with the angle that the shaft has turned.

The angle is that of the nominal motion: deviations of the shaft's end from it are small beside the period of any
harmonic.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from .drivetrain import Drivetrain, forces_of_torque

if TYPE_CHECKING:
    from fenics_gears.effects.torque_ripple import TorqueRipple


def torque(ripple: TorqueRipple, angles: Sequence[float]) -> np.ndarray:
    """The varying part of the torque (n,), N mm, at angles (n,), rad, of the wheel's shaft."""
    turned = np.asarray(angles)
    return sum(
        (each.amplitude * np.cos(each.order * turned + each.phase) for each in ripple.harmonics), np.zeros(len(turned))
    )


def varying_load(ripple: TorqueRipple, drivetrain: Drivetrain, shaft_step: float) -> Callable[[float], np.ndarray]:
    """Forces (k,), N, at a step; the wheel's shaft turns by `shaft_step` (rad) in each."""
    unit = forces_of_torque(drivetrain.coordinates, drivetrain.radii, 1.0)

    def load(step: float) -> np.ndarray:
        return unit * torque(ripple, [shaft_step * step])[0]

    return load
