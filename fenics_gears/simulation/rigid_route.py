"""Rigid flanks: the pair with the smallest gap carries the whole load."""

from __future__ import annotations

from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.elasticity.cache import Cache
from fenics_gears.model.model import Model
from fenics_gears.simulation.deviations import deviating
from fenics_gears.system.job import Job
from fenics_gears.system.progress import Progress


def rigid_route(model: Model, progress: Progress, cache: Cache | None, job: Job | None = None) -> tuple[tuple, Cycle]:
    """No compliance, and the contact of one mesh cycle."""
    return (), rigid_cycle(model)


def rigid_cycle(model: Model) -> Cycle:
    """The contact of one mesh cycle between rigid flanks."""
    if model.scene.friction is None:
        from fenics_gears.contact.rigid_cycle import RigidCycle as kind
    else:
        from fenics_gears.contact.rigid_friction import RigidFrictionCycle as kind

    resolution = model.resolution
    coast = model.scene.coast_flanks is not None
    cycle = kind(
        model.pair,
        model.removal,
        resolution.contact_grid,
        resolution.steps_per_mesh_cycle,
        model.drivetrain.indices,
        coast,
    )
    return deviating(model, cycle)
