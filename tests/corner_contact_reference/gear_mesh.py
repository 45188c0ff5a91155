"""A mesh of a whole gear in six-node triangles for a general-purpose code: a few teeth finely meshed, tip edges
rounded."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from fenics_gears.elasticity.gmsh_session import gmsh_model
from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.involute import arc_length, canonical_point, roll_angle_at_arc_length
from fenics_gears.geometry.outline import tooth_outline
from fenics_gears.geometry.tip_edge import tip_edge


@dataclass(frozen=True)
class MeshSizes:
    """Element sizes, mm: along the loaded flanks, at their tip edges (graded between), in fillets and far away.

    `growth`: increase of size per distance from the flank.
    """

    flank: float
    tip: float
    fillet: float = 0.3
    coarse: float = 1.2
    body: float = 2.0
    growth: float = 0.35

    def scaled(self, factor: float) -> MeshSizes:
        """All sizes times a factor."""
        return MeshSizes(
            *(factor * size for size in (self.flank, self.tip, self.fillet, self.coarse, self.body)), self.growth
        )


@dataclass(frozen=True)
class GearMesh:
    """Six-node triangles: `points` (n, 2), mm, in the body frame of tooth 0; `cells` (m, 6), corners, then the sides'
    middles.

    `hub`: indices of the bore's nodes. `contact`: (cell, side) of the edges on the loaded teeth's flanks, tip edges and
    tip lands, (k, 2).
    """

    points: np.ndarray
    cells: np.ndarray
    hub: np.ndarray
    contact: np.ndarray


def rotation(angle: float) -> np.ndarray:
    """The matrix (2, 2) that turns by an angle (rad) counter-clockwise."""
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def gear_mesh(gear: Gear, sizes: MeshSizes, edge_radius: float, loaded: tuple[int, ...]) -> GearMesh:
    """The mesh of a gear whose teeth `loaded` (pitches counter-clockwise of tooth 0) are meshed finely."""
    doubled, touching = _outline(gear, sizes, edge_radius, loaded)
    count = max(2 * int(np.ceil(np.pi * gear.bore_radius / (0.05 * gear.bore_radius))), 40)
    angles = -2.0 * np.pi * np.arange(2 * count) / (2 * count)
    bore = gear.bore_radius * np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    corners, triangles = _triangles(doubled, touching, bore, sizes)
    points, cells, side_of = _six_nodes(corners, triangles)
    outer = len(doubled) // 2
    contact, hub = [], []
    for first, curve, is_outline in ((0, doubled, True), (outer, bore, False)):
        number = len(curve) // 2
        for i in range(number):
            a, b = first + i, first + (i + 1) % number
            cell, side, middle = side_of[min(a, b), max(a, b)]
            points[middle] = curve[2 * i + 1]
            if not is_outline:
                hub += [a, middle]
            elif touching[i]:
                contact.append((cell, side))
    return GearMesh(points, cells, np.array(hub), np.array(contact))


def _outline(gear: Gear, sizes: MeshSizes, edge_radius: float, loaded) -> tuple[np.ndarray, np.ndarray]:
    """Closed outline, clockwise, with the middle of every edge (2 k, 2), and whether an edge (k,) is one that may
    touch."""
    fine, coarse = (_tooth(gear, sizes, edge_radius, is_loaded) for is_loaded in (True, False))
    points, touching = [], []
    chosen = {tooth % gear.teeth for tooth in loaded}
    for tooth in range(gear.teeth - 1, -1, -1):
        pieces, flags = fine if tooth in chosen else coarse
        points.append(pieces @ rotation(tooth * gear.angular_pitch).T)
        touching.append(flags)
    return np.vstack(points), np.concatenate(touching)


def _tooth(gear: Gear, sizes: MeshSizes, edge_radius: float, loaded: bool) -> tuple[np.ndarray, np.ndarray]:
    """Outline of one tooth from space to space, clockwise, middles of edges included, last point left out."""
    edge = tip_edge(gear, edge_radius if loaded else 0.0)
    outline = tooth_outline(gear, 401)
    flank_size, tip_size, size = (
        (sizes.flank, sizes.tip, sizes.fillet) if loaded else (sizes.coarse, sizes.coarse, sizes.coarse)
    )
    fillet = _resampled(outline.fillet, size)
    root_angle = np.angle(complex(*outline.fillet[0]))
    root_points = _even(gear.root_radius * abs(outline.space_angle - root_angle) / size)
    root = gear.root_radius * _unit(np.linspace(outline.space_angle, root_angle, root_points))
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


def _land(gear: Gear, corner: np.ndarray, opposite: np.ndarray, tip_size: float, sizes: MeshSizes) -> np.ndarray:
    """The tip circle from one edge to the other, fine at both."""
    start, end = (np.angle(complex(*point)) for point in (corner, opposite))
    length = gear.tip_radius * abs(end - start)
    half = _graded(0.5 * length, tip_size, sizes.coarse, sizes.growth)[:-1] / length
    shares = np.concatenate([half, [0.5], 1.0 - half[::-1]])
    return gear.tip_radius * _unit(start + shares * (end - start))


def _unit(angles) -> np.ndarray:
    return np.stack([np.cos(angles), np.sin(angles)], axis=-1)


def _even(edges: float) -> int:
    """Number of points (middles included) of a curve of about so many edges."""
    return 2 * max(int(np.ceil(edges)), 1) + 1


def _graded(length: float, first: float, last: float, growth: float) -> np.ndarray:
    """Distances (2 k + 1,) from 0 to length of edges' ends and middles, sizes growing from `first` to at most
    `last`."""
    at, ends = 0.0, [0.0]
    while at < length:
        at += min(first + 0.5 * growth * at, last)
        ends.append(at)
    ends = np.array(ends) * length / ends[-1]
    return np.insert(ends, np.arange(1, len(ends)), 0.5 * (ends[1:] + ends[:-1]))


def _resampled(curve: np.ndarray, size: float) -> np.ndarray:
    length = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(curve, axis=0), axis=1))])
    at = np.linspace(0.0, length[-1], _even(length[-1] / size))
    return np.stack([np.interp(at, length, curve[:, i]) for i in range(2)], axis=-1)


def _triangles(doubled, touching, bore, sizes: MeshSizes) -> tuple[np.ndarray, np.ndarray]:
    """Corner nodes, those of outline and bore first, and triangles of the region between outline and bore."""
    outline, inner = doubled[::2], bore[::2]
    with gmsh_model("gear") as gmsh:
        loops, tags = [], []
        for curve in (outline, inner):
            own = [gmsh.model.geo.addPoint(x, y, 0.0) for x, y in curve]
            loops.append([gmsh.model.geo.addLine(a, b) for a, b in zip(own, own[1:] + own[:1])])
            tags += own
        gmsh.model.geo.addPlaneSurface([gmsh.model.geo.addCurveLoop(loop) for loop in loops])
        gmsh.model.geo.synchronize()
        for loop in loops:
            for line in loop:
                gmsh.model.mesh.setTransfiniteCurve(line, 2)
        everything = np.vstack([outline, inner])
        edge = np.concatenate([np.linalg.norm(np.roll(c, -1, axis=0) - c, axis=1) for c in (outline, inner)])
        # An edge's end takes the smaller of its two edges.
        size = np.concatenate([np.minimum(part, np.roll(part, 1)) for part in np.split(edge, [len(outline)])])
        tree = cKDTree(everything)
        neighbours = min(len(everything), 400)

        def wanted(dim, tag, x, y, z, lc):
            distance, index = tree.query((x, y), k=neighbours)
            return float(
                min(sizes.body, np.min(size[index] + sizes.growth * np.maximum(distance - 2.0 * size[index], 0.0)))
            )

        gmsh.model.mesh.setSizeCallback(wanted)
        gmsh.model.mesh.generate(2)
        gmsh.model.mesh.removeSizeCallback()
        node_tags, coordinates, _ = gmsh.model.mesh.getNodes()
        cells = np.asarray(gmsh.model.mesh.getElementsByType(2)[1], dtype=int).reshape(-1, 3)
    points = np.asarray(coordinates).reshape(-1, 3)[:, :2]
    distance, first = cKDTree(points).query(everything)
    if distance.max() > 1e-9 or len(set(first)) != len(everything):
        raise RuntimeError("gmsh moved or divided the boundary")
    order = np.concatenate([first, np.setdiff1d(np.arange(len(points)), first)])
    index = np.empty(int(np.max(node_tags)) + 1, dtype=int)
    index[np.asarray(node_tags, dtype=int)[order]] = np.arange(len(order))
    corners, triangles = points[order], index[cells]
    a, b, c = (corners[triangles[:, i]] for i in range(3))
    clockwise = np.cross(b - a, c - a) < 0.0
    triangles[clockwise] = triangles[clockwise][:, [0, 2, 1]]
    return corners, triangles


def _six_nodes(corners: np.ndarray, triangles: np.ndarray):
    """Points and cells with the sides' middles; for each edge (smaller corner first) a cell, its side, the middle's
    index."""
    side_of, cells, middles = {}, np.empty((len(triangles), 6), dtype=int), []
    cells[:, :3] = triangles
    for number, triangle in enumerate(triangles):
        for side in range(3):
            a, b = triangle[side], triangle[(side + 1) % 3]
            key = min(a, b), max(a, b)
            if key not in side_of:
                side_of[key] = (number, side, len(corners) + len(middles))
                middles.append(0.5 * (corners[a] + corners[b]))
            cells[number, 3 + side] = side_of[key][2]
    return np.vstack([corners, middles]), cells, side_of
