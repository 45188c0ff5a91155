"""``[root_relief]``: material removed towards the roots (``geometry.relief``)."""

from dataclasses import dataclass
from functools import partial

from fenics_gears.geometry.relief import Reliefs, RootReliefOfGear, root_reliefs

from .effect import Effect
from .relief import AT_KINK, read, rules, starts_without_single_contact, write


@dataclass(frozen=True)
class RootReliefText(RootReliefOfGear):
    """``[root_relief]``: relief of both gears; it ends at the form circle."""

    pinion: RootReliefOfGear | None = None
    wheel: RootReliefOfGear | None = None


@dataclass(frozen=True)
class RootRelief(Reliefs):
    """Root relief of the pair."""


def removal(reliefs: RootRelief, pair):
    return root_reliefs(pair, reliefs)


EFFECT = Effect(
    section="root_relief",
    description="root relief, linear or parabolic in the roll angle",
    absent="involutes without root relief",
    fields=RootReliefText,
    terms=("gaps between the flanks",),
    read=partial(read, RootRelief),
    write=partial(write, "LPSTC"),
    rules=partial(rules, "root_relief", "LPSTC"),
    removal=removal,
    warnings=partial(starts_without_single_contact, "root_relief", "LPSTC"),
    variables=(AT_KINK,),
)
