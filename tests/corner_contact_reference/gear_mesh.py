"""A whole gear in six-node triangles, a few teeth finely meshed, tip edges rounded."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree
from tests.six_node_mesh import along, points_at, six_node_mesh, unit, with_middles

from fenics_gears import Gear
from fenics_gears.geometry.involute import arc_length, canonical_point, roll_angle_at_arc_length
from fenics_gears.geometry.outline import tooth_outline
from fenics_gears.geometry.tip_edge import tip_edge


@dataclass(frozen=True)
class MeshSizes:
    """mm: along the loaded flanks, at their tip edges, in fillets and far away. `growth`: increase per distance from
    the flank."""

    flank: float
    tip: float
    fillet: float = 0.3
    coarse: float = 1.2
    body: float = 2.0
    growth: float = 0.35

    def scaled(self, factor: float) -> MeshSizes:
        return MeshSizes(
            *(factor * size for size in (self.flank, self.tip, self.fillet, self.coarse, self.body)), self.growth
        )


@dataclass(frozen=True)
class GearMesh:
    """`points` (n, 2), mm, in the body frame of tooth 0; `cells` (m, 6), corners, then middles; `hub`: nodes of the
    bore; `contact` (k, 2): (cell, side) of edges on loaded flanks, tip edges and tip lands."""

    points: np.ndarray
    cells: np.ndarray
    hub: np.ndarray
    contact: np.ndarray


def rotation(angle: float) -> np.ndarray:
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def gear_mesh(
    gear: Gear, sizes: MeshSizes, edge_radius: float, loaded: tuple[int, ...], on_coast: tuple[int, ...] = ()
) -> GearMesh:
    """Teeth `loaded` (pitches counter-clockwise of tooth 0) are meshed finely; those of `on_coast` on their coast
    flanks, which then touch."""
    doubled, touching = _outline(gear, sizes, edge_radius, loaded, on_coast)
    count = max(2 * int(np.ceil(np.pi * gear.bore_radius / (0.05 * gear.bore_radius))), 40)
    angles = -2.0 * np.pi * np.arange(2 * count) / (2 * count)
    bore = gear.bore_radius * unit(angles)
    points, cells, (outline, hub) = six_node_mesh(doubled, bore, _size_function(doubled, bore, sizes))
    middles = {
        middle: (cell, side)
        for cell, corners_and_middles in enumerate(cells)
        for side, middle in enumerate(corners_and_middles[3:])
    }
    contact = [middles[middle] for middle in outline[1::2][touching]]
    return GearMesh(points, cells, hub, np.array(contact))


def _outline(gear: Gear, sizes: MeshSizes, edge_radius: float, loaded, on_coast) -> tuple[np.ndarray, np.ndarray]:
    """Closed outline, clockwise, with middles (2 k, 2), and whether an edge (k,) may touch."""
    fine, coarse = (_tooth(gear, sizes, edge_radius, is_loaded) for is_loaded in (True, False))
    turned = _turned_over(gear, *fine)
    points, touching = [], []
    chosen, others = ({tooth % gear.teeth for tooth in teeth} for teeth in (loaded, on_coast))
    for tooth in range(gear.teeth - 1, -1, -1):
        pieces, flags = fine if tooth in chosen else turned if tooth in others else coarse
        points.append(pieces @ rotation(tooth * gear.angular_pitch).T)
        touching.append(flags)
    return np.vstack(points), np.concatenate(touching)


def _tooth(gear: Gear, sizes: MeshSizes, edge_radius: float, loaded: bool) -> tuple[np.ndarray, np.ndarray]:
    """From space to space, clockwise, middles included, last point left out."""
    edge = tip_edge(gear, edge_radius if loaded else 0.0)
    outline = tooth_outline(gear, 401)
    flank_size, tip_size, size = (
        (sizes.flank, sizes.tip, sizes.fillet) if loaded else (sizes.coarse, sizes.coarse, sizes.coarse)
    )
    fillet = _resampled(outline.fillet, size)
    root_angle = np.angle(complex(*outline.fillet[0]))
    root_points = _even(gear.root_radius * abs(outline.space_angle - root_angle) / size)
    root = gear.root_radius * unit(np.linspace(outline.space_angle, root_angle, root_points))
    ends = arc_length(gear.base_radius, np.array([gear.form_roll_angle, edge.flank_roll]))
    arcs = ends[1] - _graded(ends[1] - ends[0], tip_size, flank_size, sizes.growth)[::-1]
    coast_arcs = np.linspace(*ends, _even((ends[1] - ends[0]) / (2.0 * size)))
    flank, coast_flank = (
        canonical_point(gear.base_radius, roll_angle_at_arc_length(gear.base_radius, each))
        for each in (arcs, coast_arcs)
    )
    drive, back, may_touch = [root, fillet, flank], [root, fillet, coast_flank], [False, False, True]
    if edge.radius:
        edges = 0.5 * np.pi * edge.radius / min(tip_size, 0.25 * edge.radius)
        drive.append(edge.points(np.linspace(0.0, 1.0, _even(edges))))
        back.append(edge.points(np.linspace(0.0, 1.0, 5)))
        may_touch.append(True)
    land = _land(gear, edge.points(1.0), outline.coast(edge.points(1.0)), tip_size, sizes)
    pieces = [*drive, land, *(outline.coast(piece)[::-1] for piece in reversed(back))]
    may_touch += [True] + [False] * len(back)
    points = np.vstack([piece[:-1] for piece in pieces])
    flags = np.concatenate(
        [np.full((len(piece) - 1) // 2, loaded and touch) for piece, touch in zip(pieces, may_touch)]
    )
    return points, flags


def _turned_over(gear: Gear, points: np.ndarray, flags: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The mirror image of a tooth about its middle, again clockwise from space to space."""
    end = rotation(-gear.angular_pitch) @ points[0]
    return tooth_outline(gear, 401).coast(np.vstack([points, end]))[::-1][:-1], flags[::-1]


