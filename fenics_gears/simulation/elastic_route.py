"""The fast route: each gear is condensed once, and the contact nodes of every position take their compliance from it.
Models that differ only in their gaps share the contact operators."""

from __future__ import annotations

from dataclasses import replace
from types import ModuleType
from typing import TYPE_CHECKING

from fenics_gears.contact.mesh import Mesh, elastic_mesh
from fenics_gears.contact.mesh_cycle import Cycle, Deviation, Gaps, Opening
from fenics_gears.contact.tooth_pair import Flanks, Removal
from fenics_gears.effects import ALONG_THE_FACE, effects_on, from_effects
from fenics_gears.elasticity.cache import Cache
from fenics_gears.elasticity.compliance import Bodies
from fenics_gears.inputs.tree import GEARS
from fenics_gears.model.model import Model
from fenics_gears.system.job import Job
from fenics_gears.system.progress import Progress

from .bodies import gear_bodies
from .routes import CONDENSED, route_of

if TYPE_CHECKING:
    from fenics_gears.elasticity.face_compliance_data import FaceCompliance


def elastic_route(
    model: Model, progress: Progress, cache: Cache | None, job: Job | None = None
) -> tuple[Bodies, Cycle]:
    """The bodies of both gears, and the contact operators on them; no rank of a `job` but 0 has work."""
    bodies = gear_bodies(model, progress, cache)
    return bodies, mesh_cycle(model, bodies)


def mesh_cycle(model: Model, bodies: Bodies) -> Cycle:
    """The contact operators of one mesh cycle, for the centre coordinates and the friction that the scene has."""
    return cycle_of(model, mesh_of(model, bodies))


def mesh_of(model: Model, bodies: Bodies) -> Mesh:
    """Both gears in contact; coast flanks touch where the scene has them, also of a body that knows them."""
    flanks = flanks_of(model, bodies)
    grid = model.resolution.contact_grid
    corner = model.corner
    first, second = (body.solid for body in bodies)
    if first is not None and second is not None:
        return _over_face().face_mesh(flanks, _seated(model, first, second), model.face, grid, corner)
    if all(each.alike for each in flanks.compliance):
        return elastic_mesh(flanks, grid, corner, coast=model.scene.coast_flanks is not None)
    from fenics_gears.contact.whole_body_mesh import whole_body_mesh

    return whole_body_mesh(flanks, grid, model.resolution.steps_per_mesh_cycle, corner)


def _over_face() -> ModuleType:
    """Contact over the face, whose compiled functions take 30 ms to load."""
    from fenics_gears.contact import face_mesh

    return face_mesh


def _seated(model: Model, *bodies: FaceCompliance) -> tuple[FaceCompliance, FaceCompliance]:
    """Both bodies, those on a seat that gives way with what it does so within the face."""
    by_gear = dict(zip(GEARS, bodies))
    for seat in model.drivetrain.seats:
        body = by_gear[seat.gear]
        by_gear[seat.gear] = replace(body, seat=seat.compliance(body.heights))
    return by_gear[GEARS[0]], by_gear[GEARS[1]]


def cycle_of(model: Model, mesh: Mesh) -> Cycle:
    """The contact equations of a mesh over the steps of the model, with what opens its nodes."""
    steps = model.resolution.steps_per_mesh_cycle
    friction = model.scene.friction is not None
    indices = model.drivetrain.indices
    # Gears whose faces bend by coordinates of their own.
    bending = [seat for seat in model.drivetrain.seats if seat.of_face]
    if not bending:
        cycle = Cycle(mesh, steps, indices, friction)
        return cycle.with_gaps(gaps_of(model, cycle))
    from fenics_gears.dynamics.bending_faces import CycleOfBendingFaces, bending_face

    faces = []
    for seat in bending:
        middles = model.face.positions - model.face.middles[GEARS.index(seat.gear)]
        faces.append(bending_face(model.drivetrain, seat, middles, model.face.widths))
    cycle = CycleOfBendingFaces(mesh, steps, indices, friction, faces)
    return cycle.with_gaps(gaps_of(model, cycle))


def flanks_of(model: Model, bodies: Bodies) -> Flanks:
    """Both gears as contact sees them: in the plane a load over the common face spreads in a gear that is wider."""
    pair = model.pair
    removal = removal_of_nodes(model)
    sections = [body.section for body in bodies]
    within = pair.effective_face_widths == (pair.face_width, pair.face_width)
    if not within and all(body.solid is None for body in bodies):
        from fenics_gears.elasticity.overhang import with_overhang

        sections = [
            with_overhang(section, gear, material, pair.face_width / width)
            for section, gear, material, width in zip(
                sections, pair.gears, model.scene.gears.materials, pair.effective_face_widths
            )
        ]
    first, second = sections
    return Flanks(pair, (first, second), removal)


def gaps_apart(model: Model) -> bool:
    """Whether contact operators are those of any gaps: on elastic flanks that are alike on all teeth."""
    return route_of(model) is CONDENSED and not any(effect.elasticity for effect in effects_on(model.scene))


def reliefs_apart(model: Model) -> bool:
    """Whether reliefs, too, change nothing but gaps: they also move the point at which a tip's edge touches."""
    return gaps_apart(model) and model.corner is None


def removal_of_nodes(model: Model) -> tuple[Removal | None, Removal | None]:
    """Material taken from the flanks as their contact nodes are placed; what opens gaps alone is left to `gaps_of`."""
    return (None, None) if reliefs_apart(model) else model.removal


def sections_of_gaps(model: Model) -> tuple[str, ...]:
    """The sections of a scene in which models may differ that share contact operators."""
    if not gaps_apart(model):
        return ()
    reliefs = reliefs_apart(model)
    named = effects_on(model.scene)
    return *ALONG_THE_FACE, *(each.section for each in named if each.gaps or each.removal and reliefs)


def gaps_of(model: Model, cycle: Cycle) -> Gaps:
    """What opens the contact nodes of a cycle of the model, or of one that shares its contact operators."""
    profile = None
    of_steps = None
    if model.removal != (None, None) and reliefs_apart(model):
        # With the fields of a relief, 10 ms.
        from fenics_gears.contact.relief_gaps import profile_of

        profile, of_steps = profile_of(cycle, model.removal)
    return Gaps(profile, openings_of(model, cycle), deviations_of(model), of_steps)


def deviations_of(model: Model) -> tuple[Deviation, ...]:
    """What opens the contact nodes otherwise in each mesh cycle."""
    return tuple(from_effects(model.scene, "gaps", model))


def openings_of(model: Model, cycle: Cycle) -> tuple[Opening, ...]:
    """What opens the contact nodes of such a cycle along the face."""
    if cycle.face.slices == 1:
        return ()
    return (_over_face().opening_over_face(cycle, model.face_opening, model.coast_face_opening),)
