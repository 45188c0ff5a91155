"""Deviations of single teeth as a scene gives them."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Waviness:
    """Undulation of all flanks of a gear, ``amplitude`` mm, ``waves`` a turn, ``phase`` in rad."""

    amplitude: float
    waves: int
    phase: float = 0.0


@dataclass(frozen=True)
class GearErrors:
    """Errors of one gear, mm, a value for each tooth; None for what the scene does not give. Those of the helix are over the gear's face width.

    ``file``: the table that the values are from; ``problem``: what is wrong with it, in words, empty where nothing is.
    """

    pitch: tuple[float, ...] | None = None
    profile_slope: tuple[float, ...] | None = None
    profile_form: tuple[float, ...] | None = None
    helix_slope: tuple[float, ...] | None = None
    helix_form: tuple[float, ...] | None = None
    waviness: Waviness | None = None
    file: str | None = None
    problem: str = ""


@dataclass(frozen=True)
class FlankErrors:
    """Errors of both gears' drive flanks; what is not given is drawn within a flank tolerance class, zero without one."""

    pinion: GearErrors = GearErrors()
    wheel: GearErrors = GearErrors()
    tolerance_class: int | None = None
    seed: int = 1
