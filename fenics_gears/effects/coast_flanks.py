"""``[coast_flanks]``: contact on the unloaded flanks (``contact.tooth_pair``)."""

from dataclasses import dataclass

from fenics_gears.inputs.problem import Broken
from fenics_gears.inputs.section import Section
from fenics_gears.inputs.tree import Tree, value_at

from .effect import OF_NODES, OF_PAIRS, OF_SLICES, OF_TIME, Effect, ResultVariable, variables


@dataclass(frozen=True)
class CoastFlanks(Section):
    """``[coast_flanks]``: this section has no fields."""


def flanks_are_there(tree: Tree) -> Broken:
    """Remeshing at every step does not have the coast flanks."""
    if value_at(tree, "accuracy", "condensation") == "every step" and "coast_flanks" in tree:
        message = 'has no contact on the coast flanks. Take "once", or leave the section [coast_flanks] out.'
        yield ("accuracy", "condensation"), message


EFFECT = Effect(
    section="coast_flanks",
    description="contact on the coast flanks, with the backlash that follows from the gear data",
    absent="contact on the drive flanks only",
    fields=CoastFlanks,
    unknowns=("normal force of each closed contact node on the coast flanks",),
    terms=("contact along the coast flanks' own line of action",),
    variables=(
        *variables(
            OF_TIME,
            coast_normal_force=("N", "contact force of the coast flanks along their line of action"),
            drive_flank_opening=("mm", "smallest gap between the drive flanks"),
            coast_flank_opening=("mm", "smallest gap between the coast flanks"),
        ),
        *variables(
            OF_PAIRS, pair_coast_normal_force=("N", "contact force of the coast flank of the pair's pinion tooth")
        ),
        *variables(
            OF_SLICES,
            over_face=True,
            coast_line_load=(
                "N/mm",
                "contact force of the coast flank of the pair's pinion tooth along the contact normal, per length of"
                " the face",
            ),
        ),
        *variables(
            OF_NODES,
            "tooth_elasticity",
            coast_contact_pressure=("MPa", "contact pressure on the coast flanks"),
            coast_contact_roll_angle=("rad", "roll angle of the contact node on the pinion's coast flank"),
        ),
        ResultVariable("coast_friction_force", "N", "friction force of the coast flanks", "friction"),
        ResultVariable("coast_contact_traction", "MPa", "friction traction on the coast flanks", "friction", OF_NODES),
    ),
    rules=flanks_are_there,
)
