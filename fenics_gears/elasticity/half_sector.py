"""A sector that is symmetric about its tooth's centreline: one half meshed, the other its mirror image."""

from collections.abc import Callable

import numpy as np

from .element_sizes import SizeField, along, divided
from .mesh_data import BodyMesh, oriented
from .sector_boundary import SectorBoundary

CENTRELINE_SAMPLES = 400
# Parts of the half on the drive flank's side and their mirror images.
IMAGES = {"flank": "coast", "upper cut": "lower cut", "hub": "hub"}


def drive_half(
    boundary: SectorBoundary, field: SizeField, fill: Callable[[SectorBoundary, SizeField, tuple[str, ...]], BodyMesh]
) -> BodyMesh:
    """Mesh of a sector's half with the drive flank, from the sector's boundary; its edge "centreline" is the line of
    symmetry.

    fill: meshes the inside of a closed boundary by a size field, with edges for the named parts.
    """
    half = _half(boundary, field)
    mesh = fill(half, field, (*IMAGES, "centreline"))
    axis = centreline_direction(mesh)
    shared = mesh.edge_points("centreline")
    # They lie on the line but for round-off.
    points = mesh.points.copy()
    points[shared] = (points[shared] @ axis)[:, None] * axis
    return BodyMesh(points, mesh.cells, mesh.edges)


def centreline_direction(half: BodyMesh) -> np.ndarray:
    """Unit vector (2,) from the gear's centre along the line of symmetry."""
    on_it = half.points[half.edge_points("centreline")]
    outermost = on_it[np.argmax(np.linalg.norm(on_it, axis=1))]
    return outermost / np.linalg.norm(outermost)


def with_image(half: BodyMesh) -> BodyMesh:
    """Mesh of the whole sector: the half and its mirror image, joined along the centreline."""
    axis = centreline_direction(half)
    shared = half.edge_points("centreline")
    image = 2.0 * (half.points @ axis)[:, None] * axis - half.points
    own = np.setdiff1d(np.arange(len(half.points)), shared)
    index = np.arange(len(half.points))
    index[own] = len(half.points) + np.arange(len(own))
    points = np.vstack([half.points, image[own]])
    edges = {name: half.edges[name] for name in IMAGES}
    mirrored = {other: index[half.edges[name]] for name, other in IMAGES.items()}
    edges = {
        name: np.vstack([part[name] for part in (edges, mirrored) if name in part]) for name in {**edges, **mirrored}
    }
    return BodyMesh(points, oriented(points, np.vstack([half.cells, index[half.cells]])), edges, half.web)


def _half(boundary: SectorBoundary, field: SizeField) -> SectorBoundary:
    """The drive flank's side: from the bore up the cut, root, flank and half the tip, down the centreline, half the
    bore back."""
    tip_first, tip_last = boundary.parts["tip"]
    hub_first, hub_last = boundary.parts["hub"]
    top = (tip_first + tip_last) // 2
    bottom = (hub_first + hub_last) // 2
    line = np.linspace(boundary.points[top], boundary.points[bottom], CENTRELINE_SAMPLES)
    inner = along(line, divided(line, field.at(line), 4))
    points = np.vstack([boundary.points[: top + 1], inner[1:-1], boundary.points[bottom:]])
    end = top + len(inner) - 1
    parts = {name: ends for name, ends in boundary.parts.items() if ends[1] <= top}
    return SectorBoundary(points, {**parts, "centreline": (top, end), "hub": (end, len(points))})
