"""``[root_relief]``: material removed towards the roots (``geometry.relief``)."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Optional

from fenics_gears.effects.effect import Effect
from fenics_gears.effects.relief import RootReliefOfGearText, kink_findings, kinks_watched, of_gear, rules
from fenics_gears.geometry.relief_data import RootRelief
from fenics_gears.inputs.problem import Problem
from fenics_gears.inputs.tree import GEARS, Tree


class RootReliefText(RootReliefOfGearText):
    """``[root_relief]``: depth at the form circle, start (or length) and shape for both gears."""

    pinion: Optional[RootReliefOfGearText] = None
    wheel: Optional[RootReliefOfGearText] = None


def read(text: RootReliefText) -> RootRelief:
    """Each gear's own relief before that of both."""
    return RootRelief(of_gear(text, text.pinion), of_gear(text, text.wheel))


def relief_is_whole(tree: Tree) -> Iterator[Problem]:
    """A relief has a depth and one start, which means the same for both gears."""
    return rules(tree, "root_relief", "LPSTC")


def removal(relief: RootRelief, pair):
    """Material removed from pinion and wheel."""
    from fenics_gears.geometry.relief import root_reliefs

    return root_reliefs(pair, relief)


def watched(relief: RootRelief, cycle, records) -> dict:
    """Where contact presses hardest, seen from the kinks of linear relief."""
    return kinks_watched("root_relief", relief, dict(zip(GEARS, removal(relief, cycle.pair))), cycle, records)


def findings(relief: RootRelief, watched) -> list[str]:
    """Contact that presses hardest on a kink."""
    return kink_findings("root_relief", watched)


EFFECT = Effect(
    section="root_relief",
    description="material removed towards the roots, linear or parabolic in the roll angle",
    absent="true involutes down to the form circle",
    text=RootReliefText,
    data=RootRelief,
    terms=("initial gaps",),
    read=read,
    rules=relief_is_whole,
    removal=removal,
    watched=watched,
    findings=findings,
)
