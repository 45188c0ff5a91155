"""One sector of a ring whose outer circle is on even springs, condensed onto its flank and the mean motions of that
circle, and joined to the whole ring."""

from __future__ import annotations

from dataclasses import replace
from time import perf_counter

import numpy as np

from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.outline import rotation

from ..condensation import by_radius, without
from ..element_nodes import node_roll_angles
from ..element_sizes import Discretisation
from ..elements import element_named
from ..ring import check_congruent, condensed_sector, flank_free, joined_blocks, turn_last
from ..sector_mesh import sector_mesh

# Of a mesh whose outer circle is neither held nor on springs all over.
FREE = (0.0, 0.0)


def ring_on_springs(
    gear: Gear, poissons_ratio: float, division: Discretisation, springs: np.ndarray
) -> tuple[dict, dict]:
    """Of a ring with these springs (2,) on each sector, for Young's modulus 1 MPa: `blocks` (teeth, 2n, 2n) between
    flanks, `even` (teeth, 2, 2n) and `by_forces` (teeth, 2, 2) of outer circles by forces on a flank and on one of
    them, `roll_angle` (n,); and the times that it took."""
    clock = perf_counter()
    element = element_named(division.element)
    mesh = replace(sector_mesh(gear, division.sizes(gear), element.quadrilateral), foundation=FREE)
    meshed = perf_counter()
    flank = by_radius(mesh.edge_nodes("flank", element.order))
    cuts = [mesh.edge_nodes(f"{name} cut", element.order) for name in ("lower", "upper")]
    outer = without(mesh.edge_nodes("hub", element.order), np.vstack(cuts))
    sector = condensed_sector(mesh, element, poissons_ratio, np.vstack([flank, outer]))
    check_congruent(sector.points["lower"], sector.points["upper"], gear.teeth)
    stiffness = sector.stiffness.copy()
    turn_last(stiffness, len(sector.dofs("upper")), rotation(gear.angular_pitch))
    inner = sector.points["flank"].size
    means = np.zeros((inner, 2))
    means[flank.size :] = mean_motions(outer)
    stiffness[:inner, :inner] += (means * springs) @ means.T
    held, to_cuts, link = flank_free(stiffness, inner)
    seen = np.column_stack([np.eye(inner)[:, : flank.size], means])
    found = joined_blocks(seen.T @ held @ seen, seen.T @ to_cuts, link, gear.teeth, gear.tooth_count - 1)
    corners = by_radius(mesh.points[mesh.edge_points("flank")])
    arrays = {
        "blocks": found[:, : flank.size, : flank.size],
        "even": found[:, flank.size :, : flank.size],
        "by_forces": found[:, flank.size :, flank.size :],
        "roll_angle": node_roll_angles(gear, corners, element.order),
    }
    compiling = sector.timings["time_compile"]
    spent = perf_counter() - meshed - compiling
    return arrays, {"time_mesh": meshed - clock, "time_compile": compiling, "time_condense": spent}


def mean_motions(outer: np.ndarray) -> np.ndarray:
    """Columns (2k, 2) by which nodes (k, 2) of an outer circle move radially and tangentially, on average."""
    radial = outer / np.linalg.norm(outer, axis=1)[:, None]
    tangential = np.column_stack([-radial[:, 1], radial[:, 0]])
    return np.column_stack([radial.ravel(), tangential.ravel()]) / len(outer)
