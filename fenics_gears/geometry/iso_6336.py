"""Tooth stiffness of pairs by ISO 6336-1, method B: solid steel gears, in plane with their face (C_R = 1).

The flexibility q' of an ideal pair (``c'th = 1/q'``), ``c' = 0.8 c'th C_R C_B cos(beta)`` adjusted to measurements, and
for the mesh ``c_gamma_alpha = c' (0.75 eps_alpha + 0.25)``.
"""

from math import cos, degrees, inf, sin

import numpy as np

from .gear_data import GearPairData, mean_youngs_modulus

STEEL_YOUNGS_MODULUS = 206e3
# The standard's tooth stiffness falls below this line load (N/mm), as its root of the fourth degree.
FULL_LINE_LOAD = 100.0
# Of the theory's stiffness, as measured (C_M).
MEASURED = 0.8


def single_stiffness(gears: GearPairData) -> tuple[float, float]:
    """c'th and c' (N/(mm um)) of one pair at its stiffest position, above 100 N/mm.

    >>> from fenics_gears import load_scene
    >>> print("c'th {:.1f}, c' {:.1f}".format(*single_stiffness(load_scene("demos/lundvall2004.toml").gears)))
    c'th 15.7, c' 12.4
    """
    beta = gears.helix_angle
    # Of the spur gears that the teeth of helical ones are like: z / (cos(beta_b)^2 cos(beta)).
    of_virtual = (1.0 - (sin(beta) * cos(gears.pressure_angle)) ** 2) * cos(beta)
    z1 = gears.pinion.teeth / of_virtual
    # An internal gear counts as a rack.
    z2 = gears.wheel.teeth / of_virtual if gears.wheel.teeth > 0 else inf
    x1 = gears.pinion.profile_shift
    x2 = gears.wheel.profile_shift
    flexibility = (
        0.04723 + 0.15551 / z1 + 0.25791 / z2 - 0.00635 * x1 - 0.11654 * x1 / z1
        - 0.00193 * x2 - 0.24188 * x2 / z2 + 0.00529 * x1**2 + 0.00182 * x2**2
    )  # fmt: skip
    dedenda = [
        gear.profile_shift + 0.5 * (gear.teeth / cos(beta) - gear.root_diameter / gears.module)
        for gear in gears.of_gears
    ]
    basic_rack = 1.0 + 0.5 * (1.2 - np.mean(dedenda))
    angle = 1.0 - 0.02 * (20.0 - degrees(gears.pressure_angle))
    return 1.0 / flexibility, float(MEASURED / flexibility * basic_rack * angle * cos(beta))


def pair_stiffness(gears: GearPairData, line_load: float) -> float:
    """c' b (N/mm) of one pair of the scene's materials, over the width at which they meet, under a line load (N/mm)."""
    low = (line_load / FULL_LINE_LOAD) ** 0.25 if 0.0 < line_load < FULL_LINE_LOAD else 1.0
    of_material = mean_youngs_modulus(gears.materials) / STEEL_YOUNGS_MODULUS
    return single_stiffness(gears)[1] * 1e3 * gears.face_width * of_material * low


def theoretical_stiffness(gears: GearPairData) -> float:
    """As `pair_stiffness` under a full load, without the factor that adjusts the theory to measurements (N/mm)."""
    return pair_stiffness(gears, FULL_LINE_LOAD) / MEASURED


def mesh_factor(pairs: float) -> float:
    """Stiffness of a mesh in parts of c' for a number of pairs: 0.75 pairs + 0.25; of the contact ratio
    c_gamma_alpha/c'.

    >>> mesh_factor(1), mesh_factor(2), mesh_factor(1.5) == (mesh_factor(1) + mesh_factor(2)) / 2
    (1.0, 1.75, True)
    """
    return 0.75 * pairs + 0.25
