"""What opens the contact nodes of a model: on the contact operators that models which differ in nothing else share."""

from __future__ import annotations

from fenics_gears.contact.mesh_cycle import Cycle, Gaps
from fenics_gears.contact.tooth_pair import Removal
from fenics_gears.effects import ALONG_THE_FACE, effects_on, from_effects
from fenics_gears.model.model import Model
from fenics_gears.simulation.routes import CONDENSED, route_of


def gaps_apart(model: Model) -> bool:
    """Whether contact operators are those of any gaps: on elastic flanks that are alike on all teeth."""
    return route_of(model) is CONDENSED and not any(effect.elasticity for effect in effects_on(model.scene))


def reliefs_apart(model: Model) -> bool:
    """Whether reliefs, too, change nothing but gaps: they also move the point at which a tip's edge touches."""
    return gaps_apart(model) and model.corner is None


def removal_of_nodes(model: Model) -> tuple[Removal | None, Removal | None]:
    """Material taken from the flanks as their contact nodes are placed; what opens gaps alone is left to `gaps_of`."""
    return (None, None) if reliefs_apart(model) else model.removal


def sections_of_gaps(model: Model) -> tuple[str, ...]:
    """The sections of a scene in which models may differ that share contact operators."""
    if not gaps_apart(model):
        return ()
    reliefs, named = reliefs_apart(model), effects_on(model.scene)
    return *ALONG_THE_FACE, *(each.section for each in named if each.gaps or each.removal and reliefs)


def gaps_of(model: Model, cycle: Cycle) -> Gaps:
    """What opens the contact nodes of a cycle of the model, or of one that shares its contact operators."""
    profile, openings = None, ()
    if model.removal != (None, None) and reliefs_apart(model):
        # Imported here: true involutes have none.
        from fenics_gears.contact.relief_gaps import profile_of

        profile = profile_of(cycle, model.removal)
    if cycle.face.slices > 1:
        # Imported here: plane scenes have none.
        from fenics_gears.contact.face_mesh import opening_over_face

        openings = (opening_over_face(cycle, model.face_opening, model.coast_face_opening),)
    return Gaps(profile, openings, tuple(from_effects(model.scene, "gaps", model)))
