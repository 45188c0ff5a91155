"""What a run costs, counted from what it has to do: the same scene chooses the same settings on every machine.

Gears: nodes of a sector mesh and the cube of a flank's displacements, which are condensed. March: contact operators at every position of a mesh
cycle, by the square of their rows, and the steps of the whole run. Each count has a weight, what it took on one core of 2020s (s); only their
ratios matter here.
"""

from __future__ import annotations

import numpy as np

from fenics_gears.memory import flank_unknowns, loaded_pairs
from fenics_gears.model import Model

# Displacements of a sector mesh of second order: those of tooth and rim at the default body size, and for each of a flank.
BODY_UNKNOWNS, UNKNOWNS_PER_FLANK = 2300.0, 15.0
PER_GEAR, PER_UNKNOWN, PER_FLANK_CUBE = 0.025, 2e-5, 3e-10
PER_POSITION, PER_ROW_SQUARE, PER_STEP = 1.5e-3, 8e-8, 2e-4

Size = float | np.ndarray


def run_cost(built: Model, order: int, flank: Size, body: Size, step: Size, nodes: Size) -> np.ndarray:
    """Cost of a run; sizes of flank elements (mm), body elements (parts of their default), steps (mesh cycles), and the contact nodes of a
    tooth pair: arrays are broadcast. `built`: the scene's, for its gears, effects and mesh cycles."""
    flanks = 1.0 if built.scene.coast_flanks is None else 2.0
    total = 0.0
    for gear in (built.pair.pinion, built.pair.wheel):
        displacements = flanks * flank_unknowns(gear, order, flank)
        unknowns = BODY_UNKNOWNS * np.asarray(body, dtype=float) ** -2 + UNKNOWNS_PER_FLANK * displacements
        total = total + PER_GEAR + PER_UNKNOWN * unknowns + PER_FLANK_CUBE * displacements**3
    rows = loaded_pairs(built) * nodes * (1 if built.scene.friction is None else 2)
    positions = 1.0 / np.asarray(step, dtype=float)
    return total + positions * (PER_POSITION + PER_ROW_SQUARE * rows**2 + PER_STEP * built.scene.motion.mesh_cycles)
