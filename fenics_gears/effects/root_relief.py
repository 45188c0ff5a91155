"""``[root_relief]``: material removed towards the roots (``geometry.relief``)."""

from dataclasses import dataclass

from fenics_gears.geometry.relief import Reliefs, RootReliefOfGear, root_reliefs

from .relief import relief_effect


@dataclass(frozen=True)
class RootReliefText(RootReliefOfGear):
    """``[root_relief]``: relief of both gears; it ends at the form circle."""

    pinion: RootReliefOfGear | None = None
    wheel: RootReliefOfGear | None = None


@dataclass(frozen=True)
class RootRelief(Reliefs):
    """Root relief of the pair."""


EFFECT = relief_effect("root", "LPSTC", RootReliefText, RootRelief, root_reliefs)
