"""Crowning and slope of the profiles as a scene gives them."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class ProfileModification:
    """Crowning and slope of one gear's profile, mm, of either sign."""

    crowning: float = 0.0
    slope: float = 0.0


@dataclass(frozen=True)
class ProfileModifications:
    """Profile modification of either gear; None for a gear that has none."""

    pinion: ProfileModification | None = None
    wheel: ProfileModification | None = None
