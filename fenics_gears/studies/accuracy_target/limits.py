"""The settings that a target may choose: those that fit into memory and that a scene file may give; and what a run with them costs.

Costs are counts of what a run has to do, by the weights of `fenics_gears.model.cost`, so that a scene gets the same settings on every
machine. Only their ratios matter.
"""

from __future__ import annotations

from dataclasses import replace
from math import inf

import numpy as np

from fenics_gears.elasticity.element_sizes import DEFAULT_SIZES
from fenics_gears.errors import ComputationError
from fenics_gears.model import cost
from fenics_gears.model.cost import SECTOR_UNKNOWNS, flank_bytes, flank_unknowns, loaded_pairs, operator_bytes
from fenics_gears.model.model import MOST_STORED_BYTES, Model, model_of
from fenics_gears.model.resolution import NODE_SPACING
from fenics_gears.scene.data import Scene
from fenics_gears.scene.rules import FINEST_BODY, FINEST_ELEMENT
from fenics_gears.scene.schema import MOST_CONTACT_NODES

# Most memory for the contact operators and condensed flanks of a run.
MOST_BYTES = 4e9

Size = float | np.ndarray


class TargetNotReached(ComputationError):
    """No settings within the limits reach the target."""


class Limits:
    """Limits and costs of a scene's runs; its `[accuracy]` is empty.

    Sizes are those of flank elements (mm), body elements (parts of their default) and steps (mesh cycles), `length` that of the contact
    window (mm). Arrays of sizes are broadcast.
    """

    def __init__(self, scene: Scene, element: str):
        self._model: Model = model_of(scene)
        self._element, self._order = element, 2 if element.endswith("2") else 1
        self._friction, self._module = scene.friction is not None, scene.gears.module
        self._pairs = loaded_pairs(self._model)

    def cost(self, flank: Size, body: Size, step: Size, length: float) -> Size:
        """Cost of the whole run: meshing and condensing both gears, contact operators of a mesh cycle, all steps."""
        of_body, per_node = SECTOR_UNKNOWNS[self._element]
        total = 0.0
        for gear in (self._model.pair.pinion, self._model.pair.wheel):
            dofs = flank_unknowns(gear, self._order, flank)
            # In the plane half the size is four times as many.
            unknowns = of_body * np.asarray(body, dtype=float) ** -2 + 0.5 * per_node * dofs
            total = total + cost.GEAR + cost.UNKNOWN * unknowns + cost.FLANK_CUBE * dofs**3
        loaded, positions = self._pairs * self._nodes(flank, length), 1.0 / np.asarray(step, dtype=float)
        rows = loaded * (2 if self._friction else 1)
        of_step = cost.STEP + cost.ROWS_SQUARE * rows**2
        of_operator = cost.PAIR * self._pairs + cost.NODES_SQUARE * loaded**2
        return total + positions * (of_operator + self._model.scene.motion.mesh_cycles * of_step)

    def bytes_of(self, flank: Size, step: Size, length: float) -> Size:
        """Memory of contact operators over one mesh cycle, and of both gears."""
        rows = self._pairs * self._nodes(flank, length) * (2 if self._friction else 1)
        gears = (self._model.pair.pinion, self._model.pair.wheel)
        return operator_bytes(1.0 / step, rows, self._friction) + sum(flank_bytes(flank_unknowns(gear, self._order, flank)) for gear in gears)

    def stored_bytes(self, flank: Size, step: Size, length: float) -> Size:
        """Size of the scene's own result: curves of all steps, and the contact fields that it stores."""
        grid, steps = self._model.resolution.contact_grid, self._model.resolution.steps_per_mesh_cycle
        curves = replace(self._model, contact_cycles=0).stored_bytes
        fields = self._model.stored_bytes - curves
        return (curves + fields * self._nodes(flank, length) / grid.nodes) / (step * steps)

    def too_fine(self, flank: Size, body: Size, length: float) -> Size:
        """Whether elements or contact nodes are finer than a scene file may ask for."""
        body_size = body * DEFAULT_SIZES[self._order].body * self._module
        too_fine = (flank < FINEST_ELEMENT * self._module) | (body_size < FINEST_BODY * self._module)
        return too_fine | (body_size < flank) | (self._nodes(flank, length) > MOST_CONTACT_NODES)

    def allowed(self, flank: Size, body: Size, step: Size, length: float, stored: bool = True) -> Size:
        """Whether a run may have these sizes; `stored`: with the whole of its result, as the run that is asked for has it."""
        held = (self.bytes_of(flank, step, length) <= MOST_BYTES) & ~np.asarray(self.too_fine(flank, body, length))
        return held & (self.stored_bytes(flank, step, length) <= (MOST_STORED_BYTES if stored else inf))

    def why_not(self, flank: float, body: float, length: float) -> str:
        """Which limit a run exceeds, in words that follow "the next halving of ..."."""
        if self.too_fine(flank, body, length):
            return f"takes elements or contact nodes finer than a scene may ask for ({FINEST_ELEMENT:g} modules on the flank, {MOST_CONTACT_NODES} nodes)"
        return f"takes more than {MOST_BYTES / 1e9:g} GB for contact operators and gears"

    def _nodes(self, flank: Size, length: float) -> Size:
        return length / (NODE_SPACING * flank) + 2.0
