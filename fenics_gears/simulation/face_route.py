"""The route of flanks resolved over the face: plane sections as on the fast route, over bodies in three dimensions."""

from __future__ import annotations

from fenics_gears.contact.face_mesh import face_mesh
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.contact.tooth_pair import Flanks
from fenics_gears.elasticity.cache import Cache
from fenics_gears.elasticity.compliance import Reach
from fenics_gears.elasticity.face_compliance_data import FaceCompliance
from fenics_gears.model.face_cost import by_gradients
from fenics_gears.model.face_resolution import face_discretisation
from fenics_gears.model.model import Model
from fenics_gears.simulation.elastic_route import Compliances, cycle_of, gear_compliances
from fenics_gears.simulation.gaps import removal_of_nodes
from fenics_gears.system.job import Job
from fenics_gears.system.progress import Progress

Bodies = tuple[FaceCompliance, FaceCompliance]


def face_route(model: Model, progress: Progress, cache: Cache | None, job: Job | None = None) -> tuple[tuple, Cycle]:
    """Flank compliance of both gears' sections, their bodies, and the contact operators of a mesh cycle on them. job:
    whose ranks share the work on each body."""
    sections = gear_compliances(model, progress, cache)
    bodies = gear_bodies(model, progress, cache, job)
    return (*sections, *bodies), face_cycle(model, sections, bodies)


def gear_bodies(model: Model, progress: Progress, cache: Cache | None, job: Job | None = None) -> Bodies:
    """Compliance of pinion and wheel over their faces."""
    bodies = []
    for number, name in enumerate(("pinion", "wheel")):
        # They take a multiple of the time.
        way = " by conjugate gradients" if by_gradients(model, number, 1 if job is None else job.size) else ""
        progress.stage(f"condense {name}'s body{way}")
        bodies.append(gear_body(model, name, model.touching.reach, cache, job))
    return bodies[0], bodies[1]


def gear_body(model: Model, name: str, reach: Reach, cache: Cache | None, job: Job | None = None) -> FaceCompliance:
    """Compliance of the "pinion" or the "wheel" over its face, from the cache where it is there."""
    # Imported here: plane scenes have none.
    from fenics_gears.elasticity.face.compliance import face_compliance

    number = ("pinion", "wheel").index(name)
    gear, material = getattr(model.pair, name), model.scene.gears.material_of(name)
    return face_compliance(gear, material, face_discretisation(model, number), reach, cache, job)


def face_cycle(model: Model, sections: Compliances, bodies: Bodies) -> Cycle:
    """The contact operators of one mesh cycle over the face."""
    mesh = face_mesh(
        Flanks(model.pair, sections, removal_of_nodes(model)), bodies, model.face, model.resolution.contact_grid,
        model.corner,
    )  # fmt: skip
    return cycle_of(model, mesh)
