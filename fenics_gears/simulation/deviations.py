"""Effects that change the gaps of a mesh cycle from step to step, such as run-out and flank errors."""

from __future__ import annotations

from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.effects import effects_on
from fenics_gears.model.model import Model


def deviating(model: Model, cycle: Cycle) -> Cycle:
    """The cycle with the gaps that the scene's effects add at each step; the cycle itself where none does."""
    scene = model.scene
    effects = [effect for effect in effects_on(scene) if effect.gaps is not None]
    if not effects:
        return cycle
    from fenics_gears.contact.deviating_cycle import DeviatingCycle

    return DeviatingCycle(cycle, [effect.gaps(getattr(scene, effect.section), model) for effect in effects])
