"""``[bearings]``: elastic support of the gear centres (``dynamics.drivetrain``)."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Optional

from fenics_gears.dynamics.drivetrain_data import Bearings
from fenics_gears.effects.effect import Effect, ResultVariable
from fenics_gears.inputs.fields import Section, quantity
from fenics_gears.inputs.problem import Problem
from fenics_gears.inputs.tree import GEARS, Tree, given_for, table

DIRECTIONS = ("x", "y")


def _stiffness(meaning: str, otherwise: str):
    return quantity("1e-6 N/mm", "1e20 N/mm", "0.155e6 N/mm", meaning=meaning, otherwise=otherwise)


class SupportText(Section):
    """``[bearings.pinion]`` and ``[bearings.wheel]``; fields that are left out are those of ``[bearings]``, and the defaults hold if that
    section leaves them out too."""

    stiffness: Optional[float] = _stiffness("stiffness in all directions", "from `stiffness_x` and `stiffness_y`")
    stiffness_x: Optional[float] = _stiffness("stiffness along the line of action", "`stiffness`")
    stiffness_y: Optional[float] = _stiffness("stiffness off the line of action", "`stiffness`")


class BearingsText(SupportText):
    """``[bearings]``: stiffness of the support of each gear, the same in all directions or separate along (x) and off (y) the line of action."""

    pinion: Optional[SupportText] = None
    wheel: Optional[SupportText] = None


def supports_are_complete(tree: Tree) -> Iterator[Problem]:
    """Either shaft has a stiffness in either direction."""
    both = table(tree, "bearings")
    if both is None:
        return
    missing = [(gear, direction) for gear in GEARS for direction in DIRECTIONS if not given_for(both, gear) & {"stiffness", f"stiffness_{direction}"}]
    example = 'Allowed: such as "0.155e6 N/mm"'
    if len(missing) == 4:
        yield Problem(("bearings", "stiffness"), None, f"is missing. {example}, or stiffness_x and stiffness_y, along and off the line of action.")
    elif missing:
        gears = {gear for gear, _ in missing}
        for direction in sorted({direction for _, direction in missing}):
            path = ("bearings",) if len(gears) == 2 else ("bearings", *gears)
            yield Problem((*path, f"stiffness_{direction}"), None, f"is missing. {example}, or stiffness for both directions.")


EFFECT = Effect(
    section="bearings",
    description="elastic support of the gear centres",
    absent="the centres are fixed",
    text=BearingsText,
    data=Bearings,
    unknowns=("two displacements of each gear centre",),
    terms=("translational springs",),
    variables=(
        ResultVariable("centre_x", "mm", "displacement of the centre along the line of action", dims=("time", "gear")),
        ResultVariable("centre_y", "mm", "displacement of the centre off the line of action", dims=("time", "gear")),
        ResultVariable("energy_bearings", "N mm", "elastic energy of the bearings"),
    ),
    rules=supports_are_complete,
)
