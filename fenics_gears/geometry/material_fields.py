"""Fields of a material: its constants, or its name."""

from fenics_gears.inputs.fields import choice, number, quantity

from .gear_data import MATERIALS


def youngs_modulus(otherwise: str):
    return quantity("1 kPa to 1e9 GPa", "206 GPa", meaning="Young's modulus", otherwise=otherwise)


def poissons_ratio(otherwise: str):
    return number(0.3, meaning="Poisson's ratio", above=-1, below=0.5, otherwise=otherwise)


def material_name(otherwise: str):
    listed = "; ".join(
        f"{name} {each.youngs_modulus / 1e3:g} GPa, {each.poissons_ratio:g}"
        + (f", yield strength {each.yield_strength:g} MPa" if each.yield_strength else "")
        for name, (each, _) in MATERIALS.items()
    )
    return choice(
        *MATERIALS,
        meaning=f'material by name, also written `material = "steel"` in the section above: {listed}',
        otherwise=otherwise,
    )
