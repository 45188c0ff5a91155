"""``[tip_relief]``: material removed towards the tips (``geometry.relief``)."""

from __future__ import annotations

from functools import partial
from typing import Optional

from fenics_gears.effects.effect import Effect
from fenics_gears.effects.relief import AT_KINK, TipReliefOfGearText, of_gear, rules, write
from fenics_gears.geometry.relief_data import TipRelief


class TipReliefText(TipReliefOfGearText):
    """``[tip_relief]``: relief of both gears; it ends at the tip."""

    pinion: Optional[TipReliefOfGearText] = None
    wheel: Optional[TipReliefOfGearText] = None


def read(text: TipReliefText) -> TipRelief:
    """Each gear's own relief before that of both."""
    return TipRelief(of_gear(text, text.pinion), of_gear(text, text.wheel))


def removal(relief: TipRelief, pair):
    """Material removed from pinion and wheel."""
    from fenics_gears.geometry.relief import tip_reliefs

    return tip_reliefs(pair, relief)


EFFECT = Effect(
    section="tip_relief",
    description="tip relief, linear or parabolic in the roll angle",
    absent="involutes without tip relief",
    text=TipReliefText,
    data=TipRelief,
    terms=("gaps between the flanks",),
    read=read,
    write=partial(write, TipReliefOfGearText, "HPSTC"),
    rules=partial(rules, "tip_relief", "HPSTC"),
    removal=removal,
    variables=(AT_KINK,),
)
