"""The flank compliance of a gear over its face: mesh a section, sweep and condense a tooth sector, join the ring."""

from collections.abc import Callable
from time import perf_counter

import numpy as np

from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.outline import centreline_mirror

from ..compliance import Reach
from ..condensation import by_radius
from ..element_nodes import node_roll_angles
from ..element_sizes import ElementSizes
from ..mesh_data import BodyMesh
from ..ring import condensed_sector, ring_compliance
from ..sector_mesh import sector_mesh
from .between_mates import blocks_between_mates
from .condensed import SweptSector, condensed_swept_sector, parts_of_ring, ring_blocks
from .discretisation import FaceDiscretisation
from .held_tooth import near_field
from .swept_stiffness import ELEMENT
from .web import webbed_section


def computed_body(
    gear: Gear, face: FaceDiscretisation, poissons_ratio: float, farthest: int, both: bool, _communicator: None
) -> tuple[dict, dict]:
    """Arrays of the compliance for Young's modulus 1 MPa, and the times that it took."""

    def blocks(sector: SweptSector) -> dict[str, np.ndarray]:
        return {"blocks": _in_mirrored_frame(ring_blocks(sector, gear.teeth, farthest), gear, both)}

    return _computed(gear, face, poissons_ratio, farthest, both, blocks)


def computed_shared(gear: Gear, face: FaceDiscretisation, poissons_ratio: float, reach: Reach) -> tuple[dict, dict]:
    """The same of a gear that several mates load, with `reach.across` also on its coast flanks."""
    both = reach.across is not None

    def blocks(sector: SweptSector) -> dict[str, np.ndarray]:
        held, to_cuts, link = parts_of_ring(sector)
        if both:
            mirror = centreline_mirror(gear, 3)
            _coast_into_mirror(held, mirror)
            into_mirror(to_cuts[len(held) // 2 :], mirror)
        return blocks_between_mates((held, to_cuts, link), gear.teeth, reach)

    return _computed(gear, face, poissons_ratio, reach.same, both, blocks)


def _computed(
    gear: Gear,
    face: FaceDiscretisation,
    poissons_ratio: float,
    offsets: int,
    both: bool,
    blocks_of: Callable[[SweptSector], dict[str, np.ndarray]],
) -> tuple[dict, dict]:
    """Arrays of a body, those of the ring of its sectors by `blocks_of`, and the times that they took."""
    clock = perf_counter()
    mesh = swept_section(gear, face.sizes)
    meshed = perf_counter()
    sector = condensed_swept_sector(mesh, face.sweep, poissons_ratio, gear.teeth, both)
    blocks = blocks_of(sector)
    spent = sector.timings
    del sector
    flanks = ("flank", "coast") if both else ("flank",)
    flank = np.vstack([by_radius(mesh.edge_nodes(side, ELEMENT.order)) for side in flanks])
    section = condensed_sector(mesh, ELEMENT, poissons_ratio, flank)
    plane = _in_mirrored_frame(ring_compliance(section, gear.teeth, offsets), gear, both, components=2)
    rolls = node_roll_angles(gear, by_radius(mesh.points[mesh.edge_points("flank")]), ELEMENT.order)
    near = near_field(gear, mesh, face.sweep, poissons_ratio, rolls, both)
    timings = {**spent, "time_mesh": meshed - clock, "time_condense": perf_counter() - meshed - spent["time_compile"]}
    arrays = {"roll_angle": rolls, "heights": face.sweep.heights, **blocks, "plane": plane}
    return arrays | near.arrays, timings


def swept_section(gear: Gear, sizes: ElementSizes) -> BodyMesh:
    """The section that is swept."""
    return sector_mesh(gear, sizes) if gear.web is None else webbed_section(gear, sizes)


def _in_mirrored_frame(blocks: np.ndarray, gear: Gear, both: bool, components: int = 3) -> np.ndarray:
    """Blocks (k, d, d) with the coast flank's dofs, their second half, in the tooth's frame mirrored at its
    centreline."""
    if not both:
        return blocks
    mirror = centreline_mirror(gear, components)
    for block in blocks:
        _coast_into_mirror(block, mirror)
    blocks[0] = 0.5 * (blocks[0] + blocks[0].T)
    return blocks


def _coast_into_mirror(block: np.ndarray, mirror: np.ndarray) -> None:
    """In place, the coast flank's dofs of a block (d, d), their second half."""
    half = len(block) // 2
    into_mirror(block[half:], mirror)
    into_mirror(block[:, half:].T, mirror)


def into_mirror(rows: np.ndarray, mirror: np.ndarray) -> None:
    """In place, rows (c n, k) of nodes by their components."""
    by_nodes = rows.reshape(-1, len(mirror), rows.shape[1])
    rows[:] = np.einsum("ab,nbk->nak", mirror, by_nodes).reshape(rows.shape)
