"""Flank compliance of an internal gear whose outer circle is free but for springs at points of it.

Its sectors are alike but for their springs. Each is condensed onto its flank, its outer circle and its cuts, gets its
springs, and the ring is joined as in `whole_body.condensed`.
"""

from dataclasses import replace
from math import floor, pi
from time import perf_counter

import numpy as np

from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.gear_data import Material
from fenics_gears.geometry.outline import rotation

from ..cache import Cache, kept
from ..condensation import by_radius, without
from ..element_nodes import node_roll_angles
from ..element_sizes import Discretisation
from ..elements import element_named
from ..gear_compliance import similar_inputs
from ..ring import Parts, check_congruent, condensed_sector, flank_free, turn_last
from ..sector_mesh import sector_mesh
from .compliance import WholeBodyCompliance
from .condensed import joined_factor

# Of a mesh whose outer circle is neither held nor on springs all over.
FREE = (0.0, 0.0)


def ring_on_points(
    gear: Gear,
    material: Material,
    division: Discretisation,
    points: tuple[tuple[float, ...], tuple[float, float]],
    tooth_offsets: int,
    cache: Cache | None = None,
) -> WholeBodyCompliance:
    """Flank compliance of every tooth, from the cache or computed. Its `openings` are what flank forces load the points
    with: the radial (outwards) and the tangential (counter-clockwise) line force on the gear of each, N/mm per N/mm.

    points: their angles (k,), rad, counter-clockwise from the centreline of tooth 0, and the radial and tangential
    stiffness of each per face width, N/mm^2. A point takes the mean motion of the outer circle over a pitch, between
    two sectors of both by its angle. Raises ComputationError when a stage fails.
    """
    angles, stiffness = points
    springs = stiffness[0] / material.youngs_modulus, stiffness[1] / material.youngs_modulus
    offsets = min(tooth_offsets, gear.tooth_count - 1)
    inputs = similar_inputs("ring on points", gear, material, division, False)
    inputs |= {"angles": list(angles), "springs": list(springs), "tooth_offsets": offsets}
    given = springs_of_sectors(angles, springs, gear.teeth)
    arrays, timings = kept(cache, inputs, lambda: _computed(gear, material.poissons_ratio, division, given, offsets))
    blocks = arrays["blocks"] / material.youngs_modulus
    return WholeBodyCompliance(
        roll_angles=(arrays["roll_angle"],) * gear.tooth_count,
        element_order=element_named(division.element).order,
        blocks=tuple(tuple(own) for own in blocks),
        openings=dict(enumerate(arrays["point_forces"])),
        timings=timings,
    )


def springs_of_sectors(angles: tuple[float, ...], springs: tuple[float, float], teeth: int) -> np.ndarray:
    """Radial and tangential stiffness (points, teeth, 2) that each point has in each sector."""
    shares = np.zeros((len(angles), abs(teeth)))
    for own, angle in zip(shares, angles):
        place = angle * teeth / (2.0 * pi)
        first = floor(place)
        own[first % len(own)] += 1.0 - (place - first)
        own[(first + 1) % len(own)] += place - first
    return shares[:, :, None] * np.array(springs)


def _computed(
    gear: Gear, poissons_ratio: float, division: Discretisation, springs: np.ndarray, offsets: int
) -> tuple[dict, dict]:
    """Arrays for Young's modulus 1 MPa: `blocks` (teeth, offsets + 1, 2n, 2n), `point_forces` (teeth, 2 points, 2n),
    `roll_angle` (n,); and the times that it took."""
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
    means = np.zeros((sector.points["flank"].size, 2))
    means[flank.size :] = mean_motions(outer)
    parts = [_part(stiffness, means, flank.size, own) for own in springs.sum(axis=0)]
    blocks, moved = _joined(parts, flank.size, offsets)
    forces = np.einsum("psk,tskf->tpkf", springs, moved).reshape(len(parts), -1, flank.size)
    corners = by_radius(mesh.points[mesh.edge_points("flank")])
    arrays = {"blocks": blocks, "point_forces": -forces, "roll_angle": node_roll_angles(gear, corners, element.order)}
    compiling = sector.timings["time_compile"]
    spent = perf_counter() - meshed - compiling
    return arrays, {"time_mesh": meshed - clock, "time_compile": compiling, "time_condense": spent}


def mean_motions(outer: np.ndarray) -> np.ndarray:
    """Columns (2k, 2) by which nodes (k, 2) of an outer circle move radially and tangentially, on average."""
    radial = outer / np.linalg.norm(outer, axis=1)[:, None]
    tangential = np.column_stack([-radial[:, 1], radial[:, 0]])
    return np.column_stack([radial.ravel(), tangential.ravel()]) / len(outer)


def _part(stiffness: np.ndarray, means: np.ndarray, flank: int, springs: np.ndarray) -> Parts:
    """A sector on its springs (2,), as of `ring.flank_free`, by its flank and the mean motions of its outer circle."""
    on_springs = stiffness.copy()
    inner = len(means)
    on_springs[:inner, :inner] += (means * springs) @ means.T
    held, to_cuts, link = flank_free(on_springs, inner)
    seen = np.column_stack([np.eye(inner)[:, :flank], means])
    return seen.T @ held @ seen, seen.T @ to_cuts, link


def _joined(parts: list[Parts], flank: int, offsets: int) -> tuple[np.ndarray, np.ndarray]:
    """Of a ring the compliance between flanks (teeth, offsets + 1, 2n, 2n), and the mean motions (teeth, teeth, 2, 2n)
    of the outer circles of all sectors by forces on the flank of each."""
    teeth = len(parts)
    cut = len(parts[0][2]) // 2
    dofs = [(np.arange(2 * cut) + tooth * cut) % (teeth * cut) for tooth in range(teeth)]
    size = teeth * cut
    factor = joined_factor([link for _, _, link in parts], dofs, size, "the cuts of a ring on points")
    blocks = np.empty((teeth, offsets + 1, flank, flank))
    moved = np.empty((teeth, teeth, 2, flank))
    try:
        for tooth, (held, to_cuts, _) in enumerate(parts):
            loads = np.zeros((size, flank))
            loads[dofs[tooth]] = to_cuts[:flank].T
            response = factor.solve(loads)
            for ahead in range(teeth):
                beside = (tooth + ahead) % teeth
                motion = parts[beside][1] @ response[dofs[beside]]
                if ahead == 0:
                    motion += held[:, :flank]
                if ahead <= offsets:
                    blocks[tooth, ahead] = motion[:flank]
                moved[tooth, beside] = motion[flank:]
            blocks[tooth, 0] = 0.5 * (blocks[tooth, 0] + blocks[tooth, 0].T)
    finally:
        factor.close()
    return blocks, moved
