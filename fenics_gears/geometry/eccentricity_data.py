"""Run-out of a gear pair as a scene gives it."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Offset:
    """Where the centre of a gear's base circle lies from its axis of rotation at mid-width: distance, mm, and phase,
    rad; and how the teeth's axis leans.

    The phase is the angle from the line of action's direction, pinion to wheel, at the start of the first mesh cycle,
    counted in the gear's own sense of rotation. ``wobble``, mm: by how much the axis of the teeth departs from that of
    rotation from the left end of the gear's face to the right one, in the direction ``wobble_phase``.
    """

    distance: float = 0.0
    phase: float = 0.0
    wobble: float = 0.0
    wobble_phase: float = 0.0


@dataclass(frozen=True)
class Eccentricity:
    """Run-out of the pair; a gear that runs true has None."""

    pinion: Offset | None = None
    wheel: Offset | None = None
