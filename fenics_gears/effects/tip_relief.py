"""``[tip_relief]``: material removed towards the tips (``geometry.relief``)."""

from dataclasses import dataclass

from fenics_gears.geometry.relief import Relief, Reliefs, tip_reliefs

from .relief import relief_effect


@dataclass(frozen=True)
class TipReliefText(Relief):
    """``[tip_relief]``: relief of both gears; it ends at the tip."""

    pinion: Relief | None = None
    wheel: Relief | None = None


@dataclass(frozen=True)
class TipRelief(Reliefs):
    """Tip relief of the pair."""


EFFECT = relief_effect("tip", "HPSTC", TipReliefText, TipRelief, tip_reliefs)
