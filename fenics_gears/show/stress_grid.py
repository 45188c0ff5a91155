"""Two gears in mesh where they are drawn, and as a file that ParaView opens.

Pictures have the line of centres upright, the pinion above; files have the frame of the line of action.
"""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from fenics_gears.errors import ComputationError
from fenics_gears.geometry.in_mesh import common_depth, extent_of, upright
from fenics_gears.simulation.run_stresses import GearInSpace, GearsInMesh

# VTK's numbers of cell types, by the number of their nodes; where the nodes of its wedge of second order in section and
# layer lie: (height, node of the triangle).
VTK_CELL = {3: 5, 4: 9, 18: 32}
WEDGE_NODES = [
    *((height, node) for node_group in ((0, 1, 2), (3, 4, 5)) for height in (0, 2) for node in node_group),
    *((1, node) for node in range(6)),
]
PLANE_STRESSES = {"xx": (0, 0), "yy": (1, 1), "xy": (0, 1), "zz": (2, 2)}
STRESSES = PLANE_STRESSES | {"yz": (1, 2), "xz": (0, 2)}
# Mesh cycles: whole ones may be written a little less.
ROUNDING = 1e-9


def in_plane(values: np.ndarray) -> np.ndarray:
    """Points or vectors (m, 2) of all nodes of a plane gear, from (s, 1, n, 3)."""
    return values[..., :2].reshape(-1, 2)


def shown_points(mesh: GearsInMesh, gear: int, scale: float) -> np.ndarray:
    """Nodes (m, 2), mm, of a plane gear in the picture, their displacement `scale` times as large as it is.

    The hubs stay on their nominal centres and either gear turns by half of the approach of the flanks: so flanks that
    touch are drawn touching at any scale.
    """
    body = mesh.gears[gear]
    radius = mesh.pair.gears[gear].base_radius
    points = in_plane(body.points)
    arm = points - body.centre
    arc = -0.5 * mesh.approach if mesh.coast else 0.5 * mesh.approach
    turned = arc / radius * np.column_stack([-arm[:, 1], arm[:, 0]])
    return upright(mesh.pair, points + scale * (in_plane(body.elastic) + turned))


def largest_movement(mesh: GearsInMesh) -> float:
    """Largest displacement (mm) among those drawn at scale 1."""
    return max(
        float(np.linalg.norm(shown_points(mesh, gear, 1.0) - shown_points(mesh, gear, 0.0), axis=1).max())
        for gear in (0, 1)
    )


@dataclass(frozen=True)
class View:
    """A part of the picture's plane: its centre (x, y) and half its width and height, mm."""

    centre: np.ndarray
    half: np.ndarray

    @property
    def extent(self) -> tuple[float, float, float, float]:
        """Left, right, bottom, top, mm."""
        x, y = self.centre
        w, h = self.half
        return x - w, x + w, y - h, y + h


def whole_view(mesh: GearsInMesh) -> View:
    """Both gears with some room around them."""
    low, high = np.array(extent_of(mesh.pair)).T
    return View(0.5 * (low + high), 0.52 * (high - low))


def teeth_view(mesh: GearsInMesh, coast: bool) -> View:
    """The teeth along the path of contact of drive or coast flanks, their roots included."""
    pair = mesh.pair
    middle = 0.5 * (pair.path_start + pair.path_end)
    centre = upright(pair, np.array([middle, -pair.pinion.base_radius]), coast)
    depth = common_depth(pair) + 4.0 * pair.pinion.module
    return View(centre, np.array([0.75 * (pair.path_end - pair.path_start), 0.5 * depth]))


def fitted(view: View, width: float, height: float) -> View:
    """The view widened one way until it has a panel's shape."""
    half = view.half
    return View(view.centre, np.array([max(half[0], half[1] * width / height), max(half[1], half[0] * height / width)]))


