"""The flank compliance of a gear over its face: mesh a section, sweep and condense a tooth sector, join the ring."""

from time import perf_counter

import numpy as np

from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.outline import centreline_angle

from ..condensation import by_radius
from ..element_nodes import node_roll_angles
from ..element_sizes import ElementSizes
from ..mesh_data import BodyMesh
from ..ring import condensed_sector, ring_compliance
from ..sector_mesh import sector_mesh
from .condensed import condensed_swept_sector, ring_blocks
from .discretisation import FaceDiscretisation
from .held_tooth import near_field
from .swept_stiffness import ELEMENT
from .web import webbed_section


def computed_body(
    gear: Gear, face: FaceDiscretisation, poissons_ratio: float, farthest: int, both: bool, _communicator: None
) -> tuple[dict, dict]:
    """Arrays of the compliance for Young's modulus 1 MPa, and the times that it took."""
    clock = perf_counter()
    mesh = swept_section(gear, face.sizes)
    meshed = perf_counter()
    sector = condensed_swept_sector(mesh, face.sweep, poissons_ratio, gear.teeth, both)
    blocks = ring_blocks(sector, gear.teeth, farthest)
    spent = sector.timings
    del sector
    blocks = _in_mirrored_frame(blocks, gear, both)
    flanks = ("flank", "coast") if both else ("flank",)
    flank = np.vstack([by_radius(mesh.edge_nodes(side, ELEMENT.order)) for side in flanks])
    section = condensed_sector(mesh, ELEMENT, poissons_ratio, flank)
    plane = _in_mirrored_frame(ring_compliance(section, gear.teeth, farthest), gear, both, components=2)
    rolls = node_roll_angles(gear, by_radius(mesh.points[mesh.edge_points("flank")]), ELEMENT.order)
    near = near_field(gear, mesh, face.sweep, poissons_ratio, rolls, both)
    timings = {**spent, "time_mesh": meshed - clock, "time_condense": perf_counter() - meshed - spent["time_compile"]}
    arrays = {"roll_angle": rolls, "heights": face.sweep.heights, "blocks": blocks, "plane": plane}
    return arrays | near.arrays, timings


def swept_section(gear: Gear, sizes: ElementSizes) -> BodyMesh:
    """The section that is swept."""
    return sector_mesh(gear, sizes) if gear.web is None else webbed_section(gear, sizes)


def _in_mirrored_frame(blocks: np.ndarray, gear: Gear, both: bool, components: int = 3) -> np.ndarray:
    """Blocks (k, d, d) with the coast flank's dofs, their second half, in the tooth's frame mirrored at its
    centreline."""
    if not both:
        return blocks
    angle = centreline_angle(gear)
    axis, mirror = np.array([np.cos(angle), np.sin(angle)]), np.eye(components)
    mirror[:2, :2] = 2.0 * np.outer(axis, axis) - np.eye(2)
    half = blocks.shape[1] // 2
    for block in blocks:
        coast = block[half:].reshape(-1, components, 2 * half)
        block[half:] = np.einsum("ab,nbk->nak", mirror, coast).reshape(half, -1)
        coast = block[:, half:].reshape(2 * half, -1, components)
        block[:, half:] = (coast @ mirror).reshape(2 * half, half)
    blocks[0] = 0.5 * (blocks[0] + blocks[0].T)
    return blocks
