"""Data of a torque that varies with the turn of the shaft."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Harmonic:
    """amplitude cos(order theta + phase), N mm and rad, with theta the angle that the wheel's shaft has turned since
    the start."""

    order: float
    amplitude: float
    phase: float = 0.0


@dataclass(frozen=True)
class TorqueRipple:
    """Harmonics that add to the torque on the wheel's shaft."""

    harmonics: tuple[Harmonic, ...]
