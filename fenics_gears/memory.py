"""What a run holds in memory, told before it: the contact operators of its mesh cycles and the condensed flanks of its gears."""

from __future__ import annotations

import numpy as np

from fenics_gears.contact.mesh_cycle import pair_places
from fenics_gears.geometry.gear import Gear
from fenics_gears.model import Model

BYTES_OF_A_NUMBER = 8.0
# Matrices of a flank's size that are held while its teeth are joined, and the tangential rows' own products (measured).
MATRICES_OF_A_FLANK, OPERATORS_WITH_FRICTION = 10.0, 1.5


def loaded_pairs(built: Model) -> float:
    """Tooth pairs in contact windows, on the average over the mesh cycle."""
    grid = built.resolution.contact_grid
    pairs = [len(pair_places(built.pair, grid, phase / 16, built.scene.coast_flanks is not None, built.corner)) for phase in range(16)]
    return sum(pairs) / len(pairs)


def operator_bytes(positions: float | np.ndarray, rows: float | np.ndarray, friction: bool) -> float | np.ndarray:
    """Of the contact operators at a number of positions; `rows` count normal and tangential ones."""
    return BYTES_OF_A_NUMBER * positions * rows**2 * (OPERATORS_WITH_FRICTION if friction else 1.0)


def flank_unknowns(gear: Gear, order: int, size: float | np.ndarray) -> float | np.ndarray:
    """Displacements of a flank's nodes; `order` of the element, its `size` in mm."""
    arc = 0.5 * gear.base_radius * (gear.tip_roll_angle**2 - gear.form_roll_angle**2)
    return 2.0 * (order * arc / size + 1.0)


def flank_bytes(unknowns: float | np.ndarray) -> float | np.ndarray:
    """Of a gear that is condensed onto so many displacements of a flank."""
    return BYTES_OF_A_NUMBER * MATRICES_OF_A_FLANK * unknowns**2
