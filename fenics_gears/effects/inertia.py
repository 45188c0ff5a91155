"""``[inertia]``: mass and moment of inertia; the march in time becomes dynamic (``dynamics``)."""

from dataclasses import dataclass

from fenics_gears.effects.effect import Effect, ResultVariable
from fenics_gears.scene.fields import Section, quantity


@dataclass(frozen=True)
class Inertia:
    """Mass of a gear, N s^2/mm, and moment of inertia, N mm s^2; one value for both gears."""

    mass: float
    moment_of_inertia: float


class InertiaText(Section):
    """``[inertia]``: lumped at the centres, alike for both gears."""

    mass: float = quantity("1e-9 kg", "1e9 kg", "4.9 kg", meaning="mass of a gear, with its shaft")
    moment_of_inertia: float = quantity(
        "1e-15 kg m^2", "1e15 kg m^2", "24.5e-3 kg m^2", meaning="moment of inertia of a gear, and of the output shaft's end"
    )


EFFECT = Effect(
    section="inertia",
    description="mass and moment of inertia of gears and shafts",
    absent="quasi-static",
    text=InertiaText,
    data=Inertia,
    terms=("inertia forces, average acceleration in time",),
    variables=(ResultVariable("energy_kinetic", "N mm", "kinetic energy"),),
)
