"""Flank compliance of a gear that is wider than its mate: near the contact the load spreads over the common face,
further away over more."""

from dataclasses import replace
from math import pi

import numpy as np

from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.gear_data import Material
from fenics_gears.geometry.involute import arc_length

from .compliance import FlankCompliance
from .whole_body.compliance import WholeBodyCompliance

# Depth, in normal modules, down to which the load spreads over the common face alone; found together with
# `geometry.pair.OVERHANG_REACH`.
NEAR_DEPTH = 0.5

Section = FlankCompliance | WholeBodyCompliance


def with_overhang(body: Section, gear: Gear, material: Material, share: float) -> Section:
    """The body under a line load over the common face: `share` A + (1 - `share`) L. `share`: common width over the
    width that counts, 1 without overhang."""
    if share == 1.0:
        return body
    if isinstance(body, WholeBodyCompliance):
        near = [(1.0 - share) * near_field(gear, material, rolls) for rolls in body.roll_angles]
        blocks = tuple(
            (share * own + mine, *(share * each for each in others)) for (own, *others), mine in zip(body.blocks, near)
        )
        return replace(
            body, blocks=blocks, openings={tooth: share * opening for tooth, opening in body.openings.items()}
        )
    blocks = share * body.blocks
    near = (1.0 - share) * near_field(gear, material, body.roll_angle)
    dofs = 2 * body.nodes
    for first in range(0, blocks.shape[1], dofs):
        blocks[0, first : first + dofs, first : first + dofs] += near
    return replace(body, blocks=blocks, **({"across": share * body.across} if hasattr(body, "across") else {}))


def near_field(gear: Gear, material: Material, roll_angle: np.ndarray) -> np.ndarray:
    """L (2n, 2n), mm per N/mm: compliance of flank nodes against NEAR_DEPTH, by the half-plane's 2 (1 - nu^2)/(pi E)
    ln(depth/distance), averaged over what each node stands for.

    As a convex function that falls to zero the logarithm, cut off at that depth, is positive definite (Polya's
    criterion).
    """
    depth = NEAR_DEPTH * gear.normal_module
    arc = arc_length(gear.base_radius, roll_angle)
    edges = np.concatenate([arc[:1], 0.5 * (arc[1:] + arc[:-1]), arc[-1:]])
    low = edges[:-1]
    high = edges[1:]

    def twice_integrated(distance: np.ndarray) -> np.ndarray:
        distance = np.abs(distance)
        # Nothing is within no distance, for any module.
        parts = np.divide(depth, distance, out=np.ones_like(distance), where=distance > 0.0)
        within = 0.5 * distance**2 * (np.log(parts) + 1.5)
        return np.where(distance < depth, within, depth * (distance - 0.25 * depth))

    total = sum(
        sign * twice_integrated(one[:, None] - other)
        for sign, one, other in ((1, high, low), (-1, high, high), (-1, low, low), (1, low, high))
    )
    # Round-off is all that there is beyond the depth, and all that is not symmetric.
    apart = np.maximum(low[:, None] - high, (low[:, None] - high).T)
    mean = np.where(apart < depth, 0.5 * (total + total.T), 0.0) / np.outer(high - low, high - low)
    return 2.0 * (1.0 - material.poissons_ratio**2) / (pi * material.youngs_modulus) * np.kron(mean, np.eye(2))
