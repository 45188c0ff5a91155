"""The route of flanks resolved over the face: plane sections as on the fast route, over bodies in three dimensions."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

from fenics_gears.contact.face_mesh import face_mesh, opening_over_face
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.contact.tooth_pair import Flanks
from fenics_gears.elasticity.cache import Cache
from fenics_gears.elasticity.compliance import Reach
from fenics_gears.elasticity.face_compliance_data import FaceCompliance
from fenics_gears.model.face_cost import both_at_once, by_gradients
from fenics_gears.model.face_resolution import face_discretisation
from fenics_gears.model.model import Model
from fenics_gears.simulation.elastic_route import Compliances, cycle_of, gear_compliances
from fenics_gears.system.job import Job
from fenics_gears.system.progress import Progress
from fenics_gears.system.second_process import SecondProcess, second_process, threads

Bodies = tuple[FaceCompliance, FaceCompliance]


def face_route(model: Model, progress: Progress, cache: Cache | None, job: Job | None = None) -> tuple[tuple, Cycle]:
    """Flank compliance of both gears' sections, their bodies, and the contact operators of a mesh cycle on them. job:
    whose ranks share the work on each body."""
    sections = gear_compliances(model, progress, cache)
    bodies = gear_bodies(model, progress, cache, job)
    return (*sections, *bodies), face_cycle(model, sections, bodies)


def gear_bodies(model: Model, progress: Progress, cache: Cache | None, job: Job | None = None) -> Bodies:
    """Compliance of pinion and wheel over their faces: of both at once where there are cores and memory for it."""
    reach, names = model.touching.reach, ("pinion", "wheel")

    def begin(name: str) -> None:
        # Conjugate gradients take a multiple of the time.
        by = by_gradients(model, names.index(name), 1 if job is None else job.size)
        progress.stage(f"condense {name}'s body" + (" by conjugate gradients" if by else ""))

    if job is None and threads() > 1 and both_at_once(model):
        with ThreadPoolExecutor(1) as waiting, second_process() as second:
            wheel = waiting.submit(gear_body, model, "wheel", reach, cache, second)
            begin("pinion")
            pinion = gear_body(model, "pinion", reach, cache)
            begin("wheel")
            return pinion, wheel.result()
    bodies = []
    for name in names:
        begin(name)
        bodies.append(gear_body(model, name, reach, cache, job))
    return bodies[0], bodies[1]


def gear_body(
    model: Model, name: str, reach: Reach, cache: Cache | None, job: Job | SecondProcess | None = None
) -> FaceCompliance:
    """Compliance of the "pinion" or the "wheel" over its face, from the cache where it is there."""
    # Imported here: plane scenes have none.
    from fenics_gears.elasticity.face.compliance import face_compliance

    number = ("pinion", "wheel").index(name)
    gear, material = getattr(model.pair, name), model.scene.gears.material_of(name)
    return face_compliance(gear, material, face_discretisation(model, number), reach, cache, job)


def face_cycle(model: Model, sections: Compliances, bodies: Bodies) -> Cycle:
    """The contact operators of one mesh cycle over the face."""
    mesh = face_mesh(
        Flanks(model.pair, sections, model.removal), bodies, model.face, model.resolution.contact_grid, model.corner
    )
    return cycle_of(model, mesh, lambda cycle: opening_over_face(cycle, model.face_opening, model.coast_face_opening))
