"""The flank compliance of a gear over its face: mesh a section, sweep and condense a tooth sector, join the ring."""

from collections.abc import Callable
from time import perf_counter

import numpy as np

from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.outline import centreline_mirror

from ..compliance import Reach
from ..computed_ring import into_mirrored_frame, plane_parts
from ..condensation import by_radius
from ..element_nodes import node_roll_angles
from ..element_sizes import ElementSizes
from ..mesh_data import BodyMesh
from ..ring import joined_blocks
from ..sector_mesh import sector_mesh
from .between_mates import blocks_between_mates
from .condensed import Parts, condensed_swept_sector, parts_of_ring
from .discretisation import FaceDiscretisation
from .held_tooth import near_field
from .swept_stiffness import ELEMENT
from .web import webbed_section


def computed_body(
    gear: Gear, face: FaceDiscretisation, poissons_ratio: float, farthest: int, both: bool, _communicator: None
) -> tuple[dict, dict]:
    """Arrays of the compliance for Young's modulus 1 MPa, and the times that it took."""

    def blocks(parts: Parts) -> dict[str, np.ndarray]:
        return {"blocks": joined_blocks(*parts, gear.teeth, farthest)}

    return _computed(gear, face, poissons_ratio, farthest, both, blocks)


def computed_shared(gear: Gear, face: FaceDiscretisation, poissons_ratio: float, reach: Reach) -> tuple[dict, dict]:
    """The same of a gear that several mates load, with `reach.across` also on its coast flanks."""

    def blocks(parts: Parts) -> dict[str, np.ndarray]:
        return blocks_between_mates(parts, gear.teeth, reach)

    return _computed(gear, face, poissons_ratio, reach.of_one_mate, reach.across is not None, blocks)


def _computed(
    gear: Gear,
    face: FaceDiscretisation,
    poissons_ratio: float,
    offsets: int,
    both: bool,
    blocks_of: Callable[[Parts], dict[str, np.ndarray]],
) -> tuple[dict, dict]:
    """Arrays of a body, those of the ring of its sectors by `blocks_of`, and the times that they took."""
    clock = perf_counter()
    mesh = swept_section(gear, face.sizes)
    meshed = perf_counter()
    sector = condensed_swept_sector(mesh, face.sweep, poissons_ratio, gear.teeth, both)
    parts = parts_of_ring(sector, gear.teeth)
    spent = sector.timings
    del sector
    if both:
        into_mirrored_frame(*parts[:2], centreline_mirror(gear, 3))
    blocks = blocks_of(parts)
    del parts
    in_plane, _ = plane_parts(mesh, ELEMENT, poissons_ratio, gear, both)
    plane = joined_blocks(*in_plane, gear.teeth, offsets)
    rolls = node_roll_angles(gear, by_radius(mesh.points[mesh.edge_points("flank")]), ELEMENT.order)
    near = near_field(gear, mesh, face.sweep, poissons_ratio, rolls, both)
    timings = {**spent, "time_mesh": meshed - clock, "time_condense": perf_counter() - meshed - spent["time_compile"]}
    arrays = {"roll_angle": rolls, "heights": face.sweep.heights, **blocks, "plane": plane}
    return arrays | near.arrays, timings


def swept_section(gear: Gear, sizes: ElementSizes) -> BodyMesh:
    """The section that is swept."""
    return sector_mesh(gear, sizes) if gear.web is None else webbed_section(gear, sizes)
