"""Bodies of revolution: by the program's sectors, and by finite elements of the meridian section, one harmonic at a
time. Young's modulus 1 MPa."""

from math import pi
from typing import NamedTuple

import numpy as np
import scipy.sparse
import ufl
from scipy.sparse.linalg import spsolve
from tests.structured import cells_of

from fenics_gears.elasticity import dolfinx_adapter as adapter
from fenics_gears.elasticity.condensation import by_radius
from fenics_gears.elasticity.face.condensed import condensed_swept_sector, parts_of_ring
from fenics_gears.elasticity.face.layers import Sweep, SweptWeb, layers_of_face, layers_with_web
from fenics_gears.elasticity.face.web import _cells
from fenics_gears.elasticity.mesh_data import BodyMesh, oriented
from fenics_gears.elasticity.ring import joined_blocks
from fenics_gears.elasticity.slice_averages import slice_averages
from fenics_gears.elasticity.stiffness import assembled

POISSON = 0.3
# Sectors without teeth, loaded on a line of their outer circle.
SECTORS, ARCS, BORE, OUTER = 24, 6, 20.0, 60.0


def ring_sector(rim):
    """A sector with an upright centreline, radii from bore to `rim` and outer circle; "flank": a part of the latter."""
    radii = np.concatenate([np.linspace(BORE, rim, 17), np.linspace(rim, OUTER, 4)[1:]])
    angles = 0.5 * pi + pi / SECTORS * np.linspace(-1.0, 1.0, ARCS + 1)
    points = (radii[:, None, None] * np.stack([np.cos(angles), np.sin(angles)], axis=-1)).reshape(-1, 2)
    grid = np.arange(len(points)).reshape(len(radii), -1)
    lines = {"hub": grid[0], "lower cut": grid[:, 0], "upper cut": grid[:, -1], "flank": grid[-1, ARCS // 2 + 1 :][:2]}
    edges = {name: np.column_stack([line[:-1], line[1:]]) for name, line in lines.items()}
    return BodyMesh(points, oriented(points, _cells(grid)), edges)


def motion(rim, width, thickness, order, direction, offset=0.0, hub=0.5 * BORE, layers=4):
    """Heights (h,), and what the outer circle moves there (h, 3), radially, around and along the axis, under forces
    cos(order theta) in a `direction` (3,), of 1 N in every sector and even over the face. A rim of a `width` is on a
    web of a `thickness` (mm), that on a `hub` as wide as the rim; the bore is held."""
    mesh = ring_sector(rim)
    web = SweptWeb(hub, rim, offset - 0.5 * thickness, offset + 0.5 * thickness)
    sweep = Sweep(layers_with_web(layers_of_face(layers, width), web.low, web.high), 0.0, web)
    blocks = joined_blocks(
        *parts_of_ring(condensed_swept_sector(mesh, sweep, POISSON, SECTORS), SECTORS), SECTORS, SECTORS // 2
    )
    x, y = (place := by_radius(mesh.edge_nodes("flank", 2)).mean(axis=0)) / np.linalg.norm(place)
    around = np.array([[x, -y, 0.0], [y, x, 0.0], [0.0, 0.0, 1.0]])
    heights = sweep.heights
    over_face = slice_averages(heights, 2, np.zeros(1), np.array([width]))[0]
    # The flank's three nodes alike.
    force = np.kron(over_face, np.tile(around @ direction / 3.0, 3))
    ahead = [block @ force for block in blocks]
    behind = [block.T @ force for block in blocks]
    total = ahead[0] + ahead[-1] * (-1.0) ** order
    for sectors in range(1, SECTORS // 2):
        total = total + np.cos(2.0 * pi * order * sectors / SECTORS) * (ahead[sectors] + behind[sectors])
    return heights, total.reshape(len(heights), 3, 3).mean(axis=1) @ around


class Part(NamedTuple):
    inner: float
    outer: float
    low: float
    high: float


def simpson(count):
    """Simpson's weights (count,), whose sum is 1."""
    found = np.tile([2.0, 4.0], count)[:count]
    found[[0, -1]] = 1.0
    return found / found.sum()


class Meridian:
    """A body of parts, in squares of second order of a `size` (mm), with u_r = u cos(n theta), u_t = v sin(n theta),
    u_z = w cos(n theta) of an order n; dofs (u, v, w) by node."""

    def __init__(self, parts, order, size):
        edges = np.array(parts)
        radii = np.arange(edges[:, 0].min(), edges[:, 1].max() + 0.5 * size, size)
        heights = np.arange(edges[:, 2].min(), edges[:, 3].max() + 0.5 * size, size)
        points = np.stack(np.meshgrid(radii, heights, indexing="ij"), axis=-1).reshape(-1, 2)
        grid = np.arange(len(points)).reshape(len(radii), -1)
        cells = cells_of(grid)
        r, z = points[cells].mean(axis=1).T[:, :, None]
        inside = (r > edges[:, 0]) & (r < edges[:, 1]) & (z > edges[:, 2]) & (z < edges[:, 3])
        cells = cells[inside.any(axis=1)]
        used = np.unique(cells)
        space = adapter.vector_space(adapter.create_mesh(points[used], np.searchsorted(used, cells)), 2, components=3)
        self.order, self.nodes = order, adapter.node_coordinates(space)[:, :2]
        self.stiffness = assembled(adapter.assemble_matrix(adapter.compile_form(self._energy(space)))).tocsc()

    def _energy(self, space):
        order, radius = self.order, ufl.SpatialCoordinate(space.mesh)[0]
        lame, shear = POISSON / ((1.0 + POISSON) * (1.0 - 2.0 * POISSON)), 0.5 / (1.0 + POISSON)

        def strains(u):
            own = [u[0].dx(0), (u[0] + order * u[1]) / radius, u[2].dx(1)]
            across = [u[1].dx(0) - (order * u[0] + u[1]) / radius, u[1].dx(1) - order * u[2] / radius]
            return own, [*across, u[0].dx(1) + u[2].dx(0)]

        (of_u, across_u), (of_v, across_v) = strains(ufl.TrialFunction(space)), strains(ufl.TestFunction(space))
        energy = lame * sum(of_u) * sum(of_v) + shear * sum(2.0 * a * b for a, b in zip(of_u, of_v))
        energy += shear * sum(a * b for a, b in zip(across_u, across_v))
        return pi * energy * radius * ufl.dx

    def at_radius(self, radius):
        found = np.flatnonzero(abs(self.nodes[:, 0] - radius) < 1e-9)
        return found[np.argsort(self.nodes[found, 1])]

    def even_over(self, radius, component):
        """Weights of the dofs: a cylinder's motion in a component on the average over its height."""
        nodes, found = self.at_radius(radius), np.zeros(3 * len(self.nodes))
        found[3 * nodes + component] = simpson(len(nodes))
        return found

    def section_moved(self, height, outer):
        """The same (2, dofs) of the mean displacement along x of a cross section out to a radius, and of its mean
        tilt about y."""
        nodes = np.flatnonzero((abs(self.nodes[:, 1] - height) < 1e-9) & (self.nodes[:, 0] < outer + 1e-9))
        nodes = nodes[np.argsort(self.nodes[nodes, 0])]
        r = self.nodes[nodes, 0]
        across, along = simpson(len(nodes)) * r, simpson(len(nodes)) * r**2
        found = np.zeros((2, 3 * len(self.nodes)))
        found[0, 3 * nodes] = 0.5 * across / across.sum()
        found[0, 3 * nodes + 1] = -found[0, 3 * nodes]
        found[1, 3 * nodes + 2] = -along / (along @ r)
        return found

    def solved(self, loads, held=None, springs=()):
        """Displacements (dofs, l) under loads (dofs, l), nodes (n,) `held`, on `springs` of a stiffness each, N/mm,
        against what weights (dofs,) average."""
        stiffness, free = self.stiffness, np.ones(len(loads), dtype=bool)
        for spring, weights in springs:
            row = scipy.sparse.csc_matrix(weights[:, None])
            stiffness = stiffness + spring * (row @ row.T)
        if held is not None:
            free = ~np.repeat(held, 3)
        found = np.zeros_like(loads)
        found[free] = spsolve(stiffness[free][:, free].tocsc(), loads[free]).reshape(found[free].shape)
        return found
