"""A gear that is cut into an elastic shaft gives way within its face: the motions of its axis as compliance of its
flanks (`dynamics.elastic_shaft_seat`)."""

from __future__ import annotations

import numpy as np

from fenics_gears.elasticity.face_compliance_data import FaceCompliance
from fenics_gears.elasticity.slice_compliance import Addition
from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.involute import canonical_point
from fenics_gears.geometry.outline import centreline_angle

SIX = 6


def seat_motions(weights: np.ndarray, body: FaceCompliance, gear: Gear, twist: float) -> Addition:
    """Adds to the compliance of slices what the body's axis gives way.

    `weights` (S, h): of its heights in slices. `twist` (rad/mm): of the gear's section along z. Shaft and bearings are
    alike in all directions, so that only the angle between two sections matters.
    """
    nodes, slices = _of_nodes(body, gear), len(weights)
    axis = np.einsum("sh,hikj,tk->stij", weights, body.seat, weights, optimize=True)
    places = weights @ body.heights

    def add(values: np.ndarray, ahead: int, section: int, other: int) -> None:
        (flank, own), (loaded, there) = divmod(section, slices), divmod(other, slices)
        turn = _turned_back(ahead * gear.angular_pitch + twist * (places[own] - places[there]))
        found = nodes[flank] @ (turn @ axis[own, there]) @ nodes[loaded].T
        values += found.reshape(len(values), 3, len(values), 3).transpose(0, 2, 1, 3)

    return add


def _of_nodes(body: FaceCompliance, gear: Gear) -> np.ndarray:
    """Displacements (F, 3 n, 6) of the flank nodes of a section, in the tooth's frame, per motion of the gear's axis:
    x, y, z, tilts about x and y, turn."""
    angle, found = centreline_angle(gear), []
    axis = np.array([np.cos(angle), np.sin(angle)])
    mirror = np.eye(3)
    mirror[:2, :2] = 2.0 * np.outer(axis, axis) - np.eye(2)
    points = np.array([canonical_point(gear.base_radius, roll) for roll in body.roll_angle])
    for frame in (np.eye(3), mirror)[: body.flanks]:
        x, y = (points @ frame[:2, :2]).T
        moved = np.zeros((len(points), 3, SIX))
        moved[:, [0, 1, 2], [0, 1, 2]] = 1.0
        moved[:, 2, 3], moved[:, 2, 4], moved[:, 0, 5], moved[:, 1, 5] = y, -x, -y, x
        found.append(np.einsum("ab,nbi->nai", frame, moved).reshape(-1, SIX))
    return np.array(found)


def _turned_back(angles: np.ndarray | float) -> np.ndarray:
    """Matrices (..., 6, 6) that take motions of an axis into a frame that is turned counter-clockwise by angles."""
    found = np.zeros((*np.shape(angles), SIX, SIX))
    cosine, sine = np.cos(angles), np.sin(angles)
    for first in (0, 3):
        found[..., first, first] = found[..., first + 1, first + 1] = cosine
        found[..., first, first + 1], found[..., first + 1, first] = sine, -sine
    found[..., 2, 2] = found[..., 5, 5] = 1.0
    return found
