"""``[root_relief]``: material removed towards the roots (``geometry.relief``)."""

from __future__ import annotations

from functools import partial
from typing import Optional

from fenics_gears.effects.effect import Effect
from fenics_gears.effects.relief import AT_KINK, RootReliefOfGearText, of_gear, rules, write
from fenics_gears.geometry.relief_data import RootRelief


class RootReliefText(RootReliefOfGearText):
    """``[root_relief]``: relief of both gears; it ends at the form circle."""

    pinion: Optional[RootReliefOfGearText] = None
    wheel: Optional[RootReliefOfGearText] = None


def read(text: RootReliefText) -> RootRelief:
    """Each gear's own relief before that of both."""
    return RootRelief(of_gear(text, text.pinion), of_gear(text, text.wheel))


def removal(relief: RootRelief, pair):
    """Material removed from pinion and wheel."""
    from fenics_gears.geometry.relief import root_reliefs

    return root_reliefs(pair, relief)


EFFECT = Effect(
    section="root_relief",
    description="root relief, linear or parabolic in the roll angle",
    absent="involutes without root relief",
    text=RootReliefText,
    data=RootRelief,
    terms=("gaps between the flanks",),
    read=read,
    write=partial(write, RootReliefOfGearText, "LPSTC"),
    rules=partial(rules, "root_relief", "LPSTC"),
    removal=removal,
    variables=(AT_KINK,),
)