def surface(points: np.ndarray, gear: GearInSpace) -> np.ndarray:
    """Triangles (k, 3), counter-clockwise from outside, of the surface of sectors whose nodes are points (s, h, n,
    3)."""
    sectors, heights, nodes = points.shape[:3]
    parts = []
    # Seen from outside, all are counter-clockwise.
    for low in range(heights - 1):
        near, far = gear.of_layer(low // 2)[1].T
        quads = [np.column_stack([near, far, far + nodes]), np.column_stack([near, far + nodes, near + nodes])]
        parts += [quad + nodes * low for quad in quads]
    for height in range(0, heights, 2):
        below, above = (_cells_of(gear, layer) for layer in (height // 2 - 1, height // 2))
        for own, other, turn in ((above, below, -1), (below, above, 1)):
            ends = replace(gear.section, cells=gear.section.cells[own & ~other]).subcells
            parts.append(ends[:, ::turn] + nodes * height)
    one = np.vstack(parts)
    return (one[None] + heights * nodes * np.arange(sectors)[:, None, None]).reshape(-1, 3)


def _cells_of(gear: GearInSpace, layer: int) -> np.ndarray:
    """Which of the section's cells (m,) a layer has; none beyond the face."""
    cells = gear.section.cells
    if not 0 <= layer < len(gear.in_web):
        return np.zeros(len(cells), dtype=bool)
    return np.isin(cells, gear.of_layer(layer)[0].cells).all(axis=1)


def wedges(gear: GearInSpace) -> np.ndarray:
    """Cells (k, 18) of VTK's wedge of second order over all nodes, by sector and layer."""
    sectors, heights, nodes = gear.points.shape[:3]
    layers = []
    for layer in range(heights // 2):
        cells = gear.of_layer(layer)[0].cells
        layers.append(np.column_stack([nodes * (2 * layer + h) + cells[:, node] for h, node in WEDGE_NODES]))
    layers = np.concatenate(layers)
    return (layers[None] + heights * nodes * np.arange(sectors)[:, None, None]).reshape(-1, 18)


def save_vtu(mesh: GearsInMesh, path: Path, *, precision: type = np.float64) -> None:
    """Both gears' displacement (mm) and stress (MPa) as a .vtu file, in the frame of the line of action.

    In the plane whole gears, whose points are the same material points at every stored time; over the face the
    recovered sectors as wedges of second order. `precision`: of what is written. Raises ComputationError without
    pyvista.
    """
    try:
        import pyvista
    except ImportError as error:
        raise ComputationError("a .vtu file needs pyvista, which is not installed") from error
    bodies = mesh.gears if mesh.over_face else tuple(in_tooth_order(mesh, gear) for gear in (0, 1))
    first, second = (wedges(each) if mesh.over_face else each.of_sectors(each.section.subcells) for each in bodies)
    cells = np.vstack([first, second + bodies[0].von_mises.size])
    points = np.vstack([body.points.reshape(-1, 3) for body in bodies]).astype(precision)
    grid = pyvista.UnstructuredGrid({VTK_CELL[cells.shape[1]]: cells}, points)
    fields = [_fields(body, number, mesh.over_face) for number, body in enumerate(bodies, 1)]
    for name, values in fields[0].items():
        both = np.concatenate([values, fields[1][name]])
        grid.point_data[name] = both.astype(precision if both.dtype == float else np.int32)
    grid.save(str(path))


def _fields(body: GearInSpace, number: int, over_face: bool) -> dict[str, np.ndarray]:
    if over_face:
        fields = {"displacement": body.elastic}
        components = STRESSES
        fields["largest_principal_stress"] = body.principal
    else:
        fields = {"displacement": body.displacement}
        components = PLANE_STRESSES
        fields["elastic_displacement"] = body.elastic
    fields |= {f"stress_{name}": body.stress[..., i, j] for name, (i, j) in components.items()}
    fields["von_mises_stress"] = body.von_mises
    flat = {name: values.reshape(-1, *values.shape[3:]) for name, values in fields.items()}
    flat["gear"] = np.full(body.von_mises.size, number)
    flat["sector" if over_face else "tooth"] = np.repeat(body.sectors, body.points[0, ..., 0].size)
    return flat


def in_tooth_order(mesh: GearsInMesh, gear: int) -> GearInSpace:
    """A plane gear whose sectors are in the order of its teeth: tooth j is the one that tooth pair j loads.

    The sectors of a `GearInSpace` begin anew in each mesh cycle, with the tooth that last reached the start of contact.
    """
    teeth = mesh.pair.gears[gear].tooth_count
    cycles = int(np.floor(mesh.mesh_phase + ROUNDING))
    # Sectors are counted counterclockwise; so turns the pinion.
    sectors = (cycles - np.arange(teeth)) * (1 if gear == 0 else -1) % teeth
    body = mesh.gears[gear]
    ordered = {name: getattr(body, name)[sectors] for name in ("points", "elastic", "stress")}
    return replace(body, sectors=tuple(range(teeth)), **ordered)
