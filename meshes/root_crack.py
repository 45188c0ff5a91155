"""Meshes of whole gears, of which teeth may be cracked at their root.

A crack is a straight slit without width: along it cells meet at points that are there twice, once for either face, but
for its tip.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from fenics_gears.elasticity.element_sizes import ElementSizes, SizeField, SizeSource, along, divided
from fenics_gears.elasticity.mesh_data import BodyMesh, oriented
from fenics_gears.elasticity.sector_boundary import SectorBoundary, root_curve, sector_boundary
from fenics_gears.elasticity.sector_mesh import filled, sector_mesh
from fenics_gears.errors import SceneError
from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.outline import ToothOutline, tooth_outline

NAMED_PARTS = ("flank", "hub", "lower cut", "upper cut")
FILLET_SAMPLES, SLIT_SAMPLES = 2001, 400
# Elements at the crack's tip, in parts of its depth; they grow away from it.
TIP_ELEMENTS, TIP_GROWTH = 40.0, 0.35
# What a crack leaves whole between its tip and the nearest surface, in modules.
LEAST_LIGAMENT = 0.15


@dataclass(frozen=True)
class RootCrack:
    """A straight crack from the fillet on the drive flank's side into the tooth.

    depth: its length, mm. angle: rad, between it and the tooth's centreline; a right angle goes straight across the
    tooth, less goes down towards the bore. mouth: rad, angle between fillet and centreline where it begins; the most
    stressed place is near 30 degrees.
    """

    depth: float
    angle: float = np.radians(45.0)
    mouth: float = np.radians(30.0)


def cracked_gear_mesh(gear: Gear, sizes: ElementSizes, cracks: Mapping[int, RootCrack]) -> BodyMesh:
    """Mesh of triangles (mm) of a whole gear; `cracks`: by tooth, counted counter-clockwise from the one in its body
    frame.

    All teeth but the cracked ones are meshed alike. Raises SceneError for a crack that leaves no tooth, or for teeth
    that are not there.
    """
    for tooth in cracks:
        if not 0 <= tooth < gear.teeth:
            raise SceneError(f"crack in tooth {tooth}: the gear has teeth 0 to {gear.teeth - 1}")
    # Both flanks are meshed alike only where a ring of sectors would be; here the drive flanks carry.
    healthy = sector_mesh(gear, replace(sizes, both_flanks=False))
    cracked = {tooth: cracked_sector_mesh(gear, sizes, crack) for tooth, crack in cracks.items()}
    return joined_sectors([cracked.get(tooth, healthy) for tooth in range(gear.teeth)])


def cracked_sector_mesh(gear: Gear, sizes: ElementSizes, crack: RootCrack) -> BodyMesh:
    """Mesh of triangles (mm) of the sector of a cracked tooth; its cuts are those of the whole tooth's sector."""
    similar, in_modules = gear.of_module_one, replace(sizes, both_flanks=False).in_modules_of(gear)
    boundary, field = sector_boundary(similar, in_modules)
    mouth, direction = crack_line(similar, crack)
    start = _vertex_moved_to(boundary, mouth)
    depth = crack.depth / gear.module
    _check_ligament(boundary.points, start, mouth + np.linspace(0.1, 1.0, 10)[:, None] * depth * direction, crack, gear)
    tip = SizeSource(((mouth + depth * direction)[None],), depth / TIP_ELEMENTS, 2.0 * depth / TIP_ELEMENTS, TIP_GROWTH)
    field = SizeField((*field.sources, tip), field.largest)
    line = mouth + np.linspace(0.0, depth, SLIT_SAMPLES)[:, None] * direction
    slit = along(line, divided(line, field.at(line), 4))[1:]
    points, (cells,) = filled(boundary.points, field, 1.0, recombine=False, slit=slit, mouth=start)
    chain = np.concatenate([[start], len(boundary.points) + np.arange(len(slit))])
    points, cells = opened(points, oriented(points, cells), chain)
    edges = {name: boundary.part(name) for name in NAMED_PARTS}
    return BodyMesh(
        gear.module * points, cells, {name: np.stack([part[:-1], part[1:]], axis=-1) for name, part in edges.items()}
    )


