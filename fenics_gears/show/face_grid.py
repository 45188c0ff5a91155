"""The teeth of a run over the face in three dimensions: surfaces for pictures, and a file that ParaView opens."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from fenics_gears.errors import ComputationError
from fenics_gears.simulation.face_stresses import GearsInSpace, TeethInSpace

# VTK's number of the wedge of second order in section and layer, and where its nodes lie: (height, node of the
# triangle).
VTK_WEDGE = 32
WEDGE_NODES = [
    *((height, node) for node_group in ((0, 1, 2), (3, 4, 5)) for height in (0, 2) for node in node_group),
    *((1, node) for node in range(6)),
]


def surface(points: np.ndarray, teeth: TeethInSpace) -> np.ndarray:
    """Triangles (k, 3) of the surface of sectors whose nodes are points (s, h, n, 3): sides swept over the heights, and
    both end faces."""
    sectors, heights, nodes = points.shape[:3]
    near, far = teeth.outline[:, 0], teeth.outline[:, 1]
    quads = np.concatenate(
        [
            np.vstack([np.column_stack([near, far, far + nodes]), np.column_stack([near, far + nodes, near + nodes])])
            + nodes * low
            for low in range(heights - 1)
        ]
    )
    # Seen from outside, all are counter-clockwise.
    ends = np.vstack([teeth.subcells[:, ::-1], teeth.subcells + nodes * (heights - 1)])
    one = np.vstack([quads, ends])
    return (one[None] + heights * nodes * np.arange(sectors)[:, None, None]).reshape(-1, 3)


def wedges(teeth: TeethInSpace) -> np.ndarray:
    """Cells (k, 18) of VTK's wedge of second order over all nodes, by sector and layer."""
    sectors, heights, nodes = teeth.points.shape[:3]
    one = np.column_stack([nodes * height + teeth.cells[:, node] for height, node in WEDGE_NODES])
    layers = np.concatenate([one + 2 * nodes * layer for layer in range(heights // 2)])
    return (layers[None] + heights * nodes * np.arange(sectors)[:, None, None]).reshape(-1, 18)


def save_vtu(mesh: GearsInSpace, path: Path) -> None:
    """Displacement (mm) and stress (MPa) of the recovered sectors of both gears as a .vtu file of wedges of second
    order, in the frame of the line of action.

    Raises ComputationError without pyvista.
    """
    try:
        import pyvista
    except ImportError as error:
        raise ComputationError("a .vtu file needs pyvista, which is not installed") from error
    first, second = mesh.gears
    count = first.points[..., 0].size
    cells = np.vstack([wedges(first), wedges(second) + count])

    def both(values) -> np.ndarray:
        return np.concatenate([values(gear) for gear in mesh.gears])

    grid = pyvista.UnstructuredGrid({VTK_WEDGE: cells}, both(lambda gear: gear.points.reshape(-1, 3)))
    grid.point_data["displacement"] = both(lambda gear: gear.displacement.reshape(-1, 3))
    stress = both(lambda gear: gear.stress.reshape(-1, 3, 3))
    for name, (i, j) in {"xx": (0, 0), "yy": (1, 1), "zz": (2, 2), "xy": (0, 1), "yz": (1, 2), "xz": (0, 2)}.items():
        grid.point_data[f"stress_{name}"] = stress[:, i, j]
    grid.point_data["von_mises_stress"] = both(lambda gear: gear.von_mises.ravel())
    grid.point_data["largest_principal_stress"] = both(lambda gear: gear.principal.ravel())
    grid.point_data["gear"] = np.repeat([1, 2], [count, len(stress) - count]).astype(np.int32)
    grid.point_data["sector"] = both(
        lambda gear: np.repeat(np.array(gear.sectors, dtype=np.int32), gear.points[0, ..., 0].size)
    )
    grid.save(str(path))
