"""Natural frequencies of the drivetrain with the mesh as a spring along the line of action."""

from __future__ import annotations

from math import pi

import numpy as np
from scipy.linalg import eigh

from fenics_gears.dynamics.drivetrain import Drivetrain

# Relative normal displacement of the flanks per coordinate; see contact.operator.rigid_rows.
MESH_DIRECTION = {"centre_x1": 1.0, "rotation_1": 1.0, "centre_x2": -1.0, "rotation_2": 1.0}


def natural_frequencies(drivetrain: Drivetrain, mesh_stiffness: float) -> np.ndarray:
    """Natural frequencies (k,), Hz, ascending, of a drivetrain with inertia and a mesh stiffness (N/mm)."""
    normal = np.array([MESH_DIRECTION.get(name, 0.0) for name in drivetrain.coordinates])
    stiffness = drivetrain.stiffness + mesh_stiffness * np.outer(normal, normal)
    return np.sqrt(np.maximum(eigh(stiffness, drivetrain.mass, eigvals_only=True), 0.0)) / (2.0 * pi)
