"""The boundary nodes of one tooth sector, from bore to outline between two tooth-space centres."""

from dataclasses import dataclass

import numpy as np

from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.involute import arc_length, canonical_point, roll_angle_at_arc_length
from fenics_gears.geometry.outline import ToothOutline, tip_corner, tooth_outline

from .element_sizes import ElementSizes, SizeField, SizeSource, along, divided

FILLET_SAMPLES = 201
CURVE_SAMPLES = 400
# Elements have at most the body's size to this depth (modules) below the tooth's surface, and grow beyond it.
BODY_REACH = 2.0
# Size of flank elements, in the flank's, at its own sharp edge and where the mate's edge presses; beyond, it grows by
# so much per distance. The pressure rises towards an edge as the power -1/2 to -1/3 of the distance.
AT_TIP = 0.125
AT_MATE_TIP = 0.25
EDGE_GROWTH = 0.5
EDGE_SAMPLES = 20001
# A prescribed vertex this near to an end of the flank (in element sizes) is that end.
SNAP = 1e-6


@dataclass(frozen=True)
class SectorBoundary:
    """Closed boundary of a sector.

    points: (n, 2), mm, clockwise from the bore's counter-clockwise corner, none repeated. parts: the first and last
    index of each part, both even (the last may be n).
    """

    points: np.ndarray
    parts: dict[str, tuple[int, int]]

    def part(self, name: str) -> np.ndarray:
        """Indices of the points of a part, in order."""
        first, last = self.parts[name]
        return np.arange(first, last + 1) % len(self.points)


def flank_roll_angles(gear: Gear, size: float, mate_tip: tuple[float, float] | None = None) -> np.ndarray:
    """Roll angles (rad) of the flank's element vertices, an even number of elements: even in arc length; with
    `mate_tip` (rad, see ElementSizes) closer there and towards the tip."""
    form, tip = arc_length(gear.base_radius, np.array([gear.form_roll_angle, gear.tip_roll_angle]))
    arcs = np.linspace(form, tip, 2 if mate_tip is None else EDGE_SAMPLES)
    sizes = np.full(len(arcs), size) if mate_tip is None else _size_near_edges(gear, arcs, size, mate_tip)
    density = np.concatenate([[0.0], np.cumsum(0.5 * np.diff(arcs) * (1.0 / sizes[1:] + 1.0 / sizes[:-1]))])
    elements = max(2 * int(np.ceil(0.5 * density[-1] - 1e-9)), 4)
    return roll_angle_at_arc_length(
        gear.base_radius, np.interp(np.linspace(0.0, density[-1], elements + 1), density, arcs)
    )


def _size_near_edges(gear: Gear, arcs: np.ndarray, size: float, mate_tip: tuple[float, float]) -> np.ndarray:
    """Element sizes (n,), mm, at arc lengths (n,), mm."""
    start, end = arc_length(gear.base_radius, np.array(mate_tip))
    outside = np.maximum(np.maximum(start - arcs, arcs - end), 0.0)
    return np.minimum(
        size, np.minimum(AT_TIP * size + EDGE_GROWTH * (arcs[-1] - arcs), AT_MATE_TIP * size + EDGE_GROWTH * outside)
    )


def flank_through(gear: Gear, size: float, prescribed: np.ndarray) -> np.ndarray:
    """Ascending roll angles (rad) of flank vertices that hold all prescribed ones (k,), and beyond them others `size`
    (mm) apart. The number of elements is even, unless the prescribed vertices span the whole flank."""
    form, tip = arc_length(gear.base_radius, np.array([gear.form_roll_angle, gear.tip_roll_angle]))
    inner = np.sort(arc_length(gear.base_radius, prescribed))
    inner[inner < form + SNAP * size] = form
    inner[inner > tip - SNAP * size] = tip
    beyond = np.array([inner[0] - form, tip - inner[-1]])
    elements = np.ceil(beyond / size - 1e-9).astype(int)
    if (elements.sum() + len(inner) - 1) % 2 and elements.any():
        elements[np.argmax(beyond)] += 1
    below = np.linspace(form, inner[0], elements[0] + 1)[:-1]
    above = np.linspace(inner[-1], tip, elements[1] + 1)[1:]
    return roll_angle_at_arc_length(gear.base_radius, np.concatenate([below, inner, above]))


def sector_boundary(
    gear: Gear, sizes: ElementSizes, flank_rolls: np.ndarray | None = None
) -> tuple[SectorBoundary, SizeField]:
    """Nodes along the boundary of a sector and the size field that its inside is to follow.

    flank_rolls: roll angles (rad), ascending, of the flank's vertices where they are prescribed; all else, the cuts
    above all, stays as without them.
    """
    outline = tooth_outline(gear, FILLET_SAMPLES)
    flank = canonical_point(gear.base_radius, flank_roll_angles(gear, sizes.flank, sizes.mate_tip))
    root = root_curve(outline)
    corner = tip_corner(gear) if gear.tip_chamfer else flank[-1]
    tip = _arc(gear.tip_radius, corner, outline.coast(corner))
    coast = outline.coast(flank[::-1])
    hub_angles = outline.centreline_angle + 0.5 * gear.angular_pitch * np.array([-1.0, 1.0])
    hub = gear.bore_radius * _directions(np.linspace(*hub_angles, CURVE_SAMPLES))
    field = _size_field(gear, sizes, outline, flank, root, coast, hub)

    def nodes(curve, fewest=2, multiple=2):
        return along(curve, divided(curve, field.at(curve), fewest, multiple))

    # A sector with two working flanks is meshed by halves: tip and bore have a node on the centreline, itself at an
    # even index.
    halved = 4 if sizes.both_flanks else 2

    radii = _cut_radii(gear, field, hub_angles)
    root_nodes = _on_circle(gear.root_radius, nodes(root, 12), root)
    tip_nodes = _on_circle(gear.tip_radius, nodes(tip, multiple=halved), tip)
    if gear.tip_chamfer:
        chamfer = nodes(np.linspace(flank[-1], corner, CURVE_SAMPLES))
        tip_nodes = np.vstack([chamfer[:-1], tip_nodes, outline.coast(chamfer)[-2::-1]])
    pieces = {
        "upper cut": radii[:, None] * _directions(hub_angles[1:]),
        "root": root_nodes,
        "flank": flank,
        "tip": tip_nodes,
        "coast": coast if sizes.both_flanks else nodes(coast, 4),
        "coast root": outline.coast(root_nodes)[::-1],
        "lower cut": radii[::-1, None] * _directions(hub_angles[:1]),
        "hub": _on_circle(gear.bore_radius, nodes(hub, multiple=halved), hub),
    }
    if flank_rolls is not None:
        pieces["flank"] = canonical_point(gear.base_radius, flank_rolls)
        field = _size_field(gear, sizes, outline, pieces["flank"], root, coast, hub)
    return _joined(pieces), field


