"""The mesh of one tooth sector. Where it is symmetric about its tooth's centreline a half is meshed; the other is its
mirror image."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from scipy.spatial import cKDTree

from fenics_gears.errors import ComputationError
from fenics_gears.geometry.gear import Gear

from .element_sizes import ElementSizes, SizeField, along, divided
from .gmsh_session import gmsh_model
from .mesh_data import BodyMesh, oriented, split_to_quadrilaterals
from .sector_boundary import SectorBoundary, sector_boundary

NAMED_PARTS = ("flank", "coast", "hub", "lower cut", "upper cut")
# gmsh's numbers of cell types
TRIANGLE = 2
QUADRILATERAL = 3
# Outlines that differ in their last bit get different meshes from gmsh, and their compliances differ by up to 1 %.
# Outlines are rounded to so many decimals (modules): far coarser than round-off, far finer than any element.
DECIMALS = 9
CENTRELINE_SAMPLES = 400
# Parts of the half on the drive flank's side and their mirror images.
IMAGES = {"flank": "coast", "upper cut": "lower cut", "hub": "hub"}


def sector_mesh(
    gear: Gear, sizes: ElementSizes, quadrilaterals: bool = False, flank_rolls: np.ndarray | None = None
) -> BodyMesh:
    """Mesh of one tooth sector, its two cuts congruent node for node.

    With both flanks working it is symmetric about the tooth's centreline. Flank vertices are on the exact involute,
    even in arc length or at `flank_rolls` (rad, see sector_boundary). Quadrilaterals come from a mesh of twice the size
    whose every cell is split, so that no triangle is left over. gmsh works in modules: similar gears get similar
    meshes. Raises ComputationError when gmsh fails, a cell is folded, or quadrilaterals meet an odd number of flank
    elements.
    """
    boundary, field = sector_boundary(gear.of_module_one, sizes.in_modules_of(gear), flank_rolls)
    fill = _filled_with_quadrilaterals if quadrilaterals else _filled_with_triangles
    if sizes.both_flanks:
        return _scaled(with_image(drive_half(boundary, field, fill)), gear)
    return _scaled(fill(boundary, field, NAMED_PARTS), gear)


def _scaled(mesh: BodyMesh, gear: Gear) -> BodyMesh:
    return BodyMesh(gear.module * mesh.points, mesh.cells, mesh.edges, gear.web, gear.foundation)


def _filled_with_triangles(boundary: SectorBoundary, field: SizeField, parts: tuple[str, ...]) -> BodyMesh:
    points, cells = filled(boundary.points, field, 1.0, recombine=False)
    return BodyMesh(points, oriented(points, cells[0]), _edges(boundary, np.arange(len(boundary.points)), parts))


def _filled_with_quadrilaterals(boundary: SectorBoundary, field: SizeField, parts: tuple[str, ...]) -> BodyMesh:
    if len(boundary.part("flank")) % 2 == 0:
        raise ComputationError(
            "quadrilaterals need an even number of elements on the flank; choose other contact_nodes"
        )
    coarse = boundary.points[::2]
    points, cells = filled(coarse, field, 2.0, recombine=True)
    exact = _odd_points(boundary)
    points, split, middle = split_to_quadrilaterals(points, cells, exact)
    index = np.empty(len(boundary.points), dtype=int)
    index[::2] = np.arange(len(coarse))
    index[1::2] = [middle[side] for side in exact]
    return BodyMesh(points, oriented(points, split), _edges(boundary, index, parts))


def filled(
    boundary: np.ndarray,
    field: SizeField,
    scale: float,
    recombine: bool,
    slit: np.ndarray | None = None,
    mouth: int = 0,
) -> tuple[np.ndarray, list[np.ndarray]]:
    """Mesh the inside of a closed polygon (n, 2), in modules, whose edges stay undivided; the same mesh for polygons
    that differ by round-off.

    slit: (k, 2), points of a line that goes inwards from the boundary's point `mouth`, whose edges stay undivided too.
    Returns points, the boundary's first and in its order, then the slit's, and the cells: triangles, then with
    ``recombine`` quadrilaterals.
    """
    with gmsh_model("gear sector") as gmsh:
        try:
            tags = [gmsh.model.geo.addPoint(x, y, 0.0) for x, y in np.round(boundary, DECIMALS)]
            lines = [gmsh.model.geo.addLine(a, b) for a, b in zip(tags, tags[1:] + tags[:1])]
            inner = [] if slit is None else [gmsh.model.geo.addPoint(x, y, 0.0) for x, y in np.round(slit, DECIMALS)]
            along_slit = [gmsh.model.geo.addLine(a, b) for a, b in zip([tags[mouth], *inner], inner)]
            surface = gmsh.model.geo.addPlaneSurface([gmsh.model.geo.addCurveLoop(lines)])
            gmsh.model.geo.synchronize()
            for line in lines + along_slit:
                gmsh.model.mesh.setTransfiniteCurve(line, 2)
            if along_slit:
                gmsh.model.mesh.embed(1, along_slit, 2, surface)
            if recombine:
                gmsh.model.mesh.setRecombine(2, surface)
            given = boundary if slit is None else np.vstack([boundary, slit])
            field.set_background(gmsh, given, tags + inner, scale)
            gmsh.model.mesh.generate(2)
            return _read(gmsh, given, recombine)
        except ComputationError:
            raise
        except Exception as error:  # gmsh raises nothing more precise
            raise ComputationError(
                f"gmsh could not mesh the tooth sector ({error}); choose other element sizes"
            ) from error


def _read(gmsh, boundary, recombine: bool):
    node_tags, coordinates, _ = gmsh.model.mesh.getNodes()
    points = np.asarray(coordinates).reshape(-1, 3)[:, :2]
    distance, first = cKDTree(points).query(boundary)
    if distance.max() > 1e-9 * np.abs(boundary).max() or len(np.unique(first)) != len(boundary):
        raise ComputationError("gmsh moved or divided the boundary of the tooth sector")
    order = np.concatenate([first, np.setdiff1d(np.arange(len(points)), first)])
    new_index = np.empty(int(np.max(node_tags)) + 1, dtype=int)
    new_index[np.asarray(node_tags, dtype=int)[order]] = np.arange(len(order))
    cells = []
    for cell_type, corners in ((TRIANGLE, 3), (QUADRILATERAL, 4))[: 2 if recombine else 1]:
        tags = gmsh.model.mesh.getElementsByType(cell_type)[1]
        cells.append(new_index[np.asarray(tags, dtype=int)].reshape(-1, corners))
    used = np.unique(np.concatenate([part.ravel() for part in cells]))
    if len(used) != len(points):
        raise ComputationError("gmsh left points of the tooth sector without a cell")
    ordered = points[order]
    ordered[: len(boundary)] = boundary
    return ordered, cells


def _odd_points(boundary: SectorBoundary) -> dict[tuple[int, int], np.ndarray]:
    """Position of each odd boundary point, by the coarse edge (smaller index first) that it divides."""
    coarse = len(boundary.points) // 2
    edges = [(i, (i + 1) % coarse) for i in range(coarse)]
    return {(min(edge), max(edge)): boundary.points[2 * edge[0] + 1] for edge in edges}


def _edges(boundary: SectorBoundary, index: np.ndarray, names: tuple[str, ...]) -> dict[str, np.ndarray]:
    parts = {name: index[boundary.part(name)] for name in names}
    return {name: np.stack([part[:-1], part[1:]], axis=-1) for name, part in parts.items()}


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
    cells = oriented(points, np.vstack([half.cells, index[half.cells]]))
    return replace(half, points=points, cells=cells, edges=edges)


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
