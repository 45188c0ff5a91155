"""How contact nodes over a face move with the gears' centres: their normal leans along the axes, and gears also move
axially and tilt."""

from __future__ import annotations

import numpy as np

from .face import Face
from .kinematics import FACE_COORDINATES, Lines
from .tooth_pair import per_node

SENSES = (1.0, -1.0)  # of the relative displacement: the pinion approaches with +n, the wheel with -n


def on_face(rows: np.ndarray, lines: Lines, face: Face, base_radii: tuple[float, float]) -> np.ndarray:
    """Rows (m, 13) over COORDINATES from those of plane flanks (m, 7): normals first, then tangents where there are
    any.

    A plane normal e becomes n = c e + s e_z, with c the cosine of the base helix angle and s = -c slope: n is
    perpendicular to the line of contact.
    """
    nodes = len(lines.normal)
    whole = np.concatenate([rows, np.zeros((len(rows), len(FACE_COORDINATES)))], axis=1)
    whole[:nodes] *= face.cosine
    leaning = -lines.turn * face.cosine * face.slope
    whole[:nodes, 7:] = _axial_and_tilts(
        lines, face, base_radii, face.cosine * lines.normal, leaning, lines.friction_arms
    )
    if len(rows) > nodes:
        whole[nodes:, 7:] = _axial_and_tilts(
            lines, face, base_radii, lines.tangent, np.zeros(nodes), lines.friction_arms
        )
    return whole


def earlier_tangents_on_face(rows: np.ndarray, lines: Lines, face: Face, base_radii: tuple[float, float]) -> np.ndarray:
    """Rows (n, 13) of the tangential displacement of the points touching now, one step before, from those of plane
    flanks (n, 7).

    Tilts move the points by their height along the axes, which the rotation over the step does not change.
    """
    whole = np.concatenate([rows, np.zeros((len(rows), len(FACE_COORDINATES)))], axis=1)
    whole[:, 7:] = _axial_and_tilts(lines, face, base_radii, lines.tangent, np.zeros(len(rows)), lines.friction_arms)
    return whole


def _axial_and_tilts(
    lines: Lines, face: Face, base_radii, direction: np.ndarray, axial: np.ndarray, friction_arms
) -> np.ndarray:
    """Displacement (n, 6) in a direction (n, 2) with an axial part (n,) per unit of axial motion and of the tilts,
    which are arc lengths, of both gears.

    A tilt by theta moves the point at r by theta x r: along the direction by theta . (r x direction).
    """
    height, found = per_node(lines.pairs, np.array([pair.place.height for pair in lines.pairs])), []
    # From either centre: along the line of action to the point of contact, and across it.
    along = (friction_arms[0], -friction_arms[1])
    across = (-lines.lever_arms[0], lines.lever_arms[1])
    for gear, sense in enumerate(SENSES):
        x, y = (along[gear][:, None] * lines.normal + across[gear][:, None] * lines.tangent).T
        z = height - face.middles[gear]
        tilts = np.stack([y * axial - z * direction[:, 1], z * direction[:, 0] - x * axial], axis=1)
        found.append(sense * np.concatenate([axial[:, None], tilts / base_radii[gear]], axis=1))
    return np.concatenate(found, axis=1)
