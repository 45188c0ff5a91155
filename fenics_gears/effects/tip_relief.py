"""``[tip_relief]``: material removed towards the tips (``geometry.relief``)."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Optional

from fenics_gears.effects.effect import Effect
from fenics_gears.effects.relief import TipReliefOfGearText, kink_findings, kinks_watched, of_gear, rules
from fenics_gears.geometry.relief_data import TipRelief
from fenics_gears.inputs.problem import Problem
from fenics_gears.inputs.tree import GEARS, Tree


class TipReliefText(TipReliefOfGearText):
    """``[tip_relief]``: depth, start (or length) and shape for both gears."""

    pinion: Optional[TipReliefOfGearText] = None
    wheel: Optional[TipReliefOfGearText] = None


def read(text: TipReliefText) -> TipRelief:
    """Each gear's own relief before that of both."""
    return TipRelief(of_gear(text, text.pinion), of_gear(text, text.wheel))


def relief_is_whole(tree: Tree) -> Iterator[Problem]:
    """A relief has a depth and one start, which means the same for both gears."""
    return rules(tree, "tip_relief", "HPSTC")


def removal(relief: TipRelief, pair):
    """Material removed from pinion and wheel."""
    from fenics_gears.geometry.relief import tip_reliefs

    return tip_reliefs(pair, relief)


def watched(relief: TipRelief, cycle, records) -> dict:
    """Where contact presses hardest, seen from the kinks of linear relief."""
    return kinks_watched("tip_relief", relief, dict(zip(GEARS, removal(relief, cycle.pair))), cycle, records)


def findings(relief: TipRelief, watched) -> list[str]:
    """Contact that presses hardest on a kink."""
    return kink_findings("tip_relief", watched)


EFFECT = Effect(
    section="tip_relief",
    description="material removed towards the tips, linear or parabolic in the roll angle",
    absent="true involutes",
    text=TipReliefText,
    data=TipRelief,
    terms=("initial gaps",),
    read=read,
    rules=relief_is_whole,
    removal=removal,
    watched=watched,
    findings=findings,
)
