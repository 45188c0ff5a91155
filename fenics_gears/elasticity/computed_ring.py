"""The flank compliance of a plane gear: mesh a sector, or half of a symmetric one, condense it, join the ring."""

from time import perf_counter

import numpy as np

from fenics_gears.geometry.gear import Gear

from . import mirrored_ring, ring
from .compliance import Reach
from .condensation import by_radius
from .element_nodes import node_roll_angles
from .element_sizes import ElementSizes
from .elements import Element
from .sector_mesh import centreline_direction, half_sector_mesh, sector_mesh


def computed_ring(
    gear: Gear, element: Element, sizes: ElementSizes, poissons_ratio: float, reach: Reach
) -> tuple[dict, dict]:
    """Arrays of the compliance for Young's modulus 1 MPa, and the times that it took."""
    clock = perf_counter()
    mesh = (half_sector_mesh if sizes.both_flanks else sector_mesh)(gear, sizes, element.quadrilateral)
    meshed = perf_counter()
    if sizes.both_flanks:
        sector = mirrored_ring.condensed_half(mesh, element, poissons_ratio)
        axis = centreline_direction(mesh)
        blocks, across = mirrored_ring.both_flanks_compliance(sector, axis, gear.teeth, reach)
        arrays = {"blocks": blocks, "across": across, "first_across": np.array(reach.across[0])}
    else:
        sector = ring.condensed_sector(mesh, element, poissons_ratio)
        arrays = {"blocks": ring.ring_compliance(sector, gear.teeth, reach.same)}
    arrays["roll_angle"] = node_roll_angles(gear, by_radius(mesh.points[mesh.edge_points("flank")]), element.order)
    compiling = sector.timings["time_compile"]
    timings = {"time_mesh": meshed - clock, "time_condense": perf_counter() - meshed - compiling}
    return arrays, {**sector.timings, **timings}
