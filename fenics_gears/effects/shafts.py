"""``[shafts]``: torsion of the input and the output shaft (``dynamics.drivetrain``)."""

from dataclasses import dataclass

from fenics_gears.effects.effect import Effect, ResultVariable
from fenics_gears.scene.fields import Section, quantity


@dataclass(frozen=True)
class Shafts:
    """Torsional stiffness of either shaft, N mm/rad."""

    torsional_stiffness: float


class ShaftsText(Section):
    """``[shafts]``."""

    torsional_stiffness: float = quantity(
        "1e-6 N mm/rad", "1e24 N mm/rad", "0.203e9 N mm/rad", meaning="stiffness of the input and of the output shaft, each"
    )


EFFECT = Effect(
    section="shafts",
    description="elastic torsion of the input and the output shaft",
    absent="pinion hub turned as prescribed, couple straight on the wheel",
    text=ShaftsText,
    data=Shafts,
    unknowns=("rotation of the pinion", "rotation of the output shaft's end"),
    terms=("torsional springs",),
    variables=(
        ResultVariable("shaft_end_rotation", "rad", "rotation of the output shaft's end"),
        ResultVariable("energy_shafts", "N mm", "elastic energy of the shafts"),
    ),
)
