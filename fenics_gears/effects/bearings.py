"""``[bearings]``: elastic support of the gear centres (``dynamics.drivetrain``)."""

from dataclasses import dataclass

from fenics_gears.effects.effect import Effect, ResultVariable
from fenics_gears.scene.fields import Section, quantity


@dataclass(frozen=True)
class Bearings:
    """Translational stiffness of either shaft's support, N/mm."""

    stiffness: float


class BearingsText(Section):
    """``[bearings]``."""

    stiffness: float = quantity("1e-6 N/mm", "1e20 N/mm", "0.155e6 N/mm")


EFFECT = Effect(
    section="bearings",
    description="elastic support of the gear centres",
    absent="centres fixed",
    text=BearingsText,
    data=Bearings,
    unknowns=("two displacements of each centre",),
    terms=("translational springs",),
    variables=(
        ResultVariable("centre_x", "mm", "displacement of the centre along the line of action"),
        ResultVariable("centre_y", "mm", "displacement of the centre off the line of action"),
        ResultVariable("energy_bearings", "N mm", "elastic energy of the bearings"),
    ),
)
