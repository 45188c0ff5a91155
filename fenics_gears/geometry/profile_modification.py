"""Crowning and slope of the profile, C_alpha and C_Halpha of ISO 21771, over its used part, from the start of active
profile to the tip."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from fenics_gears.inputs.fields import quantity
from fenics_gears.inputs.section import Section
from fenics_gears.inputs.tree import PerGear

from .pair import GearPair


@dataclass(frozen=True)
class ProfileModification(Section):
    """``[profile_modifications.pinion]`` and ``[profile_modifications.wheel]``: over the flank's used part, from the
    start of active profile to the tip;
    each field alone is enough."""

    empty = "names no modification. Add crowning or slope, or leave the section out."

    crowning: float = quantity(
        "-100 mm to 100 mm",
        "4 um",
        meaning="height of the crowning, a parabola over the roll angle: removed at both ends, nothing in the"
        " middle; where it is negative, in the middle and nothing at the ends",
        default="0 um",
        otherwise="no crowning",
        small=True,
    )
    slope: float = quantity(
        "-100 mm to 100 mm",
        "5 um",
        meaning="slope, removed in proportion to the roll angle: so much at the tip; where it is negative, so much"
        " at the start of active profile and nothing at the tip",
        default="0 um",
        otherwise="no slope",
        small=True,
    )


@dataclass(frozen=True)
class ProfileModifications(Section, PerGear):
    """``[profile_modifications]``: amounts normal to the flank in the transverse section, which is along the line of
    action there, the same on all teeth of a gear."""

    empty = (
        "modifies neither gear. Add [profile_modifications.pinion] or [profile_modifications.wheel], or leave the"
        " section out."
    )

    pinion: ProfileModification | None = None
    wheel: ProfileModification | None = None


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
    sides = zip(pair.gears, modifications.of_gears, pair.sap_roll_angles)
    first, second = (
        None if own is None else ProfileCurve(own, start, gear.tip_roll_angle) for gear, own, start in sides
    )
    return first, second
