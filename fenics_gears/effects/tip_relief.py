"""``[tip_relief]``: material removed towards the tips (``geometry.relief``)."""

from dataclasses import dataclass
from functools import partial

from fenics_gears.geometry.relief import Relief, Reliefs, tip_reliefs

from .effect import Effect
from .relief import AT_KINK, read, rules, starts_without_single_contact, write


@dataclass(frozen=True)
class TipReliefText(Relief):
    """``[tip_relief]``: relief of both gears; it ends at the tip."""

    pinion: Relief | None = None
    wheel: Relief | None = None


@dataclass(frozen=True)
class TipRelief(Reliefs):
    """Tip relief of the pair."""


def removal(reliefs: TipRelief, pair):
    return tip_reliefs(pair, reliefs)


EFFECT = Effect(
    section="tip_relief",
    description="tip relief, linear or parabolic in the roll angle",
    absent="involutes without tip relief",
    fields=TipReliefText,
    terms=("gaps between the flanks",),
    read=partial(read, TipRelief),
    write=partial(write, "HPSTC"),
    rules=partial(rules, "tip_relief", "HPSTC"),
    removal=removal,
    warnings=partial(starts_without_single_contact, "tip_relief", "HPSTC"),
    variables=(AT_KINK,),
)
