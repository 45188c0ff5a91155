"""A flank compliance without finite elements."""

import numpy as np

from fenics_gears.elasticity.compliance import FlankCompliance
from fenics_gears.elasticity.face_compliance_data import FaceCompliance


def stand_in_compliance(
    gear, *, elements=60, element_order=2, offsets=3, local=6e-6, tooth=1.5e-5, coast_flank=False
) -> FlankCompliance:
    """Symmetric positive definite: a tooth that bends and yields locally, coupled to its neighbours. `local`,
    `tooth`: mm per N/mm. A `coast_flank` goes along as the tooth bends: away from it in the mirrored frame."""
    arc = np.linspace(
        0.5 * gear.base_radius * gear.form_roll_angle**2,
        0.5 * gear.base_radius * gear.tip_roll_angle**2,
        element_order * elements + 1,
    )
    height = (arc - arc[0]) / (arc[-1] - arc[0])
    kernel = np.exp(-np.abs(arc[:, None] - arc[None, :]) / (gear.module / 15.0))
    bending = np.outer(0.2 + height, 0.2 + height)
    if coast_flank:
        nothing, sides = np.zeros_like(kernel), np.array([[1.0, -1.0], [-1.0, 1.0]])
        kernel, bending = np.block([[kernel, nothing], [nothing, kernel]]), np.kron(sides, bending)
    blocks = []
    for offset in range(offsets + 1):
        share = 0.1**offset
        normal = share * tooth * bending + (local * kernel if offset == 0 else 0.0)
        block = np.zeros((2 * len(normal), 2 * len(normal)))
        block[0::2, 0::2], block[1::2, 1::2] = normal, 0.5 * normal
        blocks.append(block)
    return FlankCompliance(
        np.sqrt(2.0 * arc / gear.base_radius), element_order, np.array(blocks), flanks=2 if coast_flank else 1
    )


def stand_in_body(gear, width, heights=5, *, elements=12, offsets=3, coast_flank=False, reach=None):
    """A body over a face, stiff along its axis; local yielding is in the sections. `reach` (of the width): how far a
    load bends the tooth more than elsewhere."""
    plane = stand_in_compliance(gear, elements=elements, local=0.0, offsets=offsets, coast_flank=coast_flank)
    flanks, nodes, places = plane.flanks, len(plane.roll_angle), np.linspace(-0.5, 0.5, heights) * width
    section = np.zeros((len(plane.blocks), flanks, nodes, 3, flanks, nodes, 3))
    section[..., :2, :, :, :2] = plane.blocks.reshape(-1, flanks, nodes, 2, flanks, nodes, 2) / width
    along = np.ones((heights, heights))
    if reach is not None:
        along += np.exp(-np.abs(places[:, None] - places) / (reach * width))
    blocks = np.einsum("kfaicbj,hg->kfhaicgbj", section, along)
    size = flanks * heights * nodes * 3
    return FaceCompliance(
        plane.roll_angle, plane.element_order, places, blocks.reshape(-1, size, size), plane, flanks=flanks
    )
