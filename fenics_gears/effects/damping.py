"""``[damping]``: Rayleigh damping of each shaft (``dynamics.drivetrain``)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from fenics_gears.effects.effect import Effect, ResultVariable
from fenics_gears.scene.fields import Section, quantity
from fenics_gears.scene.problem import Problem
from fenics_gears.scene.tree import Tree, quantity_in, table
from fenics_gears.scene.written import as_written


@dataclass(frozen=True)
class Damping:
    """Rayleigh damping of each shaft: alpha K + beta M, alpha in s, beta in 1/s."""

    stiffness_proportional: float
    mass_proportional: float


class DampingText(Section):
    """``[damping]``."""

    stiffness_proportional: float = quantity("0 s", "1e3 s", "0.4e-3 s", meaning="alpha of alpha K + beta M")
    mass_proportional: float = quantity("0 1/s", "1e9 1/s", "0.5e-3 1/s", meaning="beta of alpha K + beta M")


def damping_acts(tree: Tree) -> Iterator[Problem]:
    """Damping must not be zero, nor proportional to a stiffness that is not there."""
    damping = table(tree, "damping")
    if damping is None:
        return
    values = {name: quantity_in(damping.get(name)) for name in ("stiffness_proportional", "mass_proportional")}
    if values["mass_proportional"] != 0 or values["stiffness_proportional"] is None:
        return
    if values["stiffness_proportional"] == 0:
        yield Problem(("damping",), "", "damps nothing: both values are zero. For an undamped pair, leave the section [damping] out.")
    elif "shafts" not in tree and "bearings" not in tree:
        message = "damps nothing: there is no stiffness without [shafts] or [bearings]. Add one of them, or allow a mass_proportional value above 0."
        yield Problem(("damping", "stiffness_proportional"), as_written(damping["stiffness_proportional"]), message)


EFFECT = Effect(
    section="damping",
    description="Rayleigh damping of each shaft",
    absent="undamped",
    text=DampingText,
    data=Damping,
    terms=("damping forces, stiffness- and mass-proportional",),
    variables=(ResultVariable("work_damping", "N mm", "work that damping takes"),),
    needs=("inertia",),
    rules=damping_acts,
)
