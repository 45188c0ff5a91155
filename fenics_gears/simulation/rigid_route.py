"""Rigid flanks: the pair with the smallest gap carries the whole load."""

from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.contact.rigid_mesh import rigid_mesh
from fenics_gears.elasticity.cache import Cache
from fenics_gears.model.model import Model
from fenics_gears.system.job import Job
from fenics_gears.system.progress import Progress

from .elastic_route import cycle_of


def rigid_route(model: Model, progress: Progress, cache: Cache | None, job: Job | None = None) -> tuple[tuple, Cycle]:
    return (), rigid_cycle(model)


def rigid_cycle(model: Model) -> Cycle:
    """The contact of one mesh cycle between rigid flanks."""
    scene = model.scene
    grid = model.resolution.contact_grid
    mesh = rigid_mesh(model.pair, model.removal, grid, scene.coast_flanks is not None)
    return cycle_of(model, mesh)
