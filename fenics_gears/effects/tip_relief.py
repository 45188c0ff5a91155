"""``[tip_relief]``: material removed towards the tips (``geometry.modification``)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Optional

from fenics_gears.effects.effect import Effect
from fenics_gears.scene.fields import Section, quantity
from fenics_gears.scene.problem import Problem
from fenics_gears.scene.tree import Tree, table

_NO_RELIEF = "For a gear without relief, leave its depth out."


@dataclass(frozen=True)
class Relief:
    """Tip relief of one gear: depth at the tip, mm; start as a roll angle in rad, None for HPSTC."""

    depth: float
    start_roll_angle: float | None


@dataclass(frozen=True)
class TipRelief:
    """Tip relief of the pair, linear in the roll angle; a gear without relief has None."""

    pinion: Relief | None
    wheel: Relief | None


class ReliefText(Section):
    """``[tip_relief.pinion]`` and ``[tip_relief.wheel]``; what is left out is taken from ``[tip_relief]``."""

    depth: Optional[float] = quantity("1e-6 um", "100 mm", "31 um", optional=True, below=_NO_RELIEF)
    start: Optional[float] = quantity("1e-3 deg", "360 deg", "29.61 deg", optional=True, words={"HPSTC": None})


class TipReliefText(ReliefText):
    """``[tip_relief]``: depth and start for both gears."""

    pinion: Optional[ReliefText] = None
    wheel: Optional[ReliefText] = None


def read(text: TipReliefText) -> TipRelief:
    """Each gear's own relief before that of both."""
    return TipRelief(_relief(text, text.pinion), _relief(text, text.wheel))


def _relief(both: TipReliefText, own: ReliefText | None) -> Relief | None:
    """One gear's relief: its own depth and start before those of both gears; None without a depth."""
    own = own or ReliefText()
    depth = both.depth if own.depth is None else own.depth
    start = own.start if "start" in own.model_fields_set else both.start
    return None if depth is None else Relief(depth, start)


def relief_is_complete(tree: Tree) -> Iterator[Problem]:
    """A relief has a depth and a start."""
    both = table(tree, "tip_relief")
    if both is None:
        return
    given = {("tip_relief", gear): {*both, *both[gear]} for gear in ("pinion", "wheel") if table(both, gear) is not None}
    if "depth" in both or not given:
        given["tip_relief",] = set(both)
    for path, names in given.items():
        for name, example in (("depth", '"31 um"'), ("start", '"HPSTC" or "29.61 deg"')):
            if name not in names:
                yield Problem((*path, name), None, f"is missing. Allowed: such as {example}.")


def removal(relief: TipRelief, pair):
    """Material removed from pinion and wheel."""
    from fenics_gears.geometry.modification import tip_reliefs

    return tip_reliefs(pair, relief)


EFFECT = Effect(
    section="tip_relief",
    description="material removed towards the tips, linear in the roll angle",
    absent="true involutes",
    text=TipReliefText,
    data=TipRelief,
    terms=("initial gaps",),
    read=read,
    rules=relief_is_complete,
    removal=removal,
)
