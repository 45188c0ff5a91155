"""The largest scale at which displacements may be drawn without drawing teeth into each other."""

import numpy as np
from matplotlib.path import Path
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import depth_first_order
from scipy.spatial import cKDTree

from fenics_gears.simulation.run_stresses import GearsInMesh

from .stress_grid import in_plane, largest_movement, shown_points

# In modules: how far the largest displacement may be drawn, and how deep one tooth into another. Gaps are drawn as
# large as they are, so that a pair about to touch overlaps as soon as what closes it is enlarged enough.
SHOWN_MOVEMENT = 0.12
DRAWN_OVERLAP = 0.02
STEPS = (1.0, 2.0, 5.0)


def automatic_scale(meshes: list[GearsInMesh]) -> float:
    """The largest of 1, 2, 5, 10, ... at which displacements are visible and no tooth is visibly drawn into another."""
    module = meshes[0].pair.pinion.module
    wanted = SHOWN_MOVEMENT * module / max(max(largest_movement(mesh) for mesh in meshes), 1e-9 * module)
    scales = [step * 10.0**power for power in range(9) for step in STEPS if step * 10.0**power <= wanted]
    for scale in reversed(scales):
        if all(overlap(mesh, scale) <= DRAWN_OVERLAP * module for mesh in meshes):
            return scale
    return 1.0


def overlap(mesh: GearsInMesh, scale: float) -> float:
    """How deep (mm) one gear's teeth are drawn into the other's, displacements `scale` times as large as they are."""
    loops = [shown_points(mesh, gear, scale)[outer_loop(mesh, gear)] for gear in (0, 1)]
    deepest = 0.0
    for own, other in ((loops[0], loops[1]), (loops[1], loops[0])):
        centre = 0.5 * (other.min(axis=0) + other.max(axis=0))
        reached = own[np.linalg.norm(own - centre, axis=1) < np.linalg.norm(other - centre, axis=1).max()]
        inside = reached[Path(other).contains_points(reached)]
        if len(inside):
            # Depth from the sides, not from the nodes alone: these are up to an element apart.
            deepest = max(deepest, float(_distance_to_line(inside, other).max()))
    return deepest


def outer_loop(mesh: GearsInMesh, gear: int) -> np.ndarray:
    """Nodes along a gear's outline without the bore, by the angle at which they are reached going round it."""
    body = mesh.gears[gear]
    points = in_plane(body.points)
    outline = body.of_sectors(body.outline)
    nodes = np.unique(outline)
    # Nodes at the ends of sectors are there twice, once for either sector.
    twins = nodes[cKDTree(points[nodes]).query_pairs(1e-7 * mesh.pair.pinion.module, output_type="ndarray")]
    first, second = np.vstack([outline, twins]).T
    sides = csr_matrix((np.ones(len(first)), (first, second)), shape=(len(points),) * 2)
    start = nodes[np.argmax(np.linalg.norm(points[nodes] - body.centre, axis=1))]
    # Each node has two neighbours, so that going ever deeper goes round.
    return depth_first_order(sides, start, directed=False, return_predecessors=False)


def _distance_to_line(points: np.ndarray, loop: np.ndarray) -> np.ndarray:
    """Distance (n,) of points from the sides of a closed loop next to its nearest node."""
    nearest = cKDTree(loop).query(points)[1]
    distances = []
    for step in (-1, 0):
        first = loop[(nearest + step) % len(loop)]
        second = loop[(nearest + step + 1) % len(loop)]
        along = second - first
        part = np.clip(((points - first) * along).sum(axis=1) / np.maximum((along**2).sum(axis=1), 1e-300), 0.0, 1.0)
        distances.append(np.linalg.norm(first + part[:, None] * along - points, axis=1))
    return np.minimum(*distances)
