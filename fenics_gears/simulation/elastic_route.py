"""The fast route: each gear condensed once, its flank compliance seen by the contact nodes of every position."""

from __future__ import annotations

from fenics_gears.contact.mesh import Mesh, elastic_mesh
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.contact.tooth_pair import Flanks
from fenics_gears.effects import from_effects
from fenics_gears.elasticity.cache import Cache
from fenics_gears.elasticity.compliance import FlankCompliance, Reach
from fenics_gears.model.model import Model
from fenics_gears.simulation.gaps import gaps_of, removal_of_nodes
from fenics_gears.system.job import Job
from fenics_gears.system.progress import Progress

Compliances = tuple[FlankCompliance, FlankCompliance]


def elastic_route(
    model: Model, progress: Progress, cache: Cache | None, job: Job | None = None
) -> tuple[Compliances, Cycle]:
    """Flank compliance of both gears, and the contact operators of a mesh cycle on them."""
    compliances = gear_compliances(model, progress, cache)
    return compliances, mesh_cycle(model, compliances)


def gear_compliances(model: Model, progress: Progress, cache: Cache | None) -> Compliances:
    """Flank compliance of pinion and wheel, reaching as many teeth as can be loaded together."""
    compliances = []
    for name in ("pinion", "wheel"):
        progress.stage(f"condense {name}")
        compliances.append(gear_compliance(model, name, model.touching.reach, cache))
    return compliances[0], compliances[1]


def gear_compliance(model: Model, name: str, reach: Reach, cache: Cache | None) -> FlankCompliance:
    """Flank compliance of the "pinion" or the "wheel" over the teeth within reach, from the cache where it is there."""
    own = [each for each in from_effects(model.scene, "elasticity", model, name, reach, cache) if each is not None]
    if own:
        return own[0]
    # Imported here: rigid flanks have none.
    from fenics_gears.elasticity.gear_compliance import flank_compliance

    return flank_compliance(
        getattr(model.pair, name),
        model.scene.gears.material_of(name),
        model.resolution.discretisation(("pinion", "wheel").index(name)),
        reach,
        cache,
    )


def mesh_cycle(model: Model, compliances: Compliances) -> Cycle:
    """The contact operators of one mesh cycle, for the centre coordinates and the friction that the scene has."""
    flanks, grid = flanks_of(model, compliances), model.resolution.contact_grid
    if all(each.alike for each in compliances):
        return cycle_of(model, elastic_mesh(flanks, grid, model.corner))
    from fenics_gears.contact.whole_body_mesh import whole_body_mesh

    return cycle_of(model, whole_body_mesh(flanks, grid, model.resolution.steps_per_mesh_cycle, model.corner))


def cycle_of(model: Model, mesh: Mesh) -> Cycle:
    """The contact equations of a mesh over the steps of the model, with what opens its nodes."""
    cycle = Cycle(
        mesh, model.resolution.steps_per_mesh_cycle, model.drivetrain.indices, model.scene.friction is not None
    )
    return cycle.with_gaps(gaps_of(model, cycle))


def flanks_of(model: Model, compliances: Compliances) -> Flanks:
    """Both gears as contact in the plane sees them: a load over the common face spreads in a gear that is wider."""
    pair, removal = model.pair, removal_of_nodes(model)
    if pair.effective_face_widths == (pair.face_width, pair.face_width):
        return Flanks(pair, compliances, removal)
    # Imported here: gears of one width have none.
    from fenics_gears.elasticity.overhang import with_overhang

    gears, materials = (pair.pinion, pair.wheel), model.scene.gears.materials
    pinion, wheel = (
        with_overhang(body, gear, material, pair.face_width / width)
        for body, gear, material, width in zip(compliances, gears, materials, pair.effective_face_widths)
    )
    return Flanks(pair, (pinion, wheel), removal)
