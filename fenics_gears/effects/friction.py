"""``[friction]``: Coulomb friction between the flanks (``contact``)."""

from dataclasses import dataclass

from fenics_gears.effects.effect import OF_NODES, OF_PAIRS, Effect, ResultVariable
from fenics_gears.inputs.fields import Section, number


@dataclass(frozen=True)
class Friction:
    """Coulomb friction on the flanks."""

    coefficient: float


class FrictionText(Section):
    """``[friction]``."""

    coefficient: float = number(
        0.1,
        meaning="coefficient of friction on all flanks",
        above=0,
        highest=5,
        too_low="For a pair without friction, leave the section [friction] out.",
    )


EFFECT = Effect(
    section="friction",
    description="Coulomb friction between the flanks",
    absent="no friction, no tangential unknowns",
    text=FrictionText,
    data=Friction,
    unknowns=("tangential force of each closed contact node",),
    terms=("friction law with stick and slip",),
    variables=(
        ResultVariable("friction_force", "N", "friction force of the mesh, on the drive flanks"),
        ResultVariable("pair_friction_force", "N", "friction force of the tooth pair", dims=OF_PAIRS),
        ResultVariable("contact_traction", "MPa", "friction traction on the flank", dims=OF_NODES),
        ResultVariable("work_friction", "N mm", "energy lost to friction between the flanks"),
    ),
    # Between rigid flanks the pairs' shares of the force, and with them the friction, are not determined.
    needs=("tooth_elasticity",),
)
