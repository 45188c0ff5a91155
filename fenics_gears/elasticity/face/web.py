"""A gear with a web over its face: rim and hub as wide as the face, between them a web that is thinner. Loaded by gears
with a web alone.

The body is no prism, but each of its layers is. W are the cells of the section between hub and rim; the web reaches
from z_1 to z_2. Layers between z_1 and z_2 are swept from the whole section, the others from the section without W:

    K = sum over layers of K_layer(whole section)           where the layer is in the web
                        or K_layer(section without W)       where it is not

z_1 and z_2 are boundaries of layers, and the circles of hub and rim are lines of the section's mesh. Cuts have their
nodes where there is material. Turning by a pitch still maps one cut on the other. So the ring of sectors
(`elasticity.ring`) joins the sectors exactly, and the Schur complement is that of any gear:

    A = flank block of the inverse of (sum over sectors of S),  S = K_aa - K_ad K_dd^-1 K_da,  a = flanks and cuts

with the bore held. Membrane and plate stiffness of the web, its tilting, bending and twisting of the rim and all their
couplings to the teeth are in K.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.outline import centreline_angle

from ..element_sizes import ElementSizes
from ..mesh_data import BodyMesh, oriented
from .layers import SweptWeb

# Of elements of web and hub along the radius: by how much they grow away from the circles where the width changes, and
# the largest over a pitch's arc there.
GROWTH, LARGEST = 1.4, 0.5


def webbed_section(gear: Gear, sizes: ElementSizes) -> BodyMesh:
    """Section of a sector whose mesh has lines along the circles of hub and rim. Teeth and rim are meshed as a gear
    whose bore is the rim's; rows of cells follow inwards from the nodes of that bore."""
    # Imported here: to tell the size of a section needs no gmsh.
    from ..sector_mesh import sector_mesh

    rim = sector_mesh(rim_of(gear), sizes)
    turned = rim.points @ np.array([1.0, -1.0j]) * np.exp(-1j * centreline_angle(gear)).conj()
    arc = rim.edge_points("hub")
    arc = arc[np.argsort(-np.angle(turned[arc]))]
    of_web, of_hub = _radii(gear, len(arc) - 1)
    radii = np.concatenate([of_web, of_hub[1:]])
    directions = rim.points[arc] / np.linalg.norm(rim.points[arc], axis=1)[:, None]
    points = np.vstack([rim.points, (radii[1:, None, None] * directions).reshape(-1, 2)])
    grid = np.vstack([arc, len(rim.points) + np.arange((len(radii) - 1) * len(arc)).reshape(-1, len(arc))])
    edges = {name: part for name, part in rim.edges.items() if name != "hub"}
    for name, column in (("lower cut", grid[:, 0]), ("upper cut", grid[:, -1])):
        edges[name] = np.vstack([edges[name], np.column_stack([column[:-1], column[1:]])])
    edges["hub"] = np.column_stack([grid[-1, :-1], grid[-1, 1:]])
    return BodyMesh(points, oriented(points, np.vstack([rim.cells, _cells(grid)])), edges)


def rim_of(gear: Gear) -> Gear:
    """The gear with the rim's bore, and without its web."""
    return replace(gear, bore_radius=gear.web.rim_radius, web=None)


def _radii(gear: Gear, arcs: int) -> tuple[np.ndarray, np.ndarray]:
    """Radii of the rows of nodes of web and hub, from the outside; `arcs`: elements along a sector's inner rim."""
    web, pitch, bore = gear.web, gear.angular_pitch, gear.bore_radius
    size = web.rim_radius * pitch / arcs
    of_hub = _rows(web.hub_radius, bore, size, pitch) if web.hub_radius > bore else np.array([bore])
    return _rows(web.rim_radius, web.hub_radius, size, pitch), of_hub


def _rows(outer: float, inner: float, first: float, pitch: float) -> np.ndarray:
    """Radii of the rows of nodes from one circle inwards to another: closer at both."""
    size, sizes, depth = first, [first], 0.5 * (outer - inner)
    while sum(sizes) < depth:
        size = max(first, min(GROWTH * size, LARGEST * pitch * outer))
        sizes.append(size)
    places = np.concatenate([[0.0], np.cumsum(sizes)]) * (depth / sum(sizes))
    return np.concatenate([outer - places, inner + places[-2::-1]])


def _cells(grid: np.ndarray) -> np.ndarray:
    """Two triangles for each cell of a grid of points (rows, columns), mirrored at its middle column."""
    a, b, c, d = (each.ravel() for each in (grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]))
    left = np.tile(np.arange(grid.shape[1] - 1) < grid.shape[1] // 2, len(grid) - 1)[:, None]
    one = np.where(left, np.column_stack([a, b, c]), np.column_stack([a, b, d]))
    return np.vstack([one, np.where(left, np.column_stack([a, c, d]), np.column_stack([b, c, d]))])


def outside_web(mesh: BodyMesh, web: SweptWeb) -> BodyMesh:
    """The section of a body outside its web: rim and hub."""
    cells = mesh.cells[web.outside(mesh.points[mesh.cells].mean(axis=1))]
    used = np.unique(cells)
    return BodyMesh(mesh.points[used], np.searchsorted(used, cells), {})


def rows_of_web(gear: Gear, arcs: int) -> tuple[int, int]:
    """Rows of nodes, second order, of web and hub below the rim's bore, which has so many elements along it."""
    return tuple(2 * (len(radii) - 1) for radii in _radii(gear, arcs))
