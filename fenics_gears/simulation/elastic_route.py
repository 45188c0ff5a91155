"""The fast route: each gear condensed once, its flank compliance seen by the contact nodes of every position."""

from __future__ import annotations

from fenics_gears.contact.mesh_cycle import Cycle, MeshCycle
from fenics_gears.contact.tooth_pair import Flanks
from fenics_gears.effects import from_effects
from fenics_gears.elasticity.cache import Cache
from fenics_gears.elasticity.compliance import FlankCompliance, Reach
from fenics_gears.model.model import Model
from fenics_gears.simulation.deviations import deviating
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
    cycle = _cycle_of(compliances)(
        flanks_of(model, compliances),
        model.resolution.contact_grid,
        model.resolution.steps_per_mesh_cycle,
        model.drivetrain.indices,
        tangential=model.scene.friction is not None,
        corner=model.corner,
    )
    return deviating(model, cycle)


def flanks_of(model: Model, compliances: Compliances) -> Flanks:
    """Both gears as contact in the plane sees them: a load over the common face spreads in a gear that is wider."""
    pair = model.pair
    if pair.effective_face_widths == (pair.face_width, pair.face_width):
        return Flanks(pair, compliances, model.removal)
    # Imported here: gears of one width have none.
    from fenics_gears.elasticity.overhang import with_overhang

    gears, materials = (pair.pinion, pair.wheel), model.scene.gears.materials
    pinion, wheel = (
        with_overhang(body, gear, material, pair.face_width / width)
        for body, gear, material, width in zip(compliances, gears, materials, pair.effective_face_widths)
    )
    return Flanks(pair, (pinion, wheel), model.removal)


def _cycle_of(compliances: Compliances):
    """One mesh cycle for all where all teeth are alike."""
    if all(each.alike for each in compliances):
        return MeshCycle
    from fenics_gears.contact.whole_body_cycle import WholeBodyCycle

    return WholeBodyCycle
