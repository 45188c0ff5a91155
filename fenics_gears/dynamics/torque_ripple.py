"""A torque on the wheel's shaft that varies with the angle that the shaft has turned.

The angle is that of the nominal motion: deviations of the shaft's end from it are small beside the period of any
harmonic.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from fenics_gears.inputs.fields import declared, number, quantity
from fenics_gears.inputs.section import AllowedTables, Section

from .drivetrain import Drivetrain

HIGHEST_ORDER = 1e6
MOST_HARMONICS = 1000


@dataclass(frozen=True)
class Harmonic(Section):
    """amplitude cos(order theta + phase), with theta the angle that the wheel's shaft has turned since the start."""

    order: float = number(1.0, meaning="order", above=0, highest=HIGHEST_ORDER)
    amplitude: float = quantity("1e-12 N m to 1e12 N m", "20 N m", meaning="amplitude")
    phase: float = quantity("-360 deg to 360 deg", "30 deg", meaning="phase", default="0 deg")


_HARMONICS = AllowedTables(
    description=f"a list of harmonics, each with an order above 0 up to {HIGHEST_ORDER:g}, an amplitude and, if any, "
    'a phase, such as [{ order = 1, amplitude = "20 N m", phase = "30 deg" }]',
    section=Harmonic,
    singular="harmonic",
    empty="For a steady torque, leave the section [torque_ripple] out.",
    most=MOST_HARMONICS,
    meaning="harmonics added to `load.wheel_torque`: amplitude * cos(order * rotation of the wheel's shaft + phase)",
)


@dataclass(frozen=True)
class TorqueRipple(Section):
    """``[torque_ripple]``."""

    harmonics: tuple[Harmonic, ...] = declared(_HARMONICS)


def torque(ripple: TorqueRipple, angles: Sequence[float]) -> np.ndarray:
    """The varying part of the torque (n,), N mm, at angles (n,), rad, of the wheel's shaft."""
    turned = np.asarray(angles)
    return sum(
        (each.amplitude * np.cos(each.order * turned + each.phase) for each in ripple.harmonics), np.zeros(len(turned))
    )


def varying_load(ripple: TorqueRipple, drivetrain: Drivetrain, shaft_step: float) -> Callable[[float], np.ndarray]:
    """Forces (k,), N, at a step; the wheel's shaft turns by `shaft_step` (rad) in each."""
    unit = drivetrain.ends[0]

    def load(step: float) -> np.ndarray:
        return unit * torque(ripple, [shaft_step * step])[0]

    return load
