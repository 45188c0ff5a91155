"""Steps, elements and contact windows of a planetary set, all of whose meshes are solved together: it has fewer than as
many pairs by themselves. Rings and planets are nearly conformal, so that windows in which tip edges may touch hold
hundreds of nodes."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from math import ceil
from typing import TYPE_CHECKING

from .drivetrain import line_load
from .face_resolution import inner_length
from .model import Model
from .resolution import hertz_half_width, in_steps, plane_contact_modulus, steepest_relief, widest

if TYPE_CHECKING:
    from fenics_gears.scene.accuracy import Accuracy
    from fenics_gears.scene.train_mesh import MeshOfScene

# Where a scene does not say: steps of a mesh cycle in the plane, and flank elements in a Hertz half-width. FVA's set
# is then within 0.01 % in the mean transmission error, 0.8 % in its span and, in peak pressures, 0.8 % of the sun's
# meshes and 3 % of the ring's, of elements half as wide.
STEPS = 100
ELEMENTS_PER_HALF_WIDTH = 1.5
# Of an even share, what one planet may carry: of four planets two opposite ones may carry all.
LARGEST_SHARE = 2.0


def coarser(mesh: MeshOfScene, model: Model) -> Model:
    """The model of a mesh of a set with the defaults of sets."""
    asked = mesh.scene.accuracy
    resolution = model.resolution
    if asked.steps_per_mesh_cycle is None and not mesh.scene.three_dimensional:
        resolution = replace(resolution, steps_per_mesh_cycle=STEPS)
    if asked.flank_element_size is None and resolution.half_width:
        size = max(resolution.half_width / ELEMENTS_PER_HALF_WIDTH, resolution.flank_element_size)
        grid = resolution.contact_grid
        nodes = max(ceil(grid.length / (grid.spacing * size / resolution.flank_element_size)) + 1, 3)
        resolution = replace(resolution, flank_element_size=size, contact_grid=replace(grid, nodes=nodes))
    return replace(model, resolution=resolution)


def largest_torque(even: float, whole: float) -> float:
    """Torque (N mm) on the wheel of a mesh for which there has to be room, from the even share and the whole."""
    return min(LARGEST_SHARE * even, whole)


def with_own_nodes(accuracy: Accuracy, alone: Model, length: float) -> Accuracy:
    """The accuracy with contact nodes as far apart as the mesh `alone` has them, in a window of this length (mm)."""
    nodes = accuracy.contact_nodes or ceil(length / alone.resolution.contact_grid.spacing) + 1
    return replace(accuracy, contact_nodes=max(nodes, 3))


def narrowed(model: Model) -> Model:
    """The model of a mesh with fewer nodes where no edge is near: there flanks touch about the line of action alone, as
    far off it as reliefs move the contact. Elements of the defaults of sets are not told to be too few."""
    resolution = model.resolution
    grid = resolution.contact_grid
    radius = widest(model.pair)
    half_width = partial(hertz_half_width, relative_radius=radius, plane_modulus=plane_contact_modulus(model.scene))
    load = LARGEST_SHARE * line_load(model.scene, model.pair)
    needed = inner_length(model.scene, model.pair, load, half_width) + 2.0 * grid.spacing
    needed += 2.0 * radius * steepest_relief(model.pair, model.removal)
    inner = in_steps(needed, grid.length)
    grid = replace(grid, inner_length=inner)
    return replace(model, resolution=replace(resolution, contact_grid=grid, resolved=ELEMENTS_PER_HALF_WIDTH))
