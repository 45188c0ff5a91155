"""A pressure on a tooth's flank as consistent forces on its nodes."""

import numpy as np

from fenics_gears.elasticity.element_nodes import node_roll_angles
from fenics_gears.geometry.involute import arc_length, canonical_normal, roll_angle_at_arc_length

POINTS, WEIGHTS = np.polynomial.legendre.leggauss(6)


def flank_arcs(recovery) -> np.ndarray:
    """Arc lengths (f,), mm, of the drive flank's nodes from the base circle."""
    gear, order = recovery.gear, recovery.sector.section.order
    points = recovery.points[recovery.sector.flank_nodes("flank")]
    return arc_length(gear.base_radius, node_roll_angles(gear, points[::order], order))


def pressed(recovery, pressure) -> np.ndarray:
    """Line forces (2 f,), N/mm, of a pressure (MPa), a function of the arc length (mm)."""
    arcs, order = flank_arcs(recovery), recovery.sector.section.order
    forces = np.zeros((len(arcs), 2))
    for first in range(0, len(arcs) - 1, order):
        low, high = arcs[first], arcs[first + order]
        local = 0.5 * (POINTS + 1.0)
        at = low + (high - low) * local
        if order == 1:
            shapes = np.array([1.0 - local, local])
        else:
            shapes = np.array([(1 - local) * (1 - 2 * local), 4 * local * (1 - local), local * (2 * local - 1)])
        traction = -pressure(at)[:, None] * canonical_normal(roll_angle_at_arc_length(recovery.gear.base_radius, at))
        forces[first : first + order + 1] += 0.5 * (high - low) * (shapes * WEIGHTS) @ traction
    return forces.ravel()
