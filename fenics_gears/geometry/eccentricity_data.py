"""Run-out of a gear pair as a scene gives it."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Offset:
    """Where the centre of a gear's base circle lies from its axis of rotation: distance, mm, and phase, rad.

    The phase is the angle from the line of action's direction, pinion to wheel, at the start of the first mesh cycle, counted in
    the gear's own sense of rotation.
    """

    distance: float
    phase: float = 0.0


@dataclass(frozen=True)
class Eccentricity:
    """Run-out of the pair; a gear that runs true has None."""

    pinion: Offset | None = None
    wheel: Offset | None = None
