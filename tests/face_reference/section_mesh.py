"""A transverse section in six-node triangles, fine under bands of a few flanks; not the program's mesher."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree
from tests.six_node_mesh import along, points_at, six_node_mesh, unit, with_middles

from fenics_gears import Gear
from fenics_gears.geometry.involute import arc_length, canonical_point, roll_angle_at_arc_length
from fenics_gears.geometry.outline import tooth_outline

CURVE_SAMPLES = 801


@dataclass(frozen=True)
class SectionSizes:
    """Element sizes, mm: in the band of contact (down to `depth`), in fillets of loaded teeth, elsewhere on their
    surface, and far away. `growth`: increase per distance; `teeth_beside`: whole teeth on either side of the loaded
    ones."""

    band: float
    depth: float = 0.25
    fillet: float = 0.5
    tooth: float = 0.9
    body: float = 3.5
    growth: float = 0.4
    teeth_beside: int = 2


@dataclass(frozen=True)
class Section:
    """`points` (n, 2), mm, in the body frame of tooth 0; `cells` (m, 6), corners, then middles of sides 01, 12, 20;
    `held`: bore. `flanks`: for each loaded tooth (pitches counter-clockwise of tooth 0) roll angles (2 k + 1,) and
    nodes of its drive flank."""

    points: np.ndarray
    cells: np.ndarray
    held: np.ndarray
    flanks: dict[int, tuple[np.ndarray, np.ndarray]]


def rotated(points: np.ndarray, angle) -> np.ndarray:
    x, y = points[..., 0], points[..., 1]
    return np.stack([np.cos(angle) * x - np.sin(angle) * y, np.sin(angle) * x + np.cos(angle) * y], axis=-1)


def section_mesh(gear: Gear, bands: dict[int, tuple[float, float]], sizes: SectionSizes) -> Section:
    """`bands`: roll angles (rad) between which each tooth (pitches counter-clockwise of tooth 0) touches."""
    size = _size_function(gear, bands, sizes)
    curves = _outline_curves(gear, bands, sizes.teeth_beside)
    doubled, flank_starts = [], {}
    for tooth, name, curve in curves:
        if name == "flank" and tooth in bands:
            flank_starts[tooth] = sum(len(piece) for piece in doubled)
        nodes = _divided(curve, size)
        if name == "flank":
            nodes = _on_involute(gear, nodes, tooth)
        doubled.append(nodes[:-1])
    lengths = [len(piece) for piece in doubled]
    outline = np.vstack(doubled)
    bore = _divided(gear.bore_radius * unit(np.linspace(0.0, -2.0 * np.pi, CURVE_SAMPLES)), size)[:-1]
    bore *= gear.bore_radius / np.linalg.norm(bore, axis=1)[:, None]
    points, cells, (on_outline, held) = six_node_mesh(outline, bore, size)
    flanks = {}
    for (tooth, name, _), length in zip(curves, lengths):
        if name == "flank" and tooth in bands:
            nodes = on_outline[flank_starts[tooth] + np.arange(length + 1)]
            flanks[tooth] = (
                np.sqrt(np.maximum(np.sum(points[nodes] ** 2, axis=1) / gear.base_radius**2 - 1.0, 0.0)),
                nodes,
            )
    return Section(points, cells, held, flanks)


def _size_function(gear: Gear, bands, sizes: SectionSizes):
    outline = tooth_outline(gear, 101)
    rolls = np.linspace(gear.form_roll_angle, gear.tip_roll_angle, 101)
    flank, fillets = outline.involute(rolls), np.vstack([outline.fillet, outline.coast(outline.fillet)])
    surface = np.vstack([flank, outline.coast(flank), fillets])
    sources = []
    for tooth, (low, high) in bands.items():
        turn = tooth * gear.angular_pitch
        band = outline.involute(np.linspace(low, high, 401))
        for points, size, reach in (
            (band, sizes.band, sizes.depth),
            (fillets, sizes.fillet, 0.5 * sizes.fillet),
            (surface, sizes.tooth, sizes.tooth),
        ):
            sources.append((cKDTree(rotated(points, turn)), size, reach))

    def size(points: np.ndarray) -> np.ndarray:
        found = np.full(len(points), sizes.body)
        for tree, smallest, reach in sources:
            found = np.minimum(found, smallest + sizes.growth * np.maximum(tree.query(points)[0] - reach, 0.0))
        return found

    return size


def _outline_curves(gear: Gear, bands, beside: int) -> list[tuple[int, str, np.ndarray]]:
    """Tooth, name and samples (k, 2) of the closed outline's curves, clockwise; far teeth are a piece of the root
    circle."""
    outline = tooth_outline(gear, 401)
    arcs = np.linspace(
        *arc_length(gear.base_radius, np.array([gear.form_roll_angle, gear.tip_roll_angle])), CURVE_SAMPLES
    )
    flank = canonical_point(gear.base_radius, roll_angle_at_arc_length(gear.base_radius, arcs))
    root = _arc(gear.root_radius, outline.space_angle, outline.fillet[0])
    land = _arc(gear.tip_radius, np.angle(complex(*flank[-1])), outline.coast(flank[-1]))
    whole = [("root", root), ("fillet", outline.fillet), ("flank", flank), ("land", land)]
    whole += [(f"coast {name}", outline.coast(curve)[::-1]) for name, curve in whole[2::-1]]
    missing = [("root", gear.root_radius * unit(outline.space_angle - gear.angular_pitch * np.linspace(0.0, 1.0, 401)))]
    kept = {(tooth + step) % gear.teeth for tooth in bands for step in range(-beside, beside + 1)}
    named = {tooth % gear.teeth: tooth for tooth in bands}
    curves = []
    for tooth in range(gear.teeth - 1, -1, -1):
        for name, curve in whole if tooth in kept else missing:
            curves.append((named.get(tooth, tooth), name, rotated(curve, tooth * gear.angular_pitch)))
    return curves


def _arc(radius: float, start: float, end: np.ndarray) -> np.ndarray:
    turn = np.angle(complex(*end) / np.exp(1j * start))
    return radius * unit(start + turn * np.linspace(0.0, 1.0, 401))


def _divided(curve: np.ndarray, size) -> np.ndarray:
    """Vertices of edges as long as `size` asks for, and their middles, along a curve (k, 2)."""
    length = along(curve)
    wanted = 1.0 / size(curve)
    edges = np.concatenate([[0.0], np.cumsum(0.5 * (wanted[1:] + wanted[:-1]) * np.diff(length))])
    ends = np.interp(np.linspace(0.0, edges[-1], max(int(np.ceil(edges[-1])), 1) + 1), edges, length)
    return points_at(curve, with_middles(ends))


def _on_involute(gear: Gear, nodes: np.ndarray, tooth: int) -> np.ndarray:
    return rotated(
        canonical_point(gear.base_radius, gear.roll_angle(np.linalg.norm(nodes, axis=1))), tooth * gear.angular_pitch
    )