def _land(gear: Gear, corner: np.ndarray, opposite: np.ndarray, tip_size: float, sizes: MeshSizes) -> np.ndarray:
    start, end = (np.angle(complex(*point)) for point in (corner, opposite))
    length = gear.tip_radius * abs(end - start)
    half = _graded(0.5 * length, tip_size, sizes.coarse, sizes.growth)[:-1] / length
    shares = np.concatenate([half, [0.5], 1.0 - half[::-1]])
    return gear.tip_radius * unit(start + shares * (end - start))


def _even(edges: float) -> int:
    """Number of points (middles included) of a curve of about so many edges."""
    return 2 * max(int(np.ceil(edges)), 1) + 1


def _graded(length: float, first: float, last: float, growth: float) -> np.ndarray:
    """Distances (2 k + 1,) of edges' ends and middles, sizes growing from `first` to at most `last`."""
    at, ends = 0.0, [0.0]
    while at < length:
        at += min(first + 0.5 * growth * at, last)
        ends.append(at)
    ends = np.array(ends) * length / ends[-1]
    return with_middles(ends)


def _resampled(curve: np.ndarray, size: float) -> np.ndarray:
    length = along(curve)[-1]
    return points_at(curve, np.linspace(0.0, length, _even(length / size)))


def _size_function(doubled: np.ndarray, bore: np.ndarray, sizes: MeshSizes):
    """Wanted at points (n, 2): that of the boundary's edges, growing from there."""
    curves = doubled[::2], bore[::2]
    edges = [np.linalg.norm(np.roll(curve, -1, axis=0) - curve, axis=1) for curve in curves]
    # An edge's end takes the smaller of its two edges.
    size = np.concatenate([np.minimum(edge, np.roll(edge, 1)) for edge in edges])
    tree = cKDTree(np.vstack(curves))

    def wanted(points: np.ndarray) -> np.ndarray:
        distance, index = tree.query(points, k=min(len(size), 400))
        grown = size[index] + sizes.growth * np.maximum(distance - 2.0 * size[index], 0.0)
        return np.minimum(sizes.body, grown.min(axis=1))

    return wanted
