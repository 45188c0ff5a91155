"""What a run costs, counted from what it has to do: the same scene chooses the same settings on every machine.

The counts and their weights are those of `fenics_gears.model.cost`, here of any sizes at once; only their ratios matter.
"""

from __future__ import annotations

import numpy as np

from fenics_gears.model import cost
from fenics_gears.model.cost import SECTOR_UNKNOWNS, Number, flank_unknowns, loaded_pairs
from fenics_gears.model.model import Model


def run_cost(model: Model, element: str, flank: Number, body: Number, step: Number, nodes: Number) -> np.ndarray:
    """Cost of a run; sizes of flank elements (mm), body elements (parts of their default), steps (mesh cycles), and the contact nodes of a
    tooth pair: arrays are broadcast. `model`: the scene's, for its gears, effects and mesh cycles."""
    of_body, per_node = SECTOR_UNKNOWNS[element]
    total = 0.0
    for gear in (model.pair.pinion, model.pair.wheel):
        dofs = flank_unknowns(gear, 2 if element.endswith("2") else 1, flank)
        # In the plane half the size is four times as many.
        unknowns = of_body * np.asarray(body, dtype=float) ** -2 + 0.5 * per_node * dofs
        total = total + cost.GEAR + cost.UNKNOWN * unknowns + cost.FLANK_CUBE * dofs**3
    pairs, positions = loaded_pairs(model), 1.0 / np.asarray(step, dtype=float)
    loaded = pairs * nodes
    rows = loaded * (1 if model.scene.friction is None else 2)
    of_step = cost.STEP + cost.ROWS_SQUARE * rows**2
    return total + positions * (cost.PAIR * pairs + cost.NODES_SQUARE * loaded**2 + model.scene.motion.mesh_cycles * of_step)
