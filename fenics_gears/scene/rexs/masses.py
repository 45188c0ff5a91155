"""What the gears weigh, as discs. A scene has one mass and one moment of inertia for both shafts, so that the user has to choose."""

from __future__ import annotations

from math import pi

from fenics_gears.scene.rexs.gears import GearValues, PairValues
from fenics_gears.scene.rexs.reading import first_quantity, positive
from fenics_gears.scene.rexs.stage import GearParts
from fenics_gears.scene.rexs.values import Value

# In N s^2/mm (a tonne) and N mm s^2.
KILOGRAM, KILOGRAM_SQUARE_METRE = 1e-3, 1e3


def density_of(part: GearParts) -> Value | None:
    """The density of a gear's material; None where the file has none. Raises ValueProblem."""
    for material in part.materials[:1]:
        density = first_quantity([(material, "density")], "g / cm^3")
        return density and positive(density, material, "density")
    return None


def mass_in_words(density: Value, gear: GearValues, pair: PairValues) -> str:
    """Mass and moment of inertia of a ring from the bore to the reference circle."""
    outer, inner = pair.module.number * gear.teeth.number, gear.bore_diameter.number
    mass = density.number * 0.25 * pi * (outer**2 - inner**2) * pair.face_width.number
    inertia = mass * (outer**2 + inner**2) / 8.0
    return f"{mass / KILOGRAM:.4g} kg and {inertia / KILOGRAM_SQUARE_METRE:.4g} kg m^2 as a ring from its bore to its reference circle, with {density.origin}"
