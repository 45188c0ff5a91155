"""``[gears.material]``: elastic teeth and gear bodies (``elasticity``); without it the flanks are rigid
(``contact.rigid_mesh``)."""

from collections.abc import Sequence
from dataclasses import dataclass

from fenics_gears.geometry.gear_data import MATERIALS, Material, material_name, poissons_ratio, youngs_modulus
from fenics_gears.inputs.fields import quantity
from fenics_gears.inputs.problem import Broken
from fenics_gears.inputs.section import Section, allowed_in
from fenics_gears.inputs.tree import GEARS, Tree, material_sections, table

from .effect import OF_NODES, OF_TIME, Effect, variables

CONSTANTS = ("youngs_modulus", "poissons_ratio")


def _yield_strength(otherwise: str):
    return quantity(
        "1 kPa to 1e3 GPa",
        "650 MPa",
        meaning="yield strength, above which a stress is remarked; nothing else follows from it",
        otherwise=otherwise,
    )


@dataclass(frozen=True)
class MaterialText(Section):
    """``[gears.material]``: material of both gears, by `name` or by both constants. Without this section the flanks are
    rigid."""

    name: str | None = material_name("both constants are required")
    youngs_modulus: float | None = youngs_modulus("that of the `name`")
    poissons_ratio: float | None = poissons_ratio("that of the `name`")
    yield_strength: float | None = _yield_strength("that of the `name`, if it has one")


@dataclass(frozen=True)
class OwnMaterialText(Section):
    """``[gears.pinion.material]`` and ``[gears.wheel.material]``; fields that are left out are taken from
    ``[gears.material]``."""

    name: str | None = material_name("from `[gears.material]`")
    youngs_modulus: float | None = youngs_modulus("that of the `name`, or from `[gears.material]`")
    poissons_ratio: float | None = poissons_ratio("that of the `name`, or from `[gears.material]`")
    yield_strength: float | None = _yield_strength(
        "that of the `name`, if it has one; from `[gears.material]` where this section names no other material"
    )


def material_of(*texts: MaterialText | OwnMaterialText | None) -> Material | None:
    """The material of sections of which an earlier one goes before a later one; None where the first is not there."""
    if texts[0] is None:
        return None
    there = [text for text in texts if text is not None]
    stated = [each for text in there for each in (text, MATERIALS[text.name][0] if text.name is not None else text)]
    modulus, ratio = (
        next(float(value) for each in stated if (value := getattr(each, constant)) is not None)
        for constant in CONSTANTS
    )
    return Material(modulus, ratio, _yield_strength_of(there))


def _yield_strength_of(texts: Sequence[MaterialText | OwnMaterialText]) -> float | None:
    """That of the first section which has one or is of another material than those behind it."""
    for text in texts:
        if text.yield_strength is not None:
            return float(text.yield_strength)
        if text.name is not None or text.youngs_modulus is not None:
            return None if text.name is None else MATERIALS[text.name][0].yield_strength
    return None


def materials_are_complete(tree: Tree) -> Broken:
    """Both gears are elastic or none, and an elastic one has both constants."""
    gears = table(tree, "gears") or {}
    shared = table(gears, "material")
    for name in CONSTANTS if shared is not None and "name" not in shared else ():
        if name not in shared:
            allowed = allowed_in(MaterialText, name).description
            message = f'is missing. Allowed: {allowed}; or a material by name, such as name = "steel".'
            yield ("gears", "material", name), message
    if "material" in gears or not material_sections(tree):
        return
    for gear in GEARS:
        own = table(gears, gear)
        if own is None or not any(path[1] == gear for path in material_sections(tree)):
            message = "is missing: both gears are elastic or none. Add it, or [gears.material] for both gears."
            yield ("gears", gear, "material"), message
            continue
        written = table(own, "material")
        for name in CONSTANTS if written is not None and "name" not in written else ():
            if name not in written:
                message = "is missing. Add it, or [gears.material] with what both gears share."
                yield ("gears", gear, "material", name), message


EFFECT = Effect(
    section="tooth_elasticity",
    within=("gears", "material"),
    description="elastic teeth and gear bodies",
    absent="rigid flanks: kinematic transmission error, no pressures; forces of tooth pairs only where a single pair"
    " touches",
    fields=MaterialText,
    read=material_of,
    unknowns=("normal force of each closed contact node",),
    terms=("compliance of the flanks",),
    variables=(
        *variables(
            OF_TIME,
            energy_teeth=("N mm", "elastic energy of the gears"),
            mesh_stiffness=(
                "N/mm",
                "mesh stiffness: mesh force divided by the deflection of the flanks; not a number (NaN) where these do"
                " not approach, pressed by wedges and friction alone",
            ),
            mesh_stiffness_tangent=("N/mm", "tangent mesh stiffness: change of mesh force over change of deflection"),
            loaded_pairs=("1", "number of loaded tooth pairs"),
            largest_contact_pressure=(
                "MPa",
                "largest contact pressure, averaged over five nodes, without edges and kinks",
            ),
            largest_contact_pressure_pair=(
                "1",
                "number of the tooth pair with the largest contact pressure; 0 if none",
            ),
            largest_contact_pressure_roll_angle=("rad", "roll angle of the pinion at the largest contact pressure"),
            largest_edge_pressure=(
                "MPa",
                "largest pressure at edges of tips and of undercut flanks: within two Hertz half-widths of one, of"
                " pairs that press with one, or in three dimensions near the ends of the face; it does not converge as"
                " the mesh is refined",
            ),
        ),
        *variables(
            OF_NODES,
            contact_pressure=("MPa", "contact pressure at the node, not averaged"),
            contact_offset=("mm", "offset of the contact node from the line of action, towards the pinion"),
            contact_roll_angle=("rad", "roll angle of the contact node on the pinion's flank"),
        ),
    ),
    rules=materials_are_complete,
)