def _size_field(gear, sizes, outline, flank, root, coast, hub) -> SizeField:
    growth = sizes.growth
    hub_size = abs(gear.bore_radius) * min(abs(gear.angular_pitch), sizes.hub_angle)
    largest = 0.5 * (gear.root_radius - gear.bore_radius)
    body, fillet, coast_size = (min(size, largest) for size in (sizes.body, sizes.fillet, sizes.coast))
    roots = np.vstack([root, outline.coast(root)])
    sides = (flank, coast) if sizes.both_flanks else (flank,)

    def working(curves, part: float = 1.0) -> SizeSource:
        size = part * sizes.flank
        return SizeSource(tuple(curves), min(size, body), sizes.depth * size, growth)

    near_edges = ()
    if sizes.mate_tip is not None:
        mated, tips = zip(*(_near_edges(gear, side, sizes.mate_tip) for side in sides))
        near_edges = working(mated, AT_MATE_TIP), SizeSource(tips, min(AT_TIP * sizes.flank, body), 0.0, EDGE_GROWTH)
    return SizeField(
        sources=(
            working(sides),
            *near_edges,
            SizeSource((roots,), fillet, fillet, growth),
            *(() if sizes.both_flanks else (SizeSource((coast,), coast_size, coast_size, growth),)),
            SizeSource((flank, roots, coast), body, BODY_REACH * gear.module, growth),
            # In a slender wedge elements may not outgrow the sector's own width.
            SizeSource((hub,), min(largest, hub_size), 0.0, min(growth, abs(gear.angular_pitch))),
        ),
        largest=largest,
    )


def _near_edges(gear: Gear, side: np.ndarray, mate_tip: tuple[float, float]) -> tuple[np.ndarray, np.ndarray]:
    """The points of a flank (n, 2) on which the mate's tip may press, its ends among them, and the flank's tip (1,
    2)."""
    radii = gear.sign * np.linalg.norm(side, axis=1)
    lowest, highest = gear.base_radius * np.hypot(1.0, mate_tip)
    inside = np.flatnonzero((radii > lowest) & (radii < highest))
    return side[max(inside[0] - 1, 0) : inside[-1] + 2], side[[np.argmax(radii)]]


def _cut_radii(gear: Gear, field: SizeField, hub_angles) -> np.ndarray:
    """Radii of the nodes of either cut, by the finer of the sizes wanted along the two."""
    radii = np.linspace(gear.bore_radius, gear.root_radius, CURVE_SAMPLES)
    sides = [radii[:, None] * _directions(hub_angles[i : i + 1]) for i in (0, 1)]
    size = np.minimum(*(field.at(side) for side in sides))
    return gear.bore_radius + (gear.root_radius - gear.bore_radius) * divided(sides[1], size, 4)


def root_curve(outline: ToothOutline) -> np.ndarray:
    """Root circle from the tooth space's centre, then the drive side's fillet, finely sampled."""
    gear = outline.gear
    corner = gear.root_radius * _directions(np.array([outline.space_angle]))[0]
    if np.linalg.norm(outline.fillet[0] - corner) < 1e-9 * abs(gear.root_radius):
        return outline.fillet
    return np.vstack([_arc(gear.root_radius, corner, outline.fillet[0])[:-1], outline.fillet])


def _arc(radius: float, start, end) -> np.ndarray:
    """Finely sampled arc about the gear's centre between two points."""
    turn = np.angle(complex(*end) / complex(*start))
    angles = np.angle(np.sign(radius) * complex(*start)) + np.linspace(0.0, turn, CURVE_SAMPLES)
    arc = radius * _directions(angles)
    arc[0] = start
    arc[-1] = end
    return arc


def _on_circle(radius: float, points, curve) -> np.ndarray:
    """Points interpolated between samples of an arc moved back onto it; others and the ends stay."""
    radius = abs(radius)
    distance = np.linalg.norm(points, axis=1)
    sagitta = (np.linalg.norm(np.diff(curve, axis=0), axis=1).max() ** 2) / radius
    on_arc = np.abs(distance - radius) < sagitta
    on_arc[[0, -1]] = False
    return np.where(on_arc[:, None], points * (radius / distance)[:, None], points)


def _directions(angles) -> np.ndarray:
    return np.stack([np.cos(angles), np.sin(angles)], axis=-1)


def _joined(pieces: dict[str, np.ndarray]) -> SectorBoundary:
    parts = {}
    points = []
    first = 0
    for name, piece in pieces.items():
        points.append(piece[:-1])
        parts[name] = (first, first + len(piece) - 1)
        first += len(piece) - 1
    return SectorBoundary(points=np.vstack(points), parts=parts)
