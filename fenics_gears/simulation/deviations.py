"""Effects that change the gaps of a mesh cycle from step to step, such as run-out and flank errors."""

from __future__ import annotations

from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.effects import from_effects
from fenics_gears.model.model import Model


def deviating(model: Model, cycle: Cycle) -> Cycle:
    """The cycle with what the scene's effects add to its gaps from step to step."""
    gaps = from_effects(model.scene, "gaps", model)
    if not gaps:
        return cycle
    from fenics_gears.contact.deviating_cycle import DeviatingCycle

    return DeviatingCycle(cycle, gaps)
