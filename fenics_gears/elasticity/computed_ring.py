"""The flank compliance of a plane gear: mesh a sector, condense it, join the ring."""

from time import perf_counter

import numpy as np

from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.outline import centreline_mirror

from .compliance import Reach
from .condensation import by_radius
from .element_nodes import node_roll_angles
from .element_sizes import ElementSizes
from .elements import Element
from .mesh_data import BodyMesh
from .ring import between_cuts, condensed_sector, cut_response, joined_blocks, sector_response
from .sector_mesh import sector_mesh


def computed_ring(
    gear: Gear, element: Element, sizes: ElementSizes, poissons_ratio: float, reach: Reach
) -> tuple[dict, dict]:
    """Arrays of the compliance for Young's modulus 1 MPa, and the times that it took."""
    clock = perf_counter()
    mesh = sector_mesh(gear, sizes, element.quadrilateral)
    meshed = perf_counter()
    parts, timings = plane_parts(mesh, element, poissons_ratio, gear, sizes.both_flanks)
    if reach.across is None:
        arrays = {"blocks": joined_blocks(*parts, gear.teeth, reach.same)}
    else:
        arrays = _of_both_flanks(*parts, gear.teeth, reach)
    arrays["roll_angle"] = node_roll_angles(gear, by_radius(mesh.points[mesh.edge_points("flank")]), element.order)
    condensing = perf_counter() - meshed - timings["time_compile"]
    return arrays, {**timings, "time_mesh": meshed - clock, "time_condense": condensing}


def plane_parts(
    mesh: BodyMesh, element: Element, poissons_ratio: float, gear: Gear, both: bool
) -> tuple[tuple[np.ndarray, np.ndarray, np.ndarray], dict]:
    """What `ring.between_cuts` gives, and the times of condensing; with `both` also of the coast flank, whose dofs
    follow in the tooth's frame mirrored at its centreline."""
    flanks = [by_radius(mesh.edge_nodes(side, element.order)) for side in ("flank", "coast")[: 2 if both else 1]]
    sector = condensed_sector(mesh, element, poissons_ratio, np.vstack(flanks))
    held, to_cuts, link = between_cuts(sector, gear.teeth)
    if both:
        into_mirrored_frame(held, to_cuts, centreline_mirror(gear))
    return (held, to_cuts, link), sector.timings


def _of_both_flanks(held: np.ndarray, to_cuts: np.ndarray, link: np.ndarray, teeth: int, reach: Reach) -> dict:
    """Arrays of a `BothFlanksCompliance`, whose blocks across are symmetric."""
    drive, coast = np.vsplit(to_cuts, 2)
    flank = len(drive)
    joint = cut_response(link, teeth, reach.farthest + 1)
    first, last = reach.across
    blocks = np.stack([drive @ sector_response(joint, ahead) @ drive.T for ahead in range(reach.same + 1)])
    across = np.stack([drive @ sector_response(joint, ahead) @ coast.T for ahead in range(first, last + 1)])
    blocks[0] += held[:flank, :flank]
    if first <= 0 <= last:
        across[-first] += held[:flank, flank:]
    blocks[0] = 0.5 * (blocks[0] + blocks[0].T)
    return {"blocks": blocks, "across": 0.5 * (across + across.swapaxes(1, 2)), "first_across": np.array(first)}


def into_mirrored_frame(held: np.ndarray, to_cuts: np.ndarray, mirror: np.ndarray) -> None:
    """In place, the coast flank's dofs, the second half of all, of what `ring.between_cuts` gives."""
    half = len(held) // 2
    for rows in (held[half:], held[:, half:].T, to_cuts[half:]):
        by_nodes = rows.reshape(-1, len(mirror), rows.shape[1])
        rows[:] = np.einsum("ab,nbk->nak", mirror, by_nodes).reshape(rows.shape)
