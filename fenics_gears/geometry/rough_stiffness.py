"""A rough stiffness of a tooth pair, for natural frequencies, damping ratios and default accuracy settings."""

from __future__ import annotations

from fenics_gears.geometry.gear_data import Material

# ISO 6336-1 puts the stiffness of a steel tooth pair near 14 N/(mm um); in parts of Young's modulus.
PAIR_STIFFNESS = 14e3 / 206e3


def mean_youngs_modulus(materials: tuple[Material, Material]) -> float:
    """E (MPa) of a pair of two materials as ISO 6336-1 takes it: 2 E1 E2/(E1 + E2)."""
    first, second = (material.youngs_modulus for material in materials)
    return 2.0 * first * second / (first + second) if first != second else first


def rough_pair_stiffness(materials: tuple[Material, Material], face_width: float) -> float:
    """Stiffness (N/mm) of one tooth pair along the line of action, about 14 N/(mm um) for steel; `face_width` in mm."""
    return PAIR_STIFFNESS * mean_youngs_modulus(materials) * face_width