def opened(points: np.ndarray, cells: np.ndarray, chain: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Points and cells with a straight chain of points (k,), from its mouth on the boundary to its tip, made into two
    faces.

    Every point but the tip is doubled; cells on the right, seen from the mouth, have the new ones.
    """
    along_it = points[chain[-1]] - points[chain[0]]
    to_centre = points[cells].mean(axis=1) - points[chain[0]]
    right = along_it[0] * to_centre[:, 1] - along_it[1] * to_centre[:, 0] < 0.0
    new_index = np.arange(len(points))
    new_index[chain[:-1]] = len(points) + np.arange(len(chain) - 1)
    return np.vstack([points, points[chain[:-1]]]), np.where(right[:, None], new_index[cells], cells)


def crack_line(gear: Gear, crack: RootCrack) -> tuple[np.ndarray, np.ndarray]:
    """Mouth (2,) of a crack, in the gear's unit of length and the tooth's body frame, and its direction (2,)."""
    outline = tooth_outline(gear, FILLET_SAMPLES)
    mouth = _fillet_point(outline, crack.mouth)
    angle = outline.centreline_angle
    to_tip, to_coast = np.array([np.cos(angle), np.sin(angle)]), np.array([np.sin(angle), -np.cos(angle)])
    return mouth, -np.cos(crack.angle) * to_tip + np.sin(crack.angle) * to_coast


def _fillet_point(outline: ToothOutline, angle: float) -> np.ndarray:
    """The point (2,) of the drive side's fillet whose tangent stands at an angle (rad) to the tooth's centreline."""
    fillet = root_curve(outline)
    fillet = fillet[-len(outline.fillet) :]
    tangents = np.gradient(fillet, axis=0)
    axis = np.array([np.cos(outline.centreline_angle), np.sin(outline.centreline_angle)])
    across = np.abs(tangents[:, 0] * axis[1] - tangents[:, 1] * axis[0])
    angles = np.arctan2(across, tangents @ axis)
    if not angles.min() < angle < angles.max():
        lowest, highest = np.degrees([angles.min(), angles.max()])
        raise SceneError(
            f"crack: the fillet has no place where it stands at {np.degrees(angle):.4g} degrees to the tooth's"
            f" centreline; allowed: between {lowest:.3g} and {highest:.3g} degrees"
        )
    order = np.argsort(angles)
    return np.array([np.interp(angle, angles[order], fillet[order, i]) for i in range(2)])


def _vertex_moved_to(boundary: SectorBoundary, mouth: np.ndarray) -> int:
    """Index of the root's point nearest to a crack's mouth, which is moved there."""
    root = boundary.part("root")[1:-1]
    nearest = int(root[np.argmin(np.linalg.norm(boundary.points[root] - mouth, axis=1))])
    boundary.points[nearest] = mouth
    return nearest


def _check_ligament(polygon: np.ndarray, mouth: int, line: np.ndarray, crack: RootCrack, gear: Gear) -> None:
    """Raise SceneError where the crack's line (k, 2), in modules, leaves the polygon (n, 2) or comes too near to it
    opposite the mouth."""
    start, end = polygon, np.roll(polygon, -1, axis=0)
    edge = end - start
    inside = np.abs(_turns(polygon, line)) > np.pi
    share = np.einsum("kni,ni->kn", line[:, None] - start, edge) / np.einsum("ni,ni->n", edge, edge)
    distance = np.linalg.norm(start + np.clip(share, 0.0, 1.0)[..., None] * edge - line[:, None], axis=-1)
    # Near its mouth every crack is near the surface; what counts is what lies ahead of it.
    from_mouth = np.linalg.norm(line - polygon[mouth], axis=1)
    opposite = np.linalg.norm(0.5 * (start + end) - polygon[mouth], axis=1)[None] > from_mouth[:, None]
    left = np.where(opposite, distance, np.inf).min(axis=1)
    wrong = np.flatnonzero(~inside | (left < np.minimum(LEAST_LIGAMENT, 0.5 * from_mouth)))
    if len(wrong) or crack.depth <= 0.0:
        reach = gear.module * (from_mouth[wrong[0]] if len(wrong) else 0.0)
        reason = (
            "its depth must be positive"
            if crack.depth <= 0.0
            else (
                f"leaves less than {LEAST_LIGAMENT * gear.module:.3g} mm of the tooth's sector whole from about"
                f" {reach:.3g} mm on"
            )
        )
        raise SceneError(
            f"crack of {crack.depth:.4g} mm at {np.degrees(crack.angle):.4g} degrees to the tooth's centreline:"
            f" {reason}"
        )


def _turns(polygon: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Angle (k,), rad, that a closed polygon turns around points (k, 2)."""
    seen = (polygon[None] - points[:, None]) @ np.array([1.0, 1.0j])
    return np.angle(np.roll(seen, -1, axis=1) / seen).sum(axis=1)


def joined_sectors(sectors: list[BodyMesh]) -> BodyMesh:
    """Mesh of a whole gear from the sector of each tooth, counter-clockwise; their cuts have the same nodes."""
    teeth, points, index, count = len(sectors), [], [], 0
    pitch = 2.0 * np.pi / teeth
    for tooth, sector in enumerate(sectors):
        own = np.setdiff1d(np.arange(len(sector.points)), _points_by_radius(sector, "upper cut"))
        cosine, sine = np.cos(tooth * pitch), np.sin(tooth * pitch)
        points.append(sector.points[own] @ np.array([[cosine, sine], [-sine, cosine]]))
        index.append(np.empty(len(sector.points), dtype=int))
        index[tooth][own] = count + np.arange(len(own))
        count += len(own)
    for tooth, sector in enumerate(sectors):
        ahead = (tooth + 1) % teeth
        index[tooth][_points_by_radius(sector, "upper cut")] = index[ahead][
            _points_by_radius(sectors[ahead], "lower cut")
        ]
    edges = {
        f"flank {tooth}": numbers[sector.edges["flank"]] for tooth, (numbers, sector) in enumerate(zip(index, sectors))
    }
    edges["hub"] = np.vstack([numbers[sector.edges["hub"]] for numbers, sector in zip(index, sectors)])
    cells = np.vstack([numbers[sector.cells] for numbers, sector in zip(index, sectors)])
    return BodyMesh(np.vstack(points), cells, edges)


def _points_by_radius(mesh: BodyMesh, name: str) -> np.ndarray:
    points = mesh.edge_points(name)
    return points[np.argsort(np.linalg.norm(mesh.points[points], axis=1))]
