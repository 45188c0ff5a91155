"""``[shafts]``: torsion of the input and the output shaft (``dynamics.drivetrain``)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from fenics_gears.effects.effect import Effect, ResultVariable, own_or_shared
from fenics_gears.inputs.fields import quantity
from fenics_gears.inputs.problem import Problem
from fenics_gears.inputs.section import Section
from fenics_gears.inputs.tree import Tree, table

SHAFTS = ("input", "output")


def _stiffness(meaning: str, otherwise: str = ""):
    return quantity("1e-6 N mm/rad to 1e24 N mm/rad", "0.203e9 N mm/rad", meaning=meaning, otherwise=otherwise)


@dataclass(frozen=True)
class Shaft(Section):
    """``[shafts.input]`` and ``[shafts.output]``: the shaft between the prescribed rotation and the pinion, and that
    between wheel and load."""

    torsional_stiffness: float = _stiffness("torsional stiffness of this shaft")


@dataclass(frozen=True)
class Shafts(Section):
    """``[shafts]``."""

    torsional_stiffness: float | None = _stiffness(
        "torsional stiffness of each of the two shafts", "each shaft has its own"
    )
    input: Shaft | None = None
    output: Shaft | None = None

    def of(self, shaft: str) -> float:
        """Torsional stiffness (N mm/rad) of the "input" or the "output" shaft."""
        return own_or_shared(getattr(self, shaft), self, "torsional_stiffness")


def shafts_are_complete(tree: Tree) -> Iterator[Problem]:
    """Either shaft has a stiffness."""
    both = table(tree, "shafts")
    if both is None or "torsional_stiffness" in both:
        return
    missing, example = [name for name in SHAFTS if name not in both], 'Allowed: such as "0.203e9 N mm/rad"'
    if len(missing) == 2:
        yield Problem(
            ("shafts", "torsional_stiffness"),
            None,
            f"is missing. {example}, or one each in [shafts.input] and [shafts.output].",
        )
    elif missing:
        path = ("shafts", *missing, "torsional_stiffness")
        yield Problem(
            path,
            None,
            f"is missing: only the other shaft has a stiffness. {example}, or torsional_stiffness of [shafts] for"
            " both.",
        )


EFFECT = Effect(
    section="shafts",
    description="elastic torsion of the input and the output shaft",
    absent="the prescribed rotation acts on the pinion and the load torque on the wheel directly",
    fields=Shafts,
    unknowns=("rotation of the pinion", "rotation of the far end of the output shaft"),
    terms=("torsional springs",),
    variables=(
        ResultVariable("shaft_end_rotation", "rad", "rotation of the far end of the output shaft"),
        ResultVariable("energy_shafts", "N mm", "elastic energy of the shafts"),
    ),
    rules=shafts_are_complete,
)
