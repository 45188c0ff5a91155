"""What settings a target may choose: those that memory holds and that a scene file could ask for itself; and what they cost."""

from __future__ import annotations

from dataclasses import replace
from math import inf

import numpy as np

from fenics_gears.elasticity.element_sizes import DEFAULT_SIZES
from fenics_gears.errors import ComputationError
from fenics_gears.model.cost import flank_bytes, flank_unknowns, loaded_pairs, operator_bytes
from fenics_gears.model.model import MOST_STORED_BYTES, Model, model_of
from fenics_gears.model.resolution import NODE_SPACING
from fenics_gears.scene.data import Scene
from fenics_gears.scene.rules import FINEST_BODY, FINEST_ELEMENT
from fenics_gears.scene.schema import MOST_CONTACT_NODES
from fenics_gears.studies.accuracy_target.cost import run_cost

# Contact operators and condensed flanks of a run.
MOST_BYTES = 4e9

Size = float | np.ndarray


class TargetNotReached(ComputationError):
    """No settings that this program may use reach the target."""


class Limits:
    """Of a scene whose `[accuracy]` is empty; sizes are of flank elements (mm), body elements (parts of their default), steps (mesh cycles)."""

    def __init__(self, scene: Scene, element: str):
        self._model: Model = model_of(scene)
        self._element, self._order = element, 2 if element.endswith("2") else 1
        self._friction, self._module = scene.friction is not None, scene.gears.module
        self._pairs = loaded_pairs(self._model)

    def cost(self, flank: Size, body: Size, step: Size, length: float) -> Size:
        """Of the whole run; see ``run_cost``."""
        return run_cost(self._model, self._element, flank, body, step, self._nodes(flank, length))

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
        """What of a run is beyond the limits, in words that follow "the next halving of ..."."""
        if self.too_fine(flank, body, length):
            return f"takes elements or contact nodes finer than a scene may ask for ({FINEST_ELEMENT:g} modules on the flank, {MOST_CONTACT_NODES} nodes)"
        return f"takes more than {MOST_BYTES / 1e9:g} GB for contact operators and gears"

    def _nodes(self, flank: Size, length: float) -> Size:
        return length / (NODE_SPACING * flank) + 2.0
