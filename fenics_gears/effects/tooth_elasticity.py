"""``[gears.material]``: teeth and gear bodies that give way (``elasticity``); without it the flanks are rigid (``contact.rigid_cycle``)."""

from dataclasses import dataclass

from fenics_gears.effects.effect import OF_NODES, Effect, ResultVariable
from fenics_gears.scene.fields import Section, number, quantity


@dataclass(frozen=True)
class Material:
    """Isotropic linear elasticity; Young's modulus in MPa."""

    youngs_modulus: float
    poissons_ratio: float


class MaterialText(Section):
    """``[gears.material]``."""

    youngs_modulus: float = quantity("1 kPa", "1e9 GPa", "206 GPa", meaning="Young's modulus")
    poissons_ratio: float = number(0.3, meaning="Poisson's ratio", above=-1, below=0.5)


EFFECT = Effect(
    section="tooth_elasticity",
    within=("gears", "material"),
    description="elastic teeth and gear bodies",
    absent="rigid flanks: kinematic transmission error, and no pressures; forces of single pairs where only one leads",
    text=MaterialText,
    data=Material,
    unknowns=("normal force of each closed contact node",),
    terms=("compliance of the flanks",),
    variables=(
        ResultVariable("energy_teeth", "N mm", "elastic energy of the gears"),
        ResultVariable("mesh_stiffness", "N/mm", "mesh stiffness: force of the mesh over the deflection of the flanks"),
        ResultVariable("mesh_stiffness_tangent", "N/mm", "tangent mesh stiffness: change of the force over change of the deflection"),
        ResultVariable("loaded_pairs", "1", "tooth pairs that carry"),
        ResultVariable("largest_contact_pressure", "MPa", "largest contact pressure, averaged over five contact nodes, off the flanks' edges"),
        ResultVariable("largest_contact_pressure_pair", "1", "tooth pair with the largest contact pressure; 0 where nothing touches"),
        ResultVariable("largest_contact_pressure_roll_angle", "rad", "roll angle of the largest contact pressure on the pinion's flank"),
        ResultVariable("largest_edge_pressure", "MPa", "largest pressure of pairs that press with a tip's edge; it does not converge with the mesh"),
        ResultVariable("contact_pressure", "MPa", "contact pressure of the node, not averaged", dims=OF_NODES),
        ResultVariable("contact_offset", "mm", "offset of the contact node from the line of action, towards the pinion", dims=OF_NODES),
        ResultVariable("contact_roll_angle", "rad", "roll angle of the contact node on the pinion's flank", dims=OF_NODES),
    ),
)
