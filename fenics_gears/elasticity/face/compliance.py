"""Flank compliance of a gear over its face: sweep one tooth sector, condense it, join the ring; or from the cache."""

from __future__ import annotations

from time import perf_counter
from typing import TYPE_CHECKING

import numpy as np

from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.gear_data import Material
from fenics_gears.geometry.outline import centreline_angle
from fenics_gears.system.job import together
from fenics_gears.system.second_process import SecondProcess

from ..cache import Cache, kept
from ..compliance import FlankCompliance, Reach
from ..face_compliance_data import FaceCompliance
from ..gear_compliance import check_inputs, similar_inputs
from .discretisation import FaceDiscretisation
from .near_field import NearField

if TYPE_CHECKING:
    from ..element_sizes import ElementSizes
    from ..mesh_data import BodyMesh

# Not a choice: heights of the nodes, here and in FaceCompliance, follow from it.
ORDER = 2


def face_compliance(
    gear: Gear,
    material: Material,
    discretisation: FaceDiscretisation,
    reach: Reach,
    cache: Cache | None = None,
    process: SecondProcess | None = None,
) -> FaceCompliance:
    """Flank compliance of a gear over its face, from the cache or by condensing one swept tooth sector, hub held, end
    faces free.

    gear: its transverse section. With `reach.across` the coast flank's dofs follow the drive flank's. They are in the
    tooth's frame mirrored at its centreline at that height: x and y of the mirrored section, heights and z unchanged.
    process: that does the work, this one unless given. Raises SceneError for an impossible size, ComputationError when
    a stage fails.
    """
    check_inputs(gear, material, reach)
    discretisation.check()
    similar, scaled = gear.of_module_one, discretisation.in_modules_of(gear)
    farthest, both = reach.farthest, reach.across is not None
    inputs = similar_inputs("over the face", gear, material, discretisation)
    inputs |= {"farthest": farthest, "both flanks": both}

    def compute() -> tuple[dict, dict]:
        return together(process, _computed, similar, scaled, material.poissons_ratio, farthest, both)[0]

    arrays, timings = kept(cache, inputs, compute)
    # In place: the arrays are large, and nothing else refers to them.
    arrays["blocks"] *= 1.0 / (material.youngs_modulus * gear.module)
    arrays["plane"] *= 1.0 / material.youngs_modulus
    rolls, flanks = arrays["roll_angle"], 2 if both else 1
    return FaceCompliance(
        roll_angle=rolls,
        element_order=ORDER,
        heights=gear.module * arrays["heights"],
        blocks=arrays["blocks"],
        plane=FlankCompliance(rolls, ORDER, arrays["plane"], flanks=flanks),
        timings=timings,
        flanks=flanks,
        near=NearField.of_arrays(arrays).scaled(gear.module, material.youngs_modulus),
    )


def _computed(
    gear: Gear, face: FaceDiscretisation, poissons_ratio: float, farthest: int, both: bool, _communicator: None
) -> tuple[dict, dict]:
    """Arrays of the compliance for Young's modulus 1 MPa, and the times that it took."""
    # Imported here: a run whose gears are all in the cache needs neither gmsh nor DOLFINx.
    from ..condensation import by_radius
    from ..element_nodes import node_roll_angles
    from ..ring import condensed_sector, ring_compliance
    from .condensed import condensed_swept_sector, ring_blocks
    from .held_tooth import near_field
    from .swept_stiffness import ELEMENT

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
    if gear.web is None:
        # Imported here: a run whose gears are all in the cache needs no gmsh.
        from ..sector_mesh import sector_mesh

        return sector_mesh(gear, sizes)
    # Imported here: gears without web have none of it.
    from .web import webbed_section

    return webbed_section(gear, sizes)


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
