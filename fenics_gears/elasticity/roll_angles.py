"""Roll angles of the nodes of a meshed flank."""

from __future__ import annotations

import numpy as np

from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.involute import arc_length, roll_angle_at_arc_length


def node_roll_angles(gear: Gear, vertices: np.ndarray, order: int) -> np.ndarray:
    """Roll angles (n,), rad, of the flank's nodes from its element vertices (k, 2), form circle to tip.

    A node between two vertices stands midway in arc length.
    """
    radius = np.linalg.norm(vertices, axis=1)
    # Round-off may put the first vertex a hair below the base circle, where the form circle can lie.
    vertex_angles = gear.roll_angle(np.maximum(radius, gear.base_radius))
    if order == 1:
        return vertex_angles
    length = arc_length(gear.base_radius, vertex_angles)
    nodes = np.empty(2 * len(length) - 1)
    nodes[::2] = vertex_angles
    nodes[1::2] = roll_angle_at_arc_length(gear.base_radius, 0.5 * (length[1:] + length[:-1]))
    return nodes
