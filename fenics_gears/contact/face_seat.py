"""A gear cut into an elastic shaft deflects within its face: the motions of its axis as compliance of its flanks
(`dynamics.elastic_shaft_seat`)."""

from __future__ import annotations

import numpy as np

from fenics_gears.elasticity.face_compliance_data import FaceCompliance
from fenics_gears.elasticity.slice_compliance import Addition
from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.involute import canonical_point
from fenics_gears.geometry.outline import centreline_mirror

from .kinematics import rigid_motions


def seat_motions(weights: np.ndarray, body: FaceCompliance, gear: Gear, twist: float) -> Addition:
    """Adds the motions of the body's axis to the compliance of slices.

    `weights` (S, h): of its heights in slices. `twist` (rad/mm): of the gear's section along z. The face is alike in
    all directions, so that only the angle between two sections matters.
    """
    nodes = _of_nodes(body, gear)
    slices = len(weights)
    axis = np.einsum("sh,hikj,tk->stij", weights, body.seat, weights, optimize=True)
    places = weights @ body.heights

    def add(values: np.ndarray, ahead: int, section: int, other: int) -> None:
        flank, own = divmod(section, slices)
        loaded, there = divmod(other, slices)
        turn = _turned_back(ahead * gear.angular_pitch + twist * (places[own] - places[there]))
        moved = nodes[flank] @ (turn @ axis[own, there]) @ nodes[loaded].T
        values += moved.reshape(len(values), 3, len(values), 3).transpose(0, 2, 1, 3)

    return add


def _of_nodes(body: FaceCompliance, gear: Gear) -> np.ndarray:
    """Displacements (F, 3 n, 6) of the flank nodes of a section, in the tooth's frame, per motion of the gear's axis as
    of `rigid_motions`."""
    points = np.array([[*canonical_point(gear.base_radius, roll), 0.0] for roll in body.roll_angle])
    frames = [np.eye(3), centreline_mirror(gear, 3)][: body.flanks]
    moved = [rigid_motions((points @ frame)[:, None], frame) for frame in frames]
    return np.array(moved).reshape(len(frames), -1, 6)


def _turned_back(angles: np.ndarray | float) -> np.ndarray:
    """Matrices (..., 6, 6) that take motions of an axis into a frame that is turned counter-clockwise by angles."""
    matrices = np.zeros((*np.shape(angles), 6, 6))
    cosine = np.cos(angles)
    sine = np.sin(angles)
    for first in (0, 3):
        matrices[..., first, first] = matrices[..., first + 1, first + 1] = cosine
        matrices[..., first, first + 1] = sine
        matrices[..., first + 1, first] = -sine
    matrices[..., 2, 2] = matrices[..., 5, 5] = 1.0
    return matrices
