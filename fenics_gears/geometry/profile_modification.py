"""Crowning and slope of the profile, C_alpha and C_Halpha of ISO 21771, over its used part, from the start of active
profile to the tip."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from .pair import GearPair

if TYPE_CHECKING:
    from fenics_gears.effects.profile_modifications import ProfileModification, ProfileModifications


@dataclass(frozen=True)
class ProfileCurve:
    """Material removed along the flank's normal between two roll angles (rad) by crowning and slope (mm), which add
    nothing."""

    modification: ProfileModification
    start_roll_angle: float
    end_roll_angle: float
    # Crowning and slope join the involute at its ends alone.
    kinks: ClassVar[tuple[float, ...]] = ()

    def __call__(self, roll_angle) -> np.ndarray:
        """Removal (mm, not negative) at roll angles (rad, any shape)."""
        own = self.modification
        along = (np.asarray(roll_angle, dtype=float) - self.start_roll_angle) / (
            self.end_roll_angle - self.start_roll_angle
        )
        crowned = own.crowning * (2.0 * along - 1.0) ** 2 - np.minimum(own.crowning, 0.0)
        return np.maximum(crowned, 0.0) + np.maximum(own.slope * along - np.minimum(own.slope, 0.0), 0.0)

    @classmethod
    def side_by_side(cls, curves: Sequence[ProfileCurve], counts: Sequence[int]) -> ProfileCurve:
        """One curve for roll angles of several flanks one after the other, so many of each."""
        ends = [
            (of.modification.crowning, of.modification.slope, of.start_roll_angle, of.end_roll_angle) for of in curves
        ]
        crowning, slope, start, end = np.repeat(np.array(ends), counts, axis=0).T
        return cls(replace(curves[0].modification, crowning=crowning, slope=slope), start, end)


def profile_curves(
    pair: GearPair, modifications: ProfileModifications
) -> tuple[ProfileCurve | None, ProfileCurve | None]:
    """The curves of pinion and wheel; None for a gear without modification."""
    sides = zip((pair.pinion, pair.wheel), (modifications.pinion, modifications.wheel), pair.sap_roll_angles)
    return tuple(None if own is None else ProfileCurve(own, start, gear.tip_roll_angle) for gear, own, start in sides)
