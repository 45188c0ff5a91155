"""``[friction]``: Coulomb friction between the flanks (``contact``), with a coefficient that is given or follows from a
formula."""

from dataclasses import dataclass

from fenics_gears.errors import SceneError
from fenics_gears.inputs.fields import choice, number, quantity
from fenics_gears.inputs.problem import Broken
from fenics_gears.inputs.section import Section, allowed_in
from fenics_gears.inputs.tree import Tree, quantity_at, table
from fenics_gears.inputs.written import as_written

from .effect import OF_NODES, OF_PAIRS, OF_TIME, Effect, variables

OF_A_FORMULA = ("viscosity", "roughness")


@dataclass(frozen=True)
class Friction(Section):
    """``[friction]``: one coefficient on all flanks, given, or computed once from the mean load and the speed of the
    scene."""

    alternatives = (("coefficient", "formula"),)

    coefficient: float | None = number(
        0.1,
        meaning="coefficient of friction on all flanks",
        above=0,
        highest=5,
        otherwise="from `formula`; one of the two is required",
        too_low="For a pair without friction, leave the section [friction] out.",
    )
    formula: str | None = choice(
        "Schlenk",
        "Benedict and Kelley",
        meaning="formula of the mean coefficient of oiled steel flanks: Schlenk's at the pitch point (ISO/TR 14179-2,"
        " mineral oil), for pitch line speeds from 1 m/s, those above 50 m/s counted as 50, and line loads below 150"
        " N/mm as 150; or that of Benedict and Kelley (1961), averaged over the path of contact, for mixed lubrication",
        otherwise="`coefficient`",
    )
    viscosity: float | None = quantity(
        "0.1 mPa s to 100 Pa s",
        "13 mPa s",
        meaning="dynamic viscosity of the oil at its temperature in the mesh, for `formula`",
        otherwise="required with `formula`",
    )
    roughness: float | None = quantity(
        "0.01 um to 20 um",
        "0.4 um",
        meaning="arithmetic mean roughness Ra of both flanks, for `formula`",
        otherwise="required with `formula`",
    )

    def coefficient_of(self, scene, pair) -> float:
        """The coefficient in a scene. Raises SceneError for a formula that is not for its load and speed."""
        if self.formula is None:
            return self.coefficient
        from fenics_gears.geometry.friction_formulas import FORMULAS, OutOfRange

        force = pair.force_of(scene.load.wheel_torque)
        speed = 60.0 * scene.motion.mesh_frequency / pair.pinion.teeth
        try:
            return FORMULAS[self.formula](pair, force, speed, self.viscosity * 1e9, self.roughness * 1e3)
        except OutOfRange as error:
            raise SceneError(
                f"friction.formula = {as_written(self.formula)}: {error}\nNothing was computed or written."
            ) from None


def coefficient_or_formula(tree: Tree) -> Broken:
    """There is one of the two, and a formula has what it needs, a speed among it."""
    friction = table(tree, "friction")
    if friction is None:
        return
    formula = friction.get("formula")
    if "coefficient" not in friction and formula is None:
        allowed = allowed_in(Friction, "coefficient").description
        message = f'is missing. Allowed: {allowed}; or formula = "Schlenk" with viscosity and roughness.'
        yield ("friction", "coefficient"), message
    for name in OF_A_FORMULA:
        if formula is None and name in friction:
            yield ("friction", name), "is for a formula. Add formula, or leave it out."
        if formula is not None and name not in friction:
            yield ("friction", name), "is missing; friction.formula needs it."
    if formula is None:
        return
    if 0.0 in (quantity_at(tree, "load", name) for name in ("wheel_torque", "pinion_torque")):
        yield ("friction", "formula"), "has no meaning without a load. Give a torque, or a coefficient."
    if not {"mesh_frequency", "pinion_speed"} & set(table(tree, "motion") or {}):
        message = 'needs a speed. Add motion.pinion_speed, such as "1500 rpm", or motion.mesh_frequency.'
        yield ("friction", "formula"), message


EFFECT = Effect(
    section="friction",
    description="Coulomb friction between the flanks",
    absent="no friction, no tangential unknowns",
    fields=Friction,
    unknowns=("tangential force of each closed contact node",),
    terms=("friction law with stick and slip",),
    variables=(
        *variables(
            OF_TIME,
            friction_force=("N", "friction force of the mesh, on the drive flanks"),
            work_friction=("N mm", "energy lost to friction between the flanks"),
        ),
        *variables(OF_PAIRS, pair_friction_force=("N", "friction force of the tooth pair")),
        *variables(OF_NODES, contact_traction=("MPa", "friction traction on the flank")),
    ),
    rules=coefficient_or_formula,
    check=Friction.coefficient_of,
    # Between rigid flanks the pairs' shares of the force, and with them the friction, are not determined.
    needs=("tooth_elasticity",),
)
