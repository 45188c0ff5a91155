"""How stiff a tooth pair is, about: for natural frequencies, damping ratios and defaults of the accuracy."""

from __future__ import annotations

from math import inf

from fenics_gears.scene.data import GearPairData, Scene

# ISO 6336-1 puts the stiffness of a steel tooth pair near 14 N/(mm um); in parts of Young's modulus.
PAIR_STIFFNESS = 14e3 / 206e3


def mean_youngs_modulus(gears: GearPairData) -> float:
    """E (MPa) of a pair of two materials as ISO 6336-1 takes it: 2 E1 E2/(E1 + E2)."""
    first, second = (material.youngs_modulus for material in gears.materials)
    return 2.0 * first * second / (first + second) if first != second else first


def mesh_stiffness(scene: Scene) -> float:
    """Rough stiffness (N/mm) of one tooth pair along the line of action, about 14 N/(mm um) for steel; infinite if rigid."""
    return inf if scene.tooth_elasticity is None else PAIR_STIFFNESS * mean_youngs_modulus(scene.gears) * scene.gears.face_width
